"""Find the attributes with literal values that only one version of a constructor in Python sets."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterator, Sequence

from linkwright.diagnostics import joined, joined_first, phrase
from linkwright.review.sources.statements.code import Code, Part
from linkwright.review.sources.statements.code_changes import CodeChange
from linkwright.review.texts.excerpts import shorten_middle

_ASSIGNMENT = re.compile(r"[\d ]*self\.(?P<name>\w+) = (?P<value>[-\d.\"'({\[].*)", re.DOTALL)
_CONSTRUCTOR = "__init__"
_MIN_NUMBER = 1
"""Numbers up to this one begin counters and flags."""
_MAX_ATTRIBUTES = 8
_MAX_CHARACTERS = 160


def find_attribute_changes(
    old: Code, new: Code, has_word: tuple[Callable[[str], bool], Callable[[str], bool]], reported: Sequence[str]
) -> Iterator[CodeChange]:
    """Yield the attributes with a number, a text or a collection that only one version of a constructor sets.

    Args:
        old: the code of the old version.
        new: the code of the new version.
        has_word: functions that return whether the old or the new version has a name in any changed source.
        reported: the other lines about the source. Attributes in these lines are left out.
    """
    for name, parts in new.functions.items():
        if name.rpartition(".")[2] != _CONSTRUCTOR or name not in old.functions:
            continue
        sides = [
            [
                (part, attribute)
                for part in own
                if (attribute := _read(part)) is not None
                and not has_other(attribute[0])
                and not any(re.search(rf"\b{attribute[0]}\b", line) for line in reported)
            ]
            for own, has_other in zip((old.functions[name], parts), reversed(has_word), strict=True)
        ]
        sides = [_without_values(own, other) for own, other in zip(sides, reversed(sides), strict=True)]
        texts = [
            text.with_arguments(items=joined_first([_format(*item) for _, item in own], _MAX_ATTRIBUTES))
            for own, text in zip(
                sides[::-1],
                (phrase("attributes added: {items}", items=""), phrase("attributes removed: {items}", items="")),
                strict=True,
            )
            if own
        ]
        if texts:
            first = (sides[1] or sides[0])[0][0].first_line
            yield CodeChange(joined(texts, "; "), first, not sides[1])


def _without_values(
    attributes: Sequence[tuple[Part, tuple[str, str]]], others: Sequence[tuple[Part, tuple[str, str]]]
) -> list[tuple[Part, tuple[str, str]]]:
    """Return the attributes whose value no attribute of the other version has under another name."""
    values = {value for _, (_, value) in others}
    return [item for item in attributes if item[1][1] not in values]


def _read(part: Part) -> tuple[str, str] | None:
    """Return the name and value of an attribute that a statement sets to more than an initial value, or None."""
    match = _ASSIGNMENT.fullmatch(part.text)
    try:
        value = None if match is None else ast.literal_eval(match["value"])
    except (ValueError, SyntaxError, TypeError, MemoryError, RecursionError):
        return None
    is_trivial = not value or (isinstance(value, (int, float)) and abs(value) <= _MIN_NUMBER and value == int(value))
    return None if match is None or is_trivial else (match["name"], match["value"])


def _format(name: str, value: str) -> str:
    return f"self.{name} = {shorten_middle(value, _MAX_CHARACTERS)}"
