"""Find variables of functions that have another name and another initial value."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from linkwright.review.sources.statements.code import Code, Part

_LITERAL = r"\"(?:\\.|[^\"\\])*\"|'(?:\\.|[^'\\])*'|-?\s?\.?\d[\w.]*|true|false|True|False"
_DECLARATION = re.compile(
    rf"[\s\d]*(?P<type>[A-Za-z_][\w:<>,&* ]* )?(?P<name>[A-Za-z_]\w*) (?:= (?P<assigned>{_LITERAL})|"
    rf"(?P<bracket>[({{]) (?P<given>{_LITERAL}) [)}}])(?: ;)?"
)
_NO_TYPES = frozenset({"return", "throw", "delete", "new", "else", "case", "goto", "using"})
_MIN_SHARE = 0.5
"""The minimum share of the other statements with the variable that are equal except for its name."""


class RenamedVariable(NamedTuple):
    """A variable with another name and another initial value.

    Attributes:
        function: the name of its function.
        text: both names with their values.
        line: the line of the declaration in the new version.
    """

    function: str
    text: str
    line: int


class _Declaration(NamedTuple):
    name: str
    type: str
    value: str
    part: Part


def find_renamed_variables(old: Code, new: Code) -> Iterator[RenamedVariable]:
    """Yield the variables of functions of both versions whose uses are equal except for their names."""
    for name, parts in new.functions.items():
        before = old.functions.get(name, ())
        removed, added = _list_lost(before, parts), _list_lost(parts, before)
        for item in removed if added else ():
            same_type = [other for other in added if other.type == item.type]
            matching = [other for other in same_type if _have_same_uses(item, other, before, parts)]
            if len(matching) == 1 and matching[0].value != item.value:
                text = f"{item.name} {item.value} -> {matching[0].name} {matching[0].value}"
                yield RenamedVariable(name, text, matching[0].part.first_line)


def _list_lost(parts: Sequence[Part], others: Sequence[Part]) -> list[_Declaration]:
    """Return the only declarations of variables that another version of a function does not name."""
    words = {word for part in others for word in re.findall(r"\w+", part.text)}
    found: dict[str, list[_Declaration]] = {}
    for part in parts if others else ():
        match = _DECLARATION.fullmatch(part.text)
        type_name = "" if match is None else (match["type"] or "").strip()
        if match is None or match["name"] in words or type_name in _NO_TYPES or (match["bracket"] and not type_name):
            continue
        value = match["assigned"] or match["given"]
        found.setdefault(match["name"], []).append(_Declaration(match["name"], type_name, value, part))
    return [items[0] for items in found.values() if len(items) == 1]


def _have_same_uses(old: _Declaration, new: _Declaration, before: Sequence[Part], after: Sequence[Part]) -> bool:
    """Return whether most statements with an old variable are equal to those with a new one."""
    pattern = re.compile(rf"(?<![\w.]){re.escape(old.name)}\b")
    uses = [part.text for part in before if part is not old.part and pattern.search(part.text)]
    texts = {part.text.lstrip(" 0123456789") for part in after if part is not new.part}
    equal = [text for text in uses if pattern.sub(new.name, text).lstrip(" 0123456789") in texts]
    return bool(equal) and len(equal) >= _MIN_SHARE * len(uses)
