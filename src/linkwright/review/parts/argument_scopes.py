"""Find values of a macro that take its parameter instead of the argument with the same name, or the reverse."""

from __future__ import annotations

import re

from linkwright.review.parts.elements import PartDifference
from linkwright.review.parts.outline import MacroOutline

_ARGUMENT = re.compile(r"\$\(arg\s+([^\s()]+)\s*\)")


def takes_parameter(macro: MacroOutline | None, difference: PartDifference) -> bool:
    """Return whether a value newly takes a parameter of its macro instead of the argument with the same name.

    Robots that pass the argument as the parameter show no change, but other callers of the macro get another value.
    """
    return macro is not None and _replaces(macro, difference.old, difference.new)


def takes_argument(macro: MacroOutline | None, difference: PartDifference) -> bool:
    """Return whether a value newly takes an argument instead of the parameter of its macro with the same name."""
    return macro is not None and _replaces(macro, difference.new, difference.old)


def _replaces(macro: MacroOutline, text: str | None, other: str | None) -> bool:
    """Return whether a text becomes another one if parameters take the place of the arguments with their names."""
    if text is None or other is None or text == other:
        return False
    return other == _ARGUMENT.sub(lambda match: f"${{{match[1]}}}" if match[1] in macro.parameters else match[0], text)
