"""Find code in C++ that no compiler accepts: statements that break off, and the marks of an unresolved merge."""

from __future__ import annotations

import re

from linkwright.diagnostics import Phrase, phrase
from linkwright.review.sources.cpp.preprocessor import blank_disabled
from linkwright.review.sources.statements.tokens import Token, TokenKind, join_tokens, tokenize_cpp
from linkwright.review.texts.excerpts import shorten_middle

_DIRECTIVE = re.compile(r"^[ \t]*#(?:[^\n\\]|\\\r?\n|\\.)*", re.MULTILINE)
_CONFLICT = re.compile(r"^<<<<<<< .*\n(?:(?!<<<<<<< ).*\n)*?=======\r?\n(?:.*\n)*?>>>>>>> ", re.MULTILINE)
_UNFINISHED = frozenset({".", "->", "=", "||", "<<", "==", "!=", "<=", ">=", "+=", "-=", "*=", "/="})
"""Operators that need something behind them."""
_ENDS = frozenset({";", "}", ")"})
_BEFORE = frozenset({"operator", "(", ","})
"""Tokens before an operator that needs nothing behind it: its function, or the arguments of a macro."""
_MAX_CHARACTERS = 60


def find_broken_code(text: str) -> tuple[Phrase, int] | None:
    """Return a sentence about the first place of a source that no compiler accepts, with its offset, or None.

    Only operators without an operand and marks of a merge are certain: macros may complete other code.
    """
    conflict = _CONFLICT.search(text)
    if conflict is not None:
        return phrase("has the marks of an unresolved merge, such as '<<<<<<<'"), conflict.start()
    code = _DIRECTIVE.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), blank_disabled(text))
    tokens = tokenize_cpp(code)
    for index in range(1, len(tokens) - 1):
        token, following = tokens[index], tokens[index + 1]
        is_unfinished = _is_operator(token) and token.text in _UNFINISHED and tokens[index - 1].text not in _BEFORE
        if is_unfinished and _is_operator(following) and following.text in _ENDS:
            return phrase("`{code}` breaks off", code=_format_statement(tokens[: index + 1])), token.start
    return None


def _is_operator(token: Token) -> bool:
    return token.kind is TokenKind.OPERATOR


def _format_statement(tokens: list[Token]) -> str:
    """Return the last statement of tokens."""
    starts = (index for index, token in enumerate(tokens) if _is_operator(token) and token.text in (";", "{", "}"))
    statement = tokens[max(starts, default=-1) + 1 :]
    return shorten_middle(join_tokens(statement), _MAX_CHARACTERS)
