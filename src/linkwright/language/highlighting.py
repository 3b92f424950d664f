"""Semantic highlighting of the names and expressions in an XML text."""

from __future__ import annotations

import re
from collections.abc import Iterator
from enum import Enum
from pathlib import Path
from typing import NamedTuple

from linkwright.language.definitions import NameKind
from linkwright.language.expression_completion import FUNCTIONS
from linkwright.language.occurrences import occurrences_in
from linkwright.xacro.expressions.template import TokenKind, tokenize
from linkwright.xacro.faults import Fault
from linkwright.xmltree.tokens import Kind, tokens

_WORDS = re.compile(r"(?P<string>'[^']*'|\"[^\"]*\")|(?P<number>(?<![\w.])\d[\w.]*)|(?P<name>[A-Za-z_]\w*)")
_KEYWORDS = frozenset({"and", "or", "not", "if", "else", "in", "is", "for", "True", "False", "None"})


class HighlightKind(Enum):
    """The kinds of highlighted ranges, with their token types in the Language Server Protocol."""

    MACRO = "macro"
    PARAMETER = "parameter"
    PROPERTY = "variable"
    ARGUMENT = "enumMember"
    LINK = "class"
    JOINT = "interface"
    MATERIAL = "type"
    FUNCTION = "function"
    NUMBER = "number"
    STRING = "string"
    OPERATOR = "operator"
    KEYWORD = "keyword"


_KINDS = {
    NameKind.MACRO: HighlightKind.MACRO,
    NameKind.PARAMETER: HighlightKind.PARAMETER,
    NameKind.PROPERTY: HighlightKind.PROPERTY,
    NameKind.ARGUMENT: HighlightKind.ARGUMENT,
    NameKind.LINK: HighlightKind.LINK,
    NameKind.JOINT: HighlightKind.JOINT,
    NameKind.MATERIAL: HighlightKind.MATERIAL,
}


class Highlight(NamedTuple):
    """A highlighted range of a text.

    Attributes:
        start: the character offset.
        end: the offset after the last character.
        kind: the kind of text in the range.
        is_definition: whether the range defines a name.
    """

    start: int
    end: int
    kind: HighlightKind
    is_definition: bool = False


def highlights_in(text: str, file: Path) -> list[Highlight]:
    """Return the highlights of a text, in text order and without overlaps."""
    highlights: dict[int, Highlight] = {}
    for name in occurrences_in(text, file):
        if "$" not in name.name:
            highlights.setdefault(name.start, Highlight(name.start, name.end, _KINDS[name.kind], name.is_definition))
    for start, value in _find_values(text):
        for highlight in _highlight_value(value, start):
            highlights.setdefault(highlight.start, highlight)
    result: list[Highlight] = []
    for highlight in sorted(highlights.values(), key=lambda highlight: highlight.start):
        if not result or result[-1].end <= highlight.start:
            result.append(highlight)
    return result


def _find_values(text: str) -> Iterator[tuple[int, str]]:
    """Yield the attribute values and texts with a dollar sign, each with its offset."""
    for token in tokens(text):
        if token.kind is Kind.TEXT and "$" in token.text:
            yield token.start, token.text
        for attribute in token.attributes():
            if attribute.value and "$" in attribute.value:
                yield attribute.value_start, attribute.value


def _highlight_value(value: str, start: int) -> Iterator[Highlight]:
    try:
        parts = tokenize(value)
    except Fault:  # The expression is still being typed.
        return
    for part in parts:
        if part.kind is TokenKind.TEXT:
            continue
        begin, end = start + part.start, start + part.end
        yield Highlight(begin, begin + 2, HighlightKind.OPERATOR)
        if part.kind is TokenKind.EXPRESSION:
            yield from _highlight_expression(part.text, begin + 2)
        else:
            command = re.match(r"\s*(\w+)", part.text)
            if command is not None:
                yield Highlight(begin + 2 + command.start(1), begin + 2 + command.end(1), HighlightKind.KEYWORD)
        yield Highlight(end - 1, end, HighlightKind.OPERATOR)


def _highlight_expression(source: str, start: int) -> Iterator[Highlight]:
    for match in _WORDS.finditer(source):
        begin, end = start + match.start(), start + match.end()
        if match["string"]:
            yield Highlight(begin, end, HighlightKind.STRING)
        elif match["number"]:
            yield Highlight(begin, end, HighlightKind.NUMBER)
        elif match["name"] in _KEYWORDS:
            yield Highlight(begin, end, HighlightKind.KEYWORD)
        elif match["name"] in FUNCTIONS:
            yield Highlight(begin, end, HighlightKind.FUNCTION)
