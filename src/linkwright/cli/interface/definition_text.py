"""Interface definitions as ``interface show`` prints them: with the fields of nested types indented below."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator

_FIELD = re.compile(r"\s*(?P<type>[A-Za-z]\w*(?:/[A-Za-z]\w*)*)[^\s#]*\s+[A-Za-z]\w*\s*(?P<equals>=)?")
_SIZED = frozenset(f"{kind}{bits}" for kind in ("int", "uint") for bits in (8, 16, 32, 64))
_PRIMITIVES = _SIZED | {"bool", "byte", "char", "float32", "float64", "string", "wstring"}
_DEEPEST = 50


def definition_lines(
    name: str, source: Callable[[str], str], *, comments: bool = True, nested_comments: bool = False
) -> Iterator[str]:
    """The lines of a definition.

    Args:
        name: ``package/kind/Name``.
        source: gives the text of the interface file of a name.
        comments: whether comments and blank lines are kept.
        nested_comments: whether they are kept in nested definitions.
    """
    yield from _lines(name, source, comments, nested_comments, 0)


def _lines(name: str, source: Callable[[str], str], comments: bool, nested_comments: bool, level: int) -> Iterator[str]:
    package = name.split("/", maxsplit=1)[0]
    for line in source(name).splitlines():
        line = line.rstrip()
        shown = line if comments else _without_comment(line).rstrip()
        if shown:
            yield "\t" * level + shown
        elif comments:
            yield ""
        nested = nested_type(line, package)
        if nested is not None and level < _DEEPEST:
            yield from _lines(nested, source, nested_comments, nested_comments, level + 1)


def nested_type(line: str, package: str) -> str | None:
    """The message type that a line of a definition has a field of, in full; None for anything else."""
    found = _FIELD.match(line)
    if found is None or found["equals"] or found["type"] in _PRIMITIVES:
        return None
    parts = found["type"].split("/")
    if parts == ["Header"]:
        return "std_msgs/msg/Header"
    if len(parts) == 1:
        return f"{package}/msg/{parts[0]}"
    return f"{parts[0]}/msg/{parts[-1]}"


def _without_comment(line: str) -> str:
    """The line before a ``#`` that does not stand in a text."""
    quote = ""
    for at, character in enumerate(line):
        if quote:
            quote = "" if character == quote else quote
        elif character in "\"'":
            quote = character
        elif character == "#":
            return line[:at]
    return line
