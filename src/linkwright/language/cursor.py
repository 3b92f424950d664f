"""The context of a cursor in an XML text that is being typed."""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import Enum

from linkwright.xmltree.tokens import Kind, Token, TokenAttribute, tokens

_EXPRESSION = re.compile(r"\$\{[^{}]*$")
_SUBSTITUTION = re.compile(r"\$\(\s*(\w*)(?:\s+([^()\s]*))?$")
_NAME = re.compile(r"[A-Za-z_][\w.]*")


class CursorSyntax(Enum):
    """The kinds of cursor positions that an editor distinguishes."""

    TAG = "tag"
    CLOSING_TAG = "closing tag"
    ATTRIBUTE = "attribute"
    VALUE = "value"
    TEXT = "text"
    ELSEWHERE = "elsewhere"


@dataclass(frozen=True, slots=True)
class Cursor:
    """A cursor position in a text, with its context.

    Attributes:
        syntax: the kind of position.
        offset: the character offset.
        tags: the names of the enclosing elements, from the root. Inside an attribute, the last is the element itself.
        token: the tag at the cursor, or None outside of tags.
        attribute: the attribute whose name or value contains the cursor.
        typed: the part of the name, value or text before the cursor.
        elements: the start tags of `tags`.
    """

    syntax: CursorSyntax
    offset: int
    tags: tuple[str, ...]
    token: Token | None = None
    attribute: TokenAttribute | None = None
    typed: str = ""
    elements: tuple[Token, ...] = ()

    @property
    def is_in_expression(self) -> bool:
        """Whether the cursor is inside ``${...}``."""
        return _EXPRESSION.search(self.typed) is not None

    @property
    def substitution(self) -> tuple[str, str] | None:
        """The command and typed argument of the ``$(...)`` around the cursor, or None."""
        match = _SUBSTITUTION.search(self.typed)
        return None if match is None else (match[1], match[2] if match[2] is not None else "")

    @property
    def macro(self) -> Token | None:
        """The start tag of the innermost macro definition around the cursor, or None."""
        return next((element for element in reversed(self.elements) if element.name == "xacro:macro"), None)

    @property
    def word(self) -> str:
        """The part of a name in an expression before the cursor, or empty."""
        match = re.search(r"[A-Za-z_][\w.]*$", self.typed)
        return match[0] if match else ""


def cursor_at(text: str, offset: int) -> Cursor:
    """Return the cursor at an offset of a text, which may be incomplete."""
    tags: list[str] = []
    elements: list[Token] = []
    for token in tokens(text):
        is_inside = token.start < offset < token.end or (offset == token.end and not token.is_closed)
        if is_inside and token.kind is Kind.END:
            typed = text[token.start + 2 : offset]
            return Cursor(CursorSyntax.CLOSING_TAG, offset, tuple(tags), token, None, typed, tuple(elements))
        if is_inside and token.kind is Kind.START:
            return _cursor_in_tag(text, offset, token, (*tags, token.name), (*elements, token))
        if is_inside and token.kind is not Kind.TEXT:
            return Cursor(CursorSyntax.ELSEWHERE, offset, tuple(tags))
        if offset <= token.start or (token.kind is Kind.TEXT and offset <= token.end):
            break
        if token.kind is Kind.START and token.name and not token.is_empty_element:
            tags.append(token.name)
            elements.append(token)
        elif token.kind is Kind.END and token.name in tags:
            while tags.pop() != token.name:
                pass
            del elements[len(tags) :]
    begin = max(text.rfind(">", 0, offset), text.rfind("<", 0, offset)) + 1
    return Cursor(CursorSyntax.TEXT, offset, tuple(tags), typed=text[begin:offset], elements=tuple(elements))


def _cursor_in_tag(text: str, offset: int, token: Token, tags: tuple[str, ...], elements: tuple[Token, ...]) -> Cursor:
    if offset <= token.name_start + len(token.name):
        typed = text[token.name_start : offset]
        return Cursor(CursorSyntax.TAG, offset, tags[:-1], token, typed=typed, elements=elements[:-1])
    for attribute in token.attributes():
        if attribute.start <= offset <= attribute.start + len(attribute.name):
            return Cursor(
                CursorSyntax.ATTRIBUTE, offset, tags, token, attribute, text[attribute.start : offset], elements
            )
        if attribute.value is not None and attribute.value_start <= offset <= attribute.value_end:
            typed = text[attribute.value_start : offset]
            return Cursor(CursorSyntax.VALUE, offset, tags, token, attribute, typed, elements)
    return Cursor(CursorSyntax.ATTRIBUTE, offset, tags, token, elements=elements)


def name_at(text: str, offset: int) -> tuple[str, int] | None:
    """Return the name around an offset and its start offset, or None if there is no name."""
    line_start = text.rfind("\n", 0, offset) + 1
    line_end = text.find("\n", offset)
    line = text[line_start : line_end if line_end >= 0 else len(text)]
    for match in _NAME.finditer(line):
        if match.start() <= offset - line_start <= match.end():
            return match[0], line_start + match.start()
    return None
