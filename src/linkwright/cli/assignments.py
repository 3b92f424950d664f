"""Words of the form ``name:=value``, as ROS 2 commands take them."""

from __future__ import annotations

from collections.abc import Iterable

from linkwright.diagnostics import Diagnostic, LinkwrightError


def parse_assignments(words: Iterable[str]) -> dict[str, str]:
    """Names and values of ``name:=value`` words; a later word of a name wins.

    Raises:
        LinkwrightError: CLI101 for every word that is not of this form.
    """
    values: dict[str, str] = {}
    wrong = []
    for word in words:
        name, sign, value = word.partition(":=")
        if sign and name and not name.startswith("-"):
            values[name] = value
        else:
            wrong.append(Diagnostic("CLI101", f"'{word}' is not an argument of the form name:=value", hint=_hint(word)))
    if wrong:
        raise LinkwrightError(*wrong)
    return values


def _hint(word: str) -> str:
    name, sign, value = word.lstrip("-").partition("=")
    if sign and name:
        return f"ROS 2 writes arguments with a colon: {name}:={value}"
    return "write the name, a colon, an equals sign and the value, without blanks; quote a value that has blanks"
