"""Split a C++ or Python source into words, literals and operators."""

from __future__ import annotations

import re
from collections.abc import Sequence
from enum import Enum
from typing import NamedTuple

_NUMBER = r"\.?\d(?:[eE][+-]|'(?=\w)|[\w.])*"
_OPERATORS = (
    r"->|::|<<=?|\*\*=?|//=?|\.\.\.|[-+*/%&|^=!<>:]=|&&|\|\||\+\+|--|<>|."
    # the last one is any other character; two brackets that end templates are two tokens
)
_PYTHON = re.compile(
    r"(?P<space>\s+|\\\n|\#[^\n]*)"
    r"|(?P<text>[rRbBuUfF]{0,2}(?:'''.*?(?<!\\)'''|\"\"\".*?(?<!\\)\"\"\"|'(?:\\.|[^'\\\n])*'|\"(?:\\.|[^\"\\\n])*\"))"
    rf"|(?P<number>{_NUMBER})|(?P<word>[^\W\d]\w*)|(?P<operator>{_OPERATORS})",
    re.DOTALL,
)
_CPP = re.compile(
    r"(?P<space>\s+|\\\n|//[^\n]*|/\*.*?\*/)"
    r"|(?P<text>(?:u8|[uUL])?(?:R\"(?P<mark>[^(\s]*)\(.*?\)(?P=mark)\"|\"(?:\\.|[^\"\\\n])*\"|'(?:\\.|[^'\\\n])+'))"
    rf"|(?P<number>{_NUMBER})|(?P<word>[A-Za-z_]\w*)|(?P<operator>{_OPERATORS})",
    re.DOTALL,
)
_OPENING, _CLOSING = "([{", ")]}"


class TokenKind(Enum):
    """The kind of a token."""

    TEXT = "text"
    NUMBER = "number"
    WORD = "word"
    OPERATOR = "operator"


class Token(NamedTuple):
    """A token of a source.

    Attributes:
        kind: the kind of the token.
        text: the characters of the token.
        start: the offset in the source.
        has_space: whether it follows a space or a comment.
    """

    kind: TokenKind
    text: str
    start: int
    has_space: bool

    @property
    def end(self) -> int:
        """The offset after the last character of the token."""
        return self.start + len(self.text)


def tokenize_python(text: str, start: int = 0, end: int | None = None) -> list[Token]:
    """Return the tokens of a part of a Python source."""
    return _tokenize(_PYTHON, text, start, end)


def tokenize_cpp(text: str, start: int = 0, end: int | None = None) -> list[Token]:
    """Return the tokens of a part of a C++ source. Preprocessor directives are read like code."""
    return _tokenize(_CPP, text, start, end)


def _tokenize(pattern: re.Pattern[str], text: str, start: int, end: int | None) -> list[Token]:
    tokens = []
    has_space = True
    for match in pattern.finditer(text, start, len(text) if end is None else end):
        kind = match.lastgroup
        if kind == "space":
            has_space = True
            continue
        tokens.append(Token(TokenKind(kind), match[0], match.start(), has_space))
        has_space = False
    return tokens


def join_tokens(tokens: Sequence[Token]) -> str:
    """Return the text of tokens, with one space where the source has spaces or comments."""
    parts = [f" {token.text}" if token.has_space and index else token.text for index, token in enumerate(tokens)]
    return "".join(parts)


def match_brackets(tokens: Sequence[Token]) -> dict[int, int]:
    """Return the index of the matching bracket for each bracket that has one."""
    pairs: dict[int, int] = {}
    opened: list[int] = []
    for index, token in enumerate(tokens):
        if token.kind is not TokenKind.OPERATOR:
            continue
        if token.text in _OPENING:
            opened.append(index)
        elif token.text in _CLOSING and opened:
            other = opened.pop()
            pairs[index], pairs[other] = other, index
    return pairs
