"""Write texts that an argument chooses as expressions of XML launch files, and resolve them."""

from __future__ import annotations

import ast
import re

from linkwright.packages.readers.python_values import parse_python_expression
from linkwright.review.launches.conditions import evaluate_test

_START, _END = "$(eval ", ")"
_SIMPLE_TEXT = re.compile(r"(?:[^'\"$()\\`]|\$\((?:var|arg|env|optenv|find|find-pkg-share) [^'\"$()\\`]*\))*")
"""A text without quotes, calls and expressions."""
_EXPRESSION = re.compile(r"\$\(eval (?P<text>(?:'[^']*'|[^'()]|\((?:'[^']*'|[^'()])*\))*)\)")
_MAX_CHARACTERS = 500
"""The maximum length of an expression that is parsed."""


def quote_text(text: str) -> str | None:
    """Return a text as a term of an expression, or None if it is not simple. A choice has its own terms."""
    match = _EXPRESSION.fullmatch(text)
    if match is not None and _parse_choice(match["text"]) is not None:
        return text.removeprefix(_START).removesuffix(_END)
    return f"'{text}'" if _SIMPLE_TEXT.fullmatch(text) else None


def make_choice(test: str, body: str, other: str) -> str:
    """Return an expression that has one of two values.

    Args:
        test: the test, as ``$(eval ...)``.
        body: the term for the value if the test holds.
        other: the term for the value otherwise.
    """
    return f"{_START}{body} if {test.removeprefix(_START).removesuffix(_END)} else {other}{_END}"


def resolve_choices(text: str) -> str:
    """Return a text with the chosen values in place of expressions whose tests are known."""
    return _EXPRESSION.sub(_replace_choice, text) if _START in text else text


def is_choice(text: str) -> bool:
    """Return whether a text contains an expression that has one of two values."""
    return any(_parse_choice(match["text"]) is not None for match in _EXPRESSION.finditer(text))


def _parse_choice(text: str) -> ast.IfExp | None:
    """Return the syntax tree of an expression that has one of two values, or None for other expressions."""
    if " if " not in text or len(text) > _MAX_CHARACTERS:
        return None
    try:
        node = parse_python_expression(text)
    except (SyntaxError, ValueError, RecursionError):
        return None
    return node if isinstance(node, ast.IfExp) else None


def _replace_choice(match: re.Match[str]) -> str:
    node: ast.expr | None = None if "$(" in match["text"] else _parse_choice(match["text"])
    while isinstance(node, ast.IfExp):
        holds = evaluate_test(node.test)
        node = None if holds is None else node.body if holds else node.orelse
    return str(node.value) if isinstance(node, ast.Constant) else match[0]
