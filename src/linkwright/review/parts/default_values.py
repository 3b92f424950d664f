"""Find values that are the same by default: a new argument or parameter of a macro has the old value as its default."""

from __future__ import annotations

import re
from collections.abc import Mapping
from itertools import chain

from linkwright.review.parts.elements import PartDifference
from linkwright.review.parts.name_substitution import iterate_properties
from linkwright.review.parts.outline import MacroOutline
from linkwright.review.parts.part_pair import PartPair

_REFERENCE = re.compile(r"\$\(arg\s+(?P<argument>[^\s()]+)\s*\)|\$\{\s*(?P<name>[A-Za-z_]\w*)\s*\}")
"""The use of an argument, or of a property or parameter of a macro."""
_MAX_DEPTH = 5
"""The maximum number of properties and defaults that name each other."""


def is_same_by_default(pair: PartPair, macro: str | None, difference: PartDifference) -> bool:
    """Return whether a changed value is the old one for callers that do not pass the names which it newly uses.

    Args:
        pair: both versions of the file.
        macro: the macro with the value; None outside of macros.
        difference: the difference between the values.
    """
    if difference.old is None or difference.new is None or difference.value == "conditions":
        return False
    old, new = " ".join(difference.old.split()), " ".join(difference.new.split())
    used = {match[0] for match in _REFERENCE.finditer(old)}
    values = _collect_defaults(pair, None if macro is None else pair.new.macros.get(macro))

    def resolve(match: re.Match[str]) -> str:
        name = "$" + match["argument"] if match["argument"] else match["name"]
        return match[0] if match[0] in used else values.get(name, match[0])

    for _ in range(_MAX_DEPTH):
        new = " ".join(_REFERENCE.sub(resolve, new).split())
        if new == old:
            return True
    return False


def _collect_defaults(pair: PartPair, macro: MacroOutline | None) -> Mapping[str, str]:
    """Return the values of properties and parameters by name, and those of arguments by ``$`` and the name."""
    values: dict[str, str] = {"$" + name: default for name, default in pair.defaults.items()}
    properties: dict[str, set[str]] = {}
    for name, element in chain.from_iterable(iterate_properties(outline.root) for outline in (pair.new, *pair.robots)):
        properties.setdefault(name, set()).add(element.attributes.get("value", ""))
    values |= {name: next(iter(texts)) for name, texts in properties.items() if len(texts) == 1}
    for name, parameter in () if macro is None else macro.parameters.items():
        values.pop(name, None)
        if parameter.default is not None and not parameter.forward:
            values[name] = parameter.default.strip("'\"")
    return values
