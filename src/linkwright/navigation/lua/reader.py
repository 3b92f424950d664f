"""A reader of configuration files in Lua: assignments, tables, expressions and includes.

Configurations assign tables, override some of their values and return a table. The reader evaluates them without a Lua
interpreter, so a file cannot run code, and each value has its place. Functions, loops and conditions are errors that
name the place. As in Cartographer, ``include`` evaluates another file in the same environment, a file is included only
once, ``choose(condition, a, b)`` selects a value and ``math`` has the functions of Lua.

Sources: the Lua 5.3 Reference Manual, section 3; Cartographer's documentation, "Lua configuration reference".
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from linkwright.diagnostics import SourceText, did_you_mean, phrase
from linkwright.navigation.lua.tables import Key, Place, Table, Value
from linkwright.navigation.lua.tokens import Token, iterate_tokens, make_error

_STATEMENTS = frozenset({"break", "do", "for", "function", "goto", "if", "repeat", "while"})
_WORDS = frozenset({"and", "or", "not", "nil", "true", "false", "local", "return", "end", "then", "else", *_STATEMENTS})
_PRECEDENCE: Mapping[str, int] = {
    "or": 1,
    "and": 2,
    **dict.fromkeys(("<", ">", "<=", ">=", "~=", "=="), 3),
    "..": 4,
    **dict.fromkeys(("+", "-"), 5),
    **dict.fromkeys(("*", "/", "//", "%"), 6),
}
"""The precedence of operators between two values; a higher one binds tighter."""
_RIGHT_TO_LEFT = frozenset({".."})
_ARITHMETIC: Mapping[str, Callable[[float, float], float]] = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": lambda a, b: a / b,
    "//": lambda a, b: float(a // b),
    "%": lambda a, b: a % b,
    "^": lambda a, b: a**b,
}
_COMPARISONS: Mapping[str, Callable[[float, float], bool]] = {
    "<": lambda a, b: a < b,
    ">": lambda a, b: a > b,
    "<=": lambda a, b: a <= b,
    ">=": lambda a, b: a >= b,
}
_MATH_CONSTANTS: Mapping[str, float] = {"pi": math.pi, "huge": math.inf}
_MATH_FUNCTIONS: Mapping[str, Callable[..., float]] = {
    **{name: getattr(math, name) for name in ("sqrt", "exp", "log", "sin", "cos", "tan", "asin", "acos")},
    "abs": abs,
    "atan": lambda y, x=1.0: math.atan2(y, x),
    "ceil": lambda x: float(math.ceil(x)),
    "deg": math.degrees,
    "floor": lambda x: float(math.floor(x)),
    "max": max,
    "min": min,
    "rad": math.radians,
}
_MAX_DEPTH = 100


@dataclass(slots=True, eq=False)
class Environment:
    """The variables of a configuration, and the files that it includes.

    Attributes:
        read: returns the text of an included file; raises LinkwrightError if it does not exist.
        variables: the global variables.
        included: the names of the files that were included.
    """

    read: Callable[[str, Place], SourceText]
    variables: Table = field(default_factory=Table)
    included: set[str] = field(default_factory=set)


def evaluate(source: SourceText, environment: Environment) -> Value:
    """Evaluate a file, and return the value that it returns, or None.

    Raises:
        LinkwrightError: NAV601, the file is not valid; or an error of the environment about an included file.
    """
    return _Reader(source, environment).read()


class _Reader:
    """An evaluation of one file, word by word."""

    def __init__(self, source: SourceText, environment: Environment) -> None:
        self._source, self._environment = source, environment
        self._tokens = list(iterate_tokens(source))
        self._index = 0
        self._depth = 0

    def read(self) -> Value:
        while self._token.kind != "end":
            if self._accepts("return"):
                value = None if self._token.kind == "end" else self._read_expression()
                self._accepts(";")
                if self._token.kind != "end":
                    raise make_error(self._source, self._token, phrase("'return' must be the last statement"))
                return value
            self._read_statement()
        return None

    # --- words --------------------------------------------------------------------------------------------------------

    @property
    def _token(self) -> Token:
        return self._tokens[self._index]

    def _next(self) -> Token:
        token = self._token
        if token.kind != "end":
            self._index += 1
        return token

    def _is_at(self, text: str) -> bool:
        return self._token.kind in ("symbol", "name") and self._token.text == text

    def _accepts(self, text: str) -> bool:
        if self._is_at(text):
            self._index += 1
            return True
        return False

    def _expect(self, text: str) -> None:
        if not self._accepts(text):
            found = self._token
            if found.kind == "end":
                message = phrase("'{text}' is missing at the end of the file", text=text)
            else:
                message = phrase("'{text}' is missing before '{found}'", text=text, found=found.text)
            raise make_error(self._source, found, message)

    def _expect_name(self) -> Token:
        token = self._next()
        if token.kind != "name" or token.text in _WORDS:
            raise make_error(self._source, token, phrase("a name is missing here"))
        return token

    def _place(self, first: Token) -> Place:
        return Place(self._source, first.start, self._tokens[self._index - 1].end)

    # --- statements ---------------------------------------------------------------------------------------------------

    def _read_statement(self) -> None:
        if self._accepts(";"):
            return
        token = self._token
        if token.text in _STATEMENTS and token.kind == "name":
            hint = phrase("write the values themselves: Linkwright reads assignments, tables and expressions")
            message = phrase("'{word}' is not supported in configurations", word=token.text)
            raise make_error(self._source, token, message, hint)
        self._accepts("local")
        name = self._expect_name()
        if name.text == "include":
            self._include(name)
            return
        self._assign(name)

    def _include(self, name: Token) -> None:
        has_parenthesis = self._accepts("(")
        path = self._next()
        if path.kind != "string":
            raise make_error(self._source, path, phrase("the name of the included file is missing"))
        if has_parenthesis:
            self._expect(")")
        environment = self._environment
        if path.text in environment.included:
            return
        environment.included.add(path.text)
        evaluate(environment.read(path.text, self._place(name)), environment)

    def _assign(self, name: Token) -> None:
        table, last = self._environment.variables, name
        key: Key = name.text
        while self._is_at(".") or self._is_at("["):
            table = self._descend(table, key, last)
            last, key = self._read_key()
        self._expect("=")
        value = self._read_expression()
        table.assign(key, value, self._place(name))

    def _descend(self, table: Table, key: Key, token: Token) -> Table:
        value = table.values.get(key)
        if isinstance(value, Table):
            return value
        if value is None:
            message = phrase("'{name}' does not exist", name=key)
            hint = did_you_mean(str(key), [str(name) for name in table.values])
        else:
            message, hint = phrase("'{name}' is not a table", name=key), None
        raise make_error(self._source, token, message, hint)

    def _read_key(self) -> tuple[Token, Key]:
        """Read ``.name`` or ``[expression]``, and return the key with its first word."""
        if self._accepts("."):
            token = self._expect_name()
            return token, token.text
        self._expect("[")
        token, key = self._token, self._read_expression()
        self._expect("]")
        return token, self._check_key(key, token)

    def _check_key(self, key: Value, token: Token) -> Key:
        if isinstance(key, bool) or not isinstance(key, (str, int, float)):
            raise make_error(self._source, token, phrase("a key is a string or a number"))
        return key

    # --- expressions --------------------------------------------------------------------------------------------------

    def _read_expression(self, precedence: int = 1) -> Value:
        """Read values with operators of at least the given precedence between them."""
        left = self._read_unary()
        while self._token.kind in ("symbol", "name"):
            found = _PRECEDENCE.get(self._token.text, 0)
            if found < precedence:
                break
            operator = self._next()
            right = self._read_expression(found if operator.text in _RIGHT_TO_LEFT else found + 1)
            left = self._combine(operator, left, right)
        return left

    def _read_unary(self) -> Value:
        self._depth += 1
        if self._depth > _MAX_DEPTH:
            raise make_error(self._source, self._token, phrase("the tables and parentheses are nested too deep"))
        value = self._apply_unary()
        self._depth -= 1
        return value

    def _apply_unary(self) -> Value:
        operator = self._token
        if self._accepts("not"):
            return not _is_true(self._read_unary())
        if self._accepts("-"):
            return -self._number(self._read_unary(), operator)
        if self._accepts("#"):
            return self._length(self._read_unary(), operator)
        base = self._read_operand()
        if self._is_at("^"):
            operator = self._next()
            return self._combine(operator, base, self._read_unary())
        return base

    def _length(self, value: Value, operator: Token) -> float:
        if isinstance(value, str):
            return len(value)
        if isinstance(value, Table):
            return next(count for count in range(len(value.values) + 1) if count + 1 not in value.values)
        raise make_error(self._source, operator, phrase("only strings and tables have a length"))

    def _combine(self, operator: Token, left: Value, right: Value) -> Value:
        name = operator.text
        if name == "and":
            return right if _is_true(left) else left
        if name == "or":
            return left if _is_true(left) else right
        if name in ("==", "~="):
            is_equal = left is right if isinstance(left, Table) else type(left) is type(right) and left == right
            return is_equal == (name == "==")
        if name == "..":
            return self._text(left, operator) + self._text(right, operator)
        if name in _COMPARISONS:
            return _COMPARISONS[name](self._number(left, operator), self._number(right, operator))
        try:
            return _ARITHMETIC[name](self._number(left, operator), self._number(right, operator))
        except (ArithmeticError, ValueError):
            raise make_error(self._source, operator, phrase("the result is not a finite number")) from None

    def _number(self, value: Value, token: Token) -> float:
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            message = phrase("'{operator}' needs numbers", operator=token.text)
            raise make_error(self._source, token, message)
        return float(value)

    def _text(self, value: Value, token: Token) -> str:
        if isinstance(value, str):
            return value
        return f"{self._number(value, token):.14g}"

    def _read_operand(self) -> Value:
        token = self._token
        if token.kind == "number":
            self._index += 1
            return float(int(token.text, 16)) if token.text[:2] in ("0x", "0X") else float(token.text)
        if token.kind == "string":
            self._index += 1
            return token.text
        for word, value in (("true", True), ("false", False), ("nil", None)):
            if self._accepts(word):
                return value
        if self._is_at("{"):
            return self._read_table()
        if self._accepts("("):
            value_in_parentheses = self._read_expression()
            self._expect(")")
            return self._follow(value_in_parentheses)
        if token.kind == "name" and token.text not in _WORDS:
            return self._read_variable()
        if token.text in _STATEMENTS:
            raise make_error(
                self._source, token, phrase("'{word}' is not supported in configurations", word=token.text)
            )
        raise make_error(self._source, token, phrase("a value is missing here"))

    def _read_variable(self) -> Value:
        name = self._next()
        variables = self._environment.variables.values
        if name.text == "math" and "math" not in variables:
            return self._read_math()
        if self._is_at("("):
            if name.text == "choose":
                return self._choose()
            message = phrase("the function '{name}' is not supported", name=name.text)
            hint = phrase("write the value itself: configurations use choose and the functions of math")
            raise make_error(self._source, name, message, hint)
        value = variables.get(name.text)
        if value is None and (self._is_at(".") or self._is_at("[")):
            self._descend(self._environment.variables, name.text, name)
        return self._follow(value)

    def _follow(self, value: Value) -> Value:
        """Read the keys that follow a value."""
        while self._is_at(".") or self._is_at("["):
            token = self._token
            if not isinstance(value, Table):
                raise make_error(self._source, token, phrase("the value before this is not a table"))
            value = value.values.get(self._read_key()[1])
        return value

    def _read_math(self) -> float:
        self._expect(".")
        name = self._expect_name()
        if name.text in _MATH_CONSTANTS:
            return _MATH_CONSTANTS[name.text]
        function = _MATH_FUNCTIONS.get(name.text)
        if function is None:
            hint = did_you_mean(name.text, [*_MATH_CONSTANTS, *_MATH_FUNCTIONS])
            raise make_error(self._source, name, phrase("'math.{name}' does not exist", name=name.text), hint)
        arguments = [self._number(value, name) for value in self._read_arguments()]
        try:
            return float(function(*arguments))
        except (ArithmeticError, TypeError, ValueError):
            raise make_error(self._source, name, phrase("'math.{name}' cannot be computed", name=name.text)) from None

    def _choose(self) -> Value:
        name = self._token
        arguments = self._read_arguments()
        if len(arguments) != 3:
            raise make_error(self._source, name, phrase("choose needs a condition and two values"))
        return arguments[1] if _is_true(arguments[0]) else arguments[2]

    def _read_arguments(self) -> list[Value]:
        self._expect("(")
        arguments: list[Value] = []
        while not self._accepts(")"):
            if arguments:
                self._expect(",")
            arguments.append(self._read_expression())
        return arguments

    def _read_table(self) -> Table:
        table, count = Table(), 0
        self._expect("{")
        while not self._accepts("}"):
            first = self._token
            following = self._tokens[min(self._index + 1, len(self._tokens) - 1)]
            if self._is_at("["):
                _, key = self._read_key()
                self._expect("=")
            elif first.kind == "name" and following.text == "=" and following.kind == "symbol":
                key = self._expect_name().text
                self._expect("=")
            else:
                count += 1
                key = count
            value = self._read_expression()
            table.assign(key, value, self._place(first))
            if not (self._accepts(",") or self._accepts(";") or self._is_at("}")):
                self._expect("}")
        return table


def _is_true(value: Value) -> bool:
    return value is not None and value is not False
