"""The lexer for text with ``${expressions}`` and ``$(substitutions)`` in it.

The rules are those of ros/xacro, tried in this order at each place: two or more dollars before a brace or
parenthesis lose one of them and make it literal; ``${`` runs to the first ``}``; ``$(`` runs to the first ``)``;
anything else is text, in which a dollar may stand alone.
"""

from __future__ import annotations

import re
from enum import Enum

from linkwright.diagnostics import phrase
from linkwright.loading.lean_dataclasses import NamedTuple
from linkwright.xacro.faults import Fault


class TokenKind(Enum):
    """The kinds of tokens."""

    TEXT = "text"
    EXPRESSION = "expression"
    SUBSTITUTION = "substitution"


class Token(NamedTuple):
    """A piece of a text.

    Attributes:
        kind: its kind.
        text: the text that a TEXT token yields; for other kinds the text between the brackets.
        start: offset of its first character.
        end: offset after its last character.
    """

    kind: TokenKind
    text: str
    start: int
    end: int


_PIECE = r"""(?x)
    \$(?P<escaped>\$+[{(])
  | \$\{(?P<expression>[^}]*)\}
  | \$\((?P<substitution>[^)]*)\)
  | (?P<text>[^$]+|\$[^{($]+|\$\Z)
    """  # not compiled here: the texts of a small file seldom need it

_KINDS = {
    "escaped": TokenKind.TEXT,
    "expression": TokenKind.EXPRESSION,
    "substitution": TokenKind.SUBSTITUTION,
    "text": TokenKind.TEXT,
}


def tokenize(text: str) -> list[Token]:
    """The tokens of a text, which together cover all of it.

    Raises:
        Fault: XAC101 for a bracket that is never closed or a dollar sign that means nothing.
    """
    if text.startswith("${") and text.find("}") == len(text) - 1:
        return [Token(TokenKind.EXPRESSION, text[2:-1], 0, len(text))]  # most texts with a dollar
    pattern = re.compile(_PIECE)
    tokens: list[Token] = []
    at = 0
    while at < len(text):
        match = pattern.match(text, at)
        if match is None:
            raise _not_a_token(text, at)
        name = match.lastgroup
        assert name is not None, "every alternative of the pattern is named"
        tokens.append(Token(_KINDS[name], match[name], at, match.end()))
        at = match.end()
    return tokens


def _not_a_token(text: str, at: int) -> Fault:
    for opening, closing in (("${", "}"), ("$(", ")")):
        if text.startswith(opening, at):
            message = phrase(
                "'{opening}' is never closed: '{shortened}'", opening=opening, shortened=_shortened(text[at:])
            )
            return Fault("XAC101", message, at, len(text), phrase("close it with '{closing}'", closing=closing))
    message = phrase("'$$' means nothing here: '{shortened}'", shortened=_shortened(text[at:]))
    hint = phrase("'$$' is only for a literal '${' or '$('; write one '$' for a dollar sign")
    return Fault("XAC101", message, at, at + 2, hint)


def _shortened(text: str) -> str:
    return text if len(text) <= 60 else f"{text[:57]}..."
