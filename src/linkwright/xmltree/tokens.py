"""The tokens of a text that need not be XML: every character belongs to one token.

Editors request the tokens of incomplete texts, and a formatter must preserve text that a tree leaves out. Therefore,
every text can be split into tokens. An incomplete tag ends before the next ``<``. An attribute without its closing
quote ends with its line or tag.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from enum import Enum

from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import NamedTuple

_MARKUP = lazy_pattern(
    r"""
    (?P<comment><!--.*?(?:-->|\Z))
    | (?P<cdata><!\[CDATA\[.*?(?:\]\]>|\Z))
    | (?P<instruction><\?.*?(?:\?>|\Z))
    | (?P<declaration><!(?:[^<>\["']|"[^"]*(?:"|\Z)|'[^']*(?:'|\Z)
                        |\[(?:[^\]"']|"[^"]*(?:"|\Z)|'[^']*(?:'|\Z))*(?:\]|\Z))*>?)
    | (?P<end></[^<>]*>?)
    | (?P<start><(?:[^<>"']|"[^"<]*"|'[^'<]*'|["'][^<>\n]*)*>?)
    """,
    re.DOTALL | re.VERBOSE,
)
_NAME = lazy_pattern(r"</?\s*([^\s/>=\"'<]*)")
_ATTRIBUTE = lazy_pattern(
    r"""([^\s=/>"'<]+)            # the name
        (?:(\s*=\s*)              # the equals sign
        (?:(["'])([^"'<]*?)\3 | (["'])([^<]*?)\5 | ["']([^<>\n]*?)(?=\s*/?>|\n|<|\Z) | ([^\s"'<>/]*)))?""",
    re.VERBOSE,
)
_ENDS = {"comment": "-->", "cdata": "]]>", "instruction": "?>"}


class Kind(Enum):
    """The kinds of tokens."""

    TEXT = "text"
    START = "start"
    END = "end"
    COMMENT = "comment"
    CDATA = "cdata"
    INSTRUCTION = "instruction"
    DECLARATION = "declaration"


class TokenAttribute(NamedTuple):
    """An attribute of a start tag, with character offsets in the text.

    Attributes:
        name: the name as written.
        start: the offset of the name.
        value: the value as written, with unresolved entities, or None if there is no ``=``.
        value_start: the offset of the value or, if there is none, the offset where a value can be inserted.
        value_end: the offset after the value.
        quote: the quote around the value; empty if there is none.
        end: the offset after the closing quote.
    """

    name: str
    start: int
    value: str | None
    value_start: int
    value_end: int
    quote: str
    end: int


class Token(NamedTuple):
    """A token of a text.

    Attributes:
        kind: the kind of the token.
        text: the characters of the token, as written.
        start: the character offset of the token.
        is_closed: whether the end of the token is written, such as the ``>`` of a tag; always True for texts.
    """

    kind: Kind
    text: str
    start: int
    is_closed: bool

    @property
    def end(self) -> int:
        """The character offset after the token."""
        return self.start + len(self.text)

    @property
    def is_whole(self) -> bool:
        """Whether the token is a whole element, ``<a/>``."""
        return self.kind is Kind.START and self.text.endswith("/>")

    @property
    def name(self) -> str:
        """The name of a tag as written; empty if it is not yet typed, and for other tokens."""
        found = _NAME.match(self.text) if self.kind in (Kind.START, Kind.END) else None
        return "" if found is None else str(found[1])

    @property
    def name_start(self) -> int:
        """The character offset of a tag's name."""
        found = _NAME.match(self.text)
        return self.start if found is None else self.start + found.start(1)

    def attributes(self) -> list[TokenAttribute]:
        """Return the attributes of a start tag in source order; empty for other tokens."""
        if self.kind is not Kind.START:
            return []
        return [*_attributes(self)]


def tokens(text: str) -> Iterator[Token]:
    """Yield the tokens of a text, which need not be XML.

    The joined texts of the tokens are the whole text.
    """
    at = 0
    while at < len(text):
        opening = text.find("<", at)
        if opening < 0:
            opening = len(text)
        if opening > at:
            yield Token(Kind.TEXT, text[at:opening], at, True)
        at = opening
        if at == len(text):
            return
        found = _MARKUP.match(text, at)
        assert found is not None  # a start tag always matches, even if it is only a ``<``
        name = str(found.lastgroup)
        yield Token(Kind(name), found[0], at, found[0].endswith(_ENDS.get(name, ">")))
        at = found.end()


def _attributes(tag: Token) -> Iterator[TokenAttribute]:
    at = tag.name_start - tag.start + len(tag.name)
    for found in _ATTRIBUTE.finditer(tag.text, at):
        name, equals = found[1], found[2]
        start = tag.start + found.start(1)
        if equals is None:
            end = tag.start + found.end(1)
            yield TokenAttribute(name, start, None, end, end, "", end)
            continue
        group = next((number for number in (4, 6, 7, 8) if found[number] is not None), 8)
        value = found[group] or ""
        value_start = tag.start + found.start(group)
        quote = found[3] or found[5] or (tag.text[found.start(group) - 1] if group == 7 else "")
        end = tag.start + found.end()
        yield TokenAttribute(name, start, value, value_start, value_start + len(value), quote, end)
