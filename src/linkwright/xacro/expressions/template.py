"""Texts with ``${...}`` and ``$(...)`` in them, compiled once for each text and evaluated in any scope.

A text that is exactly one token keeps the type of its value, such as a float or a list; any other result is joined to a
string. The result is not evaluated again.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from enum import Enum

from linkwright.diagnostics import foreign, phrase
from linkwright.loading.lean_dataclasses import NamedTuple
from linkwright.loading.lean_typing import Any
from linkwright.xacro.expressions import sandbox
from linkwright.xacro.expressions.bounded import RefusalError
from linkwright.xacro.expressions.expression import Expression, compile_expression
from linkwright.xacro.expressions.scope import Scope
from linkwright.xacro.expressions.substitution import substitute
from linkwright.xacro.faults import Fault
from linkwright.xacro.kept import TextCompiler


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


_Part = Callable[["Scope"], Any]
_BRACKET = len("${")


class Template:
    """A compiled text.

    Attributes:
        evaluate: gives the value of the text in a scope, or raises a `Fault`, whose offsets count from the beginning
            of the text.
        changes: whether evaluating it may change a value, as ``${items.pop(0)}`` does.
    """

    __slots__ = ("changes", "evaluate")

    def __init__(self, text: str) -> None:
        self.changes = False
        tokens = tokenize(text)
        parts = [None if token.kind is TokenKind.TEXT else self._part(token) for token in tokens]
        only = parts[0] if len(parts) == 1 else None
        self.evaluate: _Part = only or _joined([token.text for token in tokens], parts)

    def _part(self, token: Token) -> _Part:
        kind, text, start, end = token
        if "$" in text:
            return self._nested(token)
        if kind is TokenKind.SUBSTITUTION:
            return _placed(lambda scope: substitute(text, scope.session), start, end)
        try:
            expression = Expression(text)
        except Fault as fault:
            fault.within(start, end, start + _BRACKET)
            raise
        self.changes = self.changes or expression.changes
        return _placed(expression.evaluate, start, end)

    def _nested(self, token: Token) -> _Part:
        """A token whose inside is itself a text: that text is evaluated first, and its value is the source."""
        kind, text, start, end = token
        inner = _placed(compile_template(text).evaluate, start, end)
        self.changes = True  # not known before it is evaluated

        def part(scope: Scope) -> Any:
            source = _as_text(inner(scope))
            try:
                if kind is TokenKind.SUBSTITUTION:
                    return substitute(source, scope.session)
                return compile_expression(source).evaluate(scope)
            except Fault as fault:
                fault.within(start, end, start + _BRACKET if source == text else None)
                raise

        return part


_compiler = TextCompiler(Template)
templates = _compiler.forms
"""The templates compiled so far, by their texts."""


def compile_template(text: str) -> Template:
    """The template of a text; the same text gives the same template.

    Raises:
        Fault: XAC101 or XAC102 when the text is malformed.
    """
    return templates.get(text) or _compiler.make(text)


def _placed(evaluate: _Part, start: int, end: int) -> _Part:
    def part(scope: Scope) -> Any:
        try:
            return evaluate(scope)
        except Fault as fault:
            fault.within(start, end, start + _BRACKET)
            raise

    return part


def _joined(texts: list[str], parts: list[_Part | None]) -> _Part:
    """A function that evaluates the parts of a text and joins them; without a part, the text itself is used."""
    evaluated = [(place, part) for place, part in enumerate(parts) if part is not None]

    def join(scope: Scope) -> str:
        pieces = texts.copy()
        for place, part in evaluated:
            value = part(scope)
            pieces[place] = value if value.__class__ is str else _as_text(value)
        try:
            return sandbox.joined(pieces)
        except RefusalError as error:
            raise Fault("XAC202", phrase("cannot write the value: {error}", error=foreign(error))) from None

    return join


def _as_text(value: Any) -> str:
    if value.__class__ is str:
        return value
    try:
        return sandbox.as_text(value)
    except (RefusalError, ValueError) as error:
        raise Fault("XAC202", phrase("cannot write the value: {error}", error=foreign(error))) from None
