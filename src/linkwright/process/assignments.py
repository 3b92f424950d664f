"""Command-line arguments of the form ``name:=value``, as in the commands of ROS 2."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, phrase

# This is a string, because few commands need the compiled pattern.
_SINGLE_SIGN_PATTERN = r"^-*([A-Za-z_][\w-]*)(=|:)(?!=)(.*)$"


def _malformed_error(argument: str, hint: Phrase) -> Diagnostic:
    message = phrase("'{argument}' is not an argument of the form name:=value", argument=argument)
    return Diagnostic("CLI101", message, hint=hint)


def parse_assignments(
    words: Iterable[str], create_error: Callable[[str, Phrase], Diagnostic] = _malformed_error
) -> dict[str, str]:
    """Return the values by name of arguments in the form ``name:=value``.

    If a name is repeated, the last value counts.

    Args:
        words: the arguments.
        create_error: returns the error for an argument that does not have this form, given the argument and a hint.

    Raises:
        LinkwrightError: CLI101 by default; it lists all arguments that do not have this form.
    """
    values: dict[str, str] = {}
    errors = []
    for argument in words:
        name, separator, value = argument.partition(":=")
        if separator and name and not name.startswith("-"):
            values[name] = value
        else:
            errors.append(create_error(argument, _create_hint(argument)))
    if errors:
        raise LinkwrightError(*errors)
    return values


def _create_hint(argument: str) -> Phrase:
    match = re.match(_SINGLE_SIGN_PATTERN, argument, re.DOTALL)
    if match:
        return phrase("write {name}:={value}", name=match[1], value=match[3])
    return phrase("write arguments as name:=value")
