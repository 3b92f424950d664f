"""The split of any text into XML tokens.

Every character belongs to one token.

Editors request the tokens of incomplete XML, and a formatter must preserve text that a tree leaves out. Therefore, the
text need not be well-formed. An incomplete tag ends before the next ``<``. An attribute without its closing quote ends
with its line or tag.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from enum import Enum

from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import NamedTuple

_MARKUP_PATTERN = lazy_pattern(
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
_TAG_NAME = lazy_pattern(r"</?\s*([^\s/>=\"'<]*)")
_ATTRIBUTE_PATTERN = lazy_pattern(
    r"""([^\s=/>"'<]+)            # the name
        (?:(\s*=\s*)              # the equals sign
        (?:(["'])([^"'<]*?)\3 | (["'])([^<]*?)\5 | ["']([^<>\n]*?)(?=\s*/?>|\n|<|\Z) | ([^\s"'<>/]*)))?""",
    re.VERBOSE,
)
_TERMINATORS = {"comment": "-->", "cdata": "]]>", "instruction": "?>"}


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
        value: the value as written, with entities not resolved; None if the attribute has no ``=``.
        value_start: the offset of the value; without a value, the offset at which a value can be inserted.
        value_end: the offset after the value.
        quote: the quotation mark around the value; empty if the value is not quoted.
        end: the offset after the attribute, including the closing quote.
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
        is_closed: whether the token has its end, such as the ``>`` of a tag.
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
    def is_empty_element(self) -> bool:
        """Whether the token is an empty element, such as ``<a/>``."""
        return self.kind is Kind.START and self.text.endswith("/>")

    @property
    def name(self) -> str:
        """The name of a tag as written, or an empty string for other tokens.

        The result is also empty for a tag without a name.
        """
        name_match = _TAG_NAME.match(self.text) if self.kind in (Kind.START, Kind.END) else None
        return "" if name_match is None else str(name_match[1])

    @property
    def name_start(self) -> int:
        """The character offset of a tag's name in the text."""
        name_match = _TAG_NAME.match(self.text)
        return self.start if name_match is None else self.start + name_match.start(1)

    def attributes(self) -> list[TokenAttribute]:
        """Return the attributes of a start tag in source order, or an empty list for other tokens."""
        if self.kind is not Kind.START:
            return []
        return [*_find_attributes(self)]


def tokens(text: str) -> Iterator[Token]:
    """Yield the tokens of a text, even if it is not well-formed XML.

    The texts of the tokens, joined in order, are equal to the text.
    """
    position = 0
    while position < len(text):
        markup_start = text.find("<", position)
        if markup_start < 0:
            markup_start = len(text)
        if markup_start > position:
            yield Token(Kind.TEXT, text[position:markup_start], position, True)
        position = markup_start
        if position == len(text):
            return
        markup_match = _MARKUP_PATTERN.match(text, position)
        assert markup_match is not None  # a start tag always matches, even if it is only a ``<``
        name = str(markup_match.lastgroup)
        yield Token(Kind(name), markup_match[0], position, markup_match[0].endswith(_TERMINATORS.get(name, ">")))
        position = markup_match.end()


def _find_attributes(tag: Token) -> Iterator[TokenAttribute]:
    position = tag.name_start - tag.start + len(tag.name)
    for attribute_match in _ATTRIBUTE_PATTERN.finditer(tag.text, position):
        name, equals = attribute_match[1], attribute_match[2]
        start = tag.start + attribute_match.start(1)
        if equals is None:
            end = tag.start + attribute_match.end(1)
            yield TokenAttribute(name, start, None, end, end, "", end)
            continue
        value_group = next((number for number in (4, 6, 7, 8) if attribute_match[number] is not None), 8)
        value = attribute_match[value_group] or ""
        value_start = tag.start + attribute_match.start(value_group)
        quote = (
            attribute_match[3]
            or attribute_match[5]
            or (tag.text[attribute_match.start(value_group) - 1] if value_group == 7 else "")
        )
        end = tag.start + attribute_match.end()
        yield TokenAttribute(name, start, value, value_start, value_start + len(value), quote, end)
