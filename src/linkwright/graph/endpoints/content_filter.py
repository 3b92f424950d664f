"""Content filters: conditions on message fields, in the SQL subset of DDS 1.4 (annex B).

An example is ``temperature > 20 AND header.frame_id LIKE 'base%'``. Parameters are written as ``%0``, ``%1``, ...
Nested fields are written with dots (``header.frame_id``), and array elements with an index in brackets
(``position[0]``).
"""

from __future__ import annotations

import operator
import re
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, NamedTuple

from linkwright.diagnostics import phrase

Condition = Callable[[Any], bool]
_Value = Callable[[Any], Any]

_TOKEN = re.compile(
    r"""\s*(?:(?P<number>[-+]?(?:0[xX][0-9a-fA-F]+|(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?))"""
    r"""|(?P<text>['`](?:[^'])*')"""
    r"""|(?P<parameter>%\d+)"""
    r"""|(?P<name>[A-Za-z_]\w*(?:\[\d+\])*(?:\.[A-Za-z_]\w*(?:\[\d+\])*)*)"""
    r"""|(?P<sign><>|!=|<=|>=|=|<|>|\(|\)))"""
)
_RELATIONS: dict[str, Callable[[Any, Any], Any]] = {
    "=": operator.eq,
    "<>": operator.ne,
    "!=": operator.ne,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}
_KEYWORDS = frozenset({"AND", "OR", "NOT", "BETWEEN", "LIKE", "MATCH", "TRUE", "FALSE"})
_WILDCARDS = {"%": ".*", "*": ".*", "_": ".", "?": "."}
_MAX_PARAMETERS = 100
_PATH_STEP = re.compile(r"(\w+)|\[(\d+)\]")


class ContentFilterError(ValueError):
    """Raised when a condition cannot be parsed, or names a missing field or parameter."""


class ContentFilterOptions(NamedTuple):
    """The content filter of a subscription (rclpy ``ContentFilterOptions``).

    Attributes:
        filter_expression: the condition; empty for no filter.
        expression_parameters: the values of ``%0``, ``%1``, ... in the condition; strings may be quoted or not.
    """

    filter_expression: str
    expression_parameters: Sequence[str] = ()


class ContentFilter:
    """A condition on the messages of one type.

    Args:
        options: the condition and its parameters.
        message_class: the class of the messages.

    Raises:
        ContentFilterError: the condition cannot be parsed, or a field or parameter does not exist.
    """

    def __init__(self, options: ContentFilterOptions, message_class: Any) -> None:
        self.options = options
        if len(options.expression_parameters) > _MAX_PARAMETERS:
            raise ContentFilterError(f"a content filter takes at most {_MAX_PARAMETERS} parameters")
        self._condition = _Parser(options, message_class).parse()

    def accepts(self, message: Any) -> bool:
        """Return whether a message meets the condition."""
        return self._condition(message)


@dataclass(frozen=True, slots=True)
class _Token:
    kind: str
    text: str

    @property
    def keyword(self) -> str:
        """The keyword in upper case, or an empty string for any other token."""
        return self.text.upper() if self.kind == "name" and self.text.upper() in _KEYWORDS else ""


_END = _Token("end", "")


class _Parser:
    """A recursive-descent parser that converts an expression to a condition."""

    def __init__(self, options: ContentFilterOptions, message_class: Any) -> None:
        self._text = options.filter_expression
        self._parameters = options.expression_parameters
        self._class = message_class
        self._tokens = self._tokenize()

    def parse(self) -> Condition:
        condition = self._parse_disjunction()
        if self._tokens[0] is not _END:
            raise self._make_error(f"unexpected '{self._tokens[0].text}'")
        return condition

    def _tokenize(self) -> list[_Token]:
        tokens: list[_Token] = []
        index = 0
        while self._text[index:].strip():
            match = _TOKEN.match(self._text, index)
            if match is None or match.lastgroup is None:
                raise self._make_error(f"'{self._text[index:].strip()[:10]}' cannot be parsed")
            tokens.append(_Token(match.lastgroup, match[match.lastgroup]))
            index = match.end()
        return [*tokens, _END]

    def _make_error(self, problem: str) -> ContentFilterError:
        return ContentFilterError(f"content filter '{self._text}': {problem}")

    def _next_token(self) -> _Token:
        return self._tokens.pop(0) if self._tokens[0] is not _END else _END

    def _accept(self, symbol: str) -> bool:
        token = self._tokens[0]
        if symbol in (token.keyword, token.text if token.kind == "sign" else None):
            self._next_token()
            return True
        return False

    def _expect(self, symbol: str) -> None:
        if not self._accept(symbol):
            raise self._make_error(f"'{symbol}' is missing before '{self._tokens[0].text or 'its end'}'")

    # --- the grammar ---------------------------------------------------------------------------------------------

    def _parse_disjunction(self) -> Condition:
        conditions = [self._parse_conjunction()]
        while self._accept("OR"):
            conditions.append(self._parse_conjunction())
        return (
            conditions[0]
            if len(conditions) == 1
            else lambda message: any(condition(message) for condition in conditions)
        )

    def _parse_conjunction(self) -> Condition:
        conditions = [self._parse_negation()]
        while self._accept("AND"):
            conditions.append(self._parse_negation())
        return (
            conditions[0]
            if len(conditions) == 1
            else lambda message: all(condition(message) for condition in conditions)
        )

    def _parse_negation(self) -> Condition:
        if self._accept("NOT"):
            condition = self._parse_negation()
            return lambda message: not condition(message)
        if self._accept("("):
            condition = self._parse_disjunction()
            self._expect(")")
            return condition
        return self._parse_predicate()

    def _parse_predicate(self) -> Condition:
        operand = self._parse_operand()
        if self._accept("NOT"):
            self._expect("BETWEEN")
            between = self._parse_between(operand)
            return lambda message: not between(message)
        if self._accept("BETWEEN"):
            return self._parse_between(operand)
        token = self._next_token()
        if token.keyword in ("LIKE", "MATCH"):
            return self._parse_like(operand, regular=token.keyword == "MATCH")
        relation = _RELATIONS.get(token.text)
        if relation is None:
            raise self._make_error(f"a comparison is missing before '{token.text or 'its end'}'")
        return _make_comparison(operand, relation, self._parse_operand())

    def _parse_between(self, value: _Value) -> Condition:
        low = _make_comparison(value, operator.ge, self._parse_operand())
        self._expect("AND")
        high = _make_comparison(value, operator.le, self._parse_operand())
        return lambda message: low(message) and high(message)

    def _parse_like(self, value: _Value, *, regular: bool) -> Condition:
        pattern = str(self._parse_operand()(None))
        try:
            regex = re.compile(
                pattern
                if regular
                else "".join(_WILDCARDS.get(character, re.escape(character)) for character in pattern)
            )
        except re.error as error:
            raise self._make_error(f"'{pattern}' is not a regular expression: {error}") from error
        return lambda message: isinstance(text := value(message), str) and regex.fullmatch(text) is not None

    def _parse_operand(self) -> _Value:
        token = self._next_token()
        if token.kind == "parameter":
            number = int(token.text[1:])
            if number >= len(self._parameters):
                raise self._make_error(f"there is no parameter {token.text}")
            return _make_constant(_parse_literal(self._parameters[number]))
        if token.kind in ("number", "text") or token.keyword in ("TRUE", "FALSE"):
            return _make_constant(_parse_literal(token.text))
        if token.kind == "name" and not token.keyword:
            return self._parse_field(token.text)
        raise self._make_error(f"a field or value is missing before '{token.text or 'its end'}'")

    def _parse_field(self, path: str) -> _Value:
        steps: list[str | int] = [int(index) if index else name for name, index in _PATH_STEP.findall(path)]
        try:
            _read_field(self._class(), steps)
        except AttributeError:
            raise self._make_error(
                phrase("{type_name} has no field '{name}'", type_name=self._class.TYPE_NAME, name=path)
            ) from None
        except (IndexError, TypeError):
            pass  # An array element: a received message may have a longer sequence.
        return lambda message: _read_field(message, steps)


def _read_field(message: Any, steps: Sequence[str | int]) -> Any:
    value = message
    for step in steps:
        value = value[step] if isinstance(step, int) else getattr(value, step)
    return value[0] if isinstance(value, bytes) and len(value) == 1 else value


def _make_comparison(get_left: _Value, relation: Callable[[Any, Any], Any], get_right: _Value) -> Condition:
    def holds(message: Any) -> bool:
        try:
            left_value, right_value = get_left(message), get_right(message)
            if isinstance(left_value, str) != isinstance(right_value, str):  # One of them is a parameter.
                left_value, right_value = str(left_value), str(right_value)
            return bool(relation(left_value, right_value))
        except (IndexError, TypeError):  # The sequence is too short, or the values cannot be compared.
            return False

    return holds


def _make_constant(value: Any) -> _Value:
    return lambda _message: value


def _parse_literal(text: str) -> Any:
    """Return the value of a literal: an int, float or bool, or a string with or without quotes."""
    text = text.strip()
    if len(text) > 1 and text[0] in "'`" and text[-1] == "'":
        return text[1:-1]
    if text.upper() in ("TRUE", "FALSE"):
        return text.upper() == "TRUE"
    if re.fullmatch(r"[-+]?(0[xX][0-9a-fA-F]+|\d+)", text):
        return int(text, 16 if "x" in text.lower() else 10)
    with suppress(ValueError):
        return float(text)
    return text
