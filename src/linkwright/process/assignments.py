"""Command-line arguments of the form ``name:=value``, as ROS 2 commands use them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, phrase

# a string, because few commands need the compiled pattern
_SINGLE_SIGN = r"^-*([A-Za-z_][\w-]*)(=|:)(?!=)(.*)$"


def _malformed(word: str, hint: Phrase) -> Diagnostic:
    message = phrase("'{word}' is not an argument of the form name:=value", word=word)
    return Diagnostic("CLI101", message, hint=hint)


def parse_assignments(
    words: Iterable[str], malformed: Callable[[str, Phrase], Diagnostic] = _malformed
) -> dict[str, str]:
    """Parse arguments of the form ``name:=value``, and return the values by name.

    If a name is repeated, its last value is used.

    Args:
        words: the arguments.
        malformed: creates the error for an argument of another form, from the argument and a hint.

    Raises:
        LinkwrightError: CLI101 by default, with every argument that does not have this form.
    """
    values: dict[str, str] = {}
    wrong = []
    for word in words:
        name, sign, value = word.partition(":=")
        if sign and name and not name.startswith("-"):
            values[name] = value
        else:
            wrong.append(malformed(word, _hint(word)))
    if wrong:
        raise LinkwrightError(*wrong)
    return values


def _hint(word: str) -> Phrase:
    found = re.match(_SINGLE_SIGN, word, re.DOTALL)
    if found:
        return phrase("write {name}:={value}", name=found[1], value=found[3])
    return phrase("write arguments as name:=value")
