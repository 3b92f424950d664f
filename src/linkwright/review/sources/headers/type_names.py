"""Compare the names that a C++ header gives to other types outside of classes."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from linkwright.diagnostics import Phrase, phrase
from linkwright.review.sources.cpp.text import blank_comments
from linkwright.review.sources.cpp.types import is_convertible, is_same_type, normalize_type

_TYPE_NAME = re.compile(
    r"^(?:typedef\s+(?P<type>[^;{}()]+?[\s>*&])(?P<name>\w+)|using\s+(?P<new_name>\w+)\s*=\s*(?P<used>[^;{}]+));",
    re.MULTILINE,
)
"""A declaration without indentation. An indented one may belong to the private part of a class."""


class TypeNameChange(NamedTuple):
    """A name that has another type.

    Attributes:
        text: the change.
        line: the line of the declaration in the new version.
        reason: the reason why it is breaking; None if it is not.
    """

    text: Phrase
    line: int
    reason: Phrase | None


def compare_type_names(old: str, new: str) -> Iterator[TypeNameChange]:
    """Yield the names that both versions of a header declare with ``typedef`` or ``using``, with other types.

    A name that branches of the preprocessor declare with different types is left out.

    Args:
        old: the old text of the header.
        new: its new text.
    """
    before, after = _read_type_names(old), _read_type_names(new)
    for name in [name for name in before if name in after]:
        (old_types, _), (new_types, line) = before[name], after[name]
        if len(old_types) != 1 or len(new_types) != 1:
            continue
        (old_type,), (new_type,) = old_types, new_types
        if is_same_type(normalize_type(old_type), normalize_type(new_type)):
            continue
        text = phrase("type '{name}': {old} -> {new}", name=name, old=old_type, new=new_type)
        reason = phrase("code that uses it as '{type}' does not build", type=old_type)
        yield TypeNameChange(text, line, None if is_convertible(old_type, new_type) else reason)


def _read_type_names(text: str) -> dict[str, tuple[set[str], int]]:
    """Return the types that a header gives to each name, and the line of the first declaration."""
    code = blank_comments(text)
    found: dict[str, tuple[set[str], int]] = {}
    for match in _TYPE_NAME.finditer(code):
        name, written = match["name"] or match["new_name"], match["type"] or match["used"]
        types, _ = found.setdefault(name, (set(), code.count("\n", 0, match.start()) + 1))
        types.add(" ".join(written.split()))
    return found
