"""Find the parameters that C++ sources declare together, with their common namespace."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from linkwright.review.sources.cpp.text import find_arguments, find_closing_bracket
from linkwright.review.sources.cpp.values import parse_literal

_CALL = re.compile(r"\bdeclare_parameters\s*(?:<(?P<type>[^;(){}]*)>\s*)?(?=\()")
_TEXT = re.compile(r'\s*"(?P<text>[^"\\]*)"\s*')
_BRACE = re.compile(r"\s*(?:(?:std::map\s*<[^;(){}]*>|std::pair\s*<[^;(){}]*>|std::make_pair)\s*)?(?=[({])")


class DeclaredParameter(NamedTuple):
    """A parameter of a group.

    Attributes:
        name: the name, behind the namespace and a dot.
        type: the type of the group; empty if the call leaves it to the values.
        default: the literal default; empty if it is another expression.
        start: the offset of the text with the name.
        end: the offset of its end.
    """

    name: str
    type: str
    default: str
    start: int
    end: int


def find_declared_groups(text: str) -> Iterator[DeclaredParameter]:
    """Yield the parameters of calls such as ``declare_parameters("arm", {{"gain", 1.0}})`` in a C++ source.

    Args:
        text: the source without comments.
    """
    for match in _CALL.finditer(text):
        arguments = list(find_arguments(text, match.end()))
        namespace = _TEXT.fullmatch(text[slice(*arguments[0])]) if len(arguments) > 1 else None
        table = None if namespace is None else _BRACE.match(text, arguments[1][0])
        if namespace is None or table is None:
            continue
        prefix = f"{namespace['text']}." if namespace["text"] else ""
        for begin, _ in find_arguments(text, table.end()):
            entry = _BRACE.match(text, begin)
            values = [] if entry is None else list(find_arguments(text, entry.end()))
            name = _TEXT.fullmatch(text[slice(*values[0])]) if values else None
            if name is not None and name["text"]:
                start = values[0][0] + name.start("text")
                default = _read_default(text, values[1]) if len(values) > 1 else ""
                type_name = " ".join((match["type"] or "").split())
                yield DeclaredParameter(prefix + name["text"], type_name, default, start, start + len(name["text"]))


def _read_default(text: str, offsets: tuple[int, int]) -> str:
    """Return the literal default, which a description of the parameter may follow in braces."""
    opening = _BRACE.match(text, offsets[0])
    if opening is not None and find_closing_bracket(text, opening.end()) < offsets[1]:
        inner = list(find_arguments(text, opening.end()))
        offsets = inner[0] if inner else offsets
    return parse_literal(text[slice(*offsets)]) or ""
