"""The locations of texts that determine numbers, and candidates for edits of these texts."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator

from linkwright.descriptions.editing.numbers import format_degrees, format_pi_fraction, shortest_text
from linkwright.diagnostics import SourceText, Span
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import dataclass

_WORD = lazy_pattern(r"(?:\$\{[^}]*\}|\$\([^)]*\)|\S)+")
_ONE_EXPRESSION = lazy_pattern(r"\$\{([^{}]*)\}\Z|(\$\([^()]*\))\Z")
_ANGLE_NAMES = frozenset({"pi", "radians", "degrees", "math"})
_LOW_PRECEDENCE = (ast.IfExp, ast.BoolOp, ast.Compare, ast.Lambda, ast.NamedExpr)


@dataclass(frozen=True, slots=True)
class TextRange:
    """A range of characters in a source text, from `start` to `end` (exclusive)."""

    source: SourceText
    start: int
    end: int

    @property
    def text(self) -> str:
        """The text in the range."""
        return self.source.text[self.start : self.end]

    @property
    def span(self) -> Span:
        """The range as lines and columns."""
        return self.source.span(self.start, self.end)

    def subrange(self, start: int, end: int) -> TextRange:
        """Return a part of the range, with offsets from the start of this range."""
        return TextRange(self.source, self.start + start, self.start + end)


@dataclass(frozen=True, slots=True)
class Candidate:
    """A text that may determine a number.

    Attributes:
        text_range: the range of the text, which an edit replaces.
        value: the current value of the text.
        write: a function that returns the text for another value, given a tolerance.
        is_choice: whether the value is 1 or -1, which may be a factor that selects a side or a direction.
    """

    text_range: TextRange
    value: float
    write: Callable[[float, float], str]
    is_choice: bool = False


def words(text_range: TextRange) -> list[TextRange]:
    """Return the ranges of the words in a text, each expression as a single word."""
    return [text_range.subrange(*match.span()) for match in _WORD.finditer(text_range.text)]


def literal(text_range: TextRange) -> Candidate | None:
    """Return a candidate for a word that is a literal number, or None for any other word."""
    try:
        value = float(text_range.text)
    except ValueError:
        return None
    return Candidate(text_range, value, shortest_text, value in (1.0, -1.0))


def added_constants(word: TextRange) -> Iterator[Candidate]:
    """Yield candidates for the numbers on which an expression depends linearly.

    These are the terms of a sum, including a sum inside ``radians()``.
    """
    match = _ONE_EXPRESSION.match(word.text)
    expression = None if match is None else match[1]
    if expression is None or not expression.isascii():
        return
    body = expression.strip()
    expression_range = word.subrange(2, len(word.text) - 1)
    start = len(expression) - len(expression.lstrip())
    expression_range = expression_range.subrange(start, start + len(body))
    tree = _parse(body)
    if tree is not None:
        yield from _find_terms(tree, expression_range)


def is_constant(word: TextRange) -> bool:
    """Return whether a word is a constant expression.

    A constant expression has no names except pi and the conversions from degrees to radians.
    """
    match = _ONE_EXPRESSION.match(word.text)
    tree = _parse(match[1].strip()) if match is not None and match[1] else None
    return tree is not None and _find_used_names(tree) <= _ANGLE_NAMES


def replacement_candidate(word: TextRange, value: float) -> Candidate:
    """Return a candidate that replaces a whole word with a number.

    If the word contains pi or ``radians``, the number is written as a fraction of pi or in degrees, if possible.
    """

    def write(number: float, tolerance: float) -> str:
        if "pi" in word.text or "radians" in word.text:
            fraction = format_pi_fraction(number)
            if fraction is not None:
                return f"${{{fraction}}}"
            angle = format_degrees(number)
            if angle is not None and angle != "0":
                return f"${{radians({angle})}}"
        return shortest_text(number, tolerance)

    return Candidate(word, value, write)


def addition_candidate(word: TextRange, *, is_angle: bool) -> Candidate | None:
    """Return a candidate that adds a number to an expression.

    The result is None if the word is not a single expression.
    """
    match = _ONE_EXPRESSION.match(word.text)
    if match is None:
        return None
    body = (match[1] or match[2]).strip()
    tree = _parse(body) if match[1] else None
    if match[1] and tree is None:
        return None
    base = f"({body})" if isinstance(tree, _LOW_PRECEDENCE) else body

    def write(number: float, tolerance: float) -> str:
        magnitude = shortest_text(abs(number), tolerance)
        angle = format_degrees(abs(number)) if is_angle else None
        if angle is not None and len(angle) + len("radians()") < len(magnitude):
            magnitude = f"radians({angle})"
        return word.text if magnitude == "0" else f"${{{base} {'-' if number < 0 else '+'} {magnitude}}}"

    return Candidate(word, 0.0, write)


def _parse(body: str) -> ast.expr | None:
    try:
        return ast.parse(body, mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return None


def _find_used_names(tree: ast.AST) -> set[str]:
    return {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}


def _find_terms(node: ast.expr, expression_range: TextRange) -> Iterator[Candidate]:
    value = _evaluate_literal(node)
    if value is not None:
        yield _make_number_candidate(expression_range, node, value)
    elif isinstance(node, ast.BinOp) and isinstance(node.op, (ast.Add, ast.Sub)):
        signed_candidate = _find_signed_term(node, expression_range)
        yield from _find_terms(node.right, expression_range) if signed_candidate is None else (signed_candidate,)
        yield from _find_terms(node.left, expression_range)
    elif isinstance(node, ast.BinOp) and _converts_degrees(node):
        while isinstance(node, ast.BinOp):
            node = node.left
        yield from _find_terms(node, expression_range)
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.UAdd, ast.USub)):
        yield from _find_terms(node.operand, expression_range)
    elif isinstance(node, ast.Call) and len(node.args) == 1 and isinstance(node.func, (ast.Name, ast.Attribute)):
        name = node.func.id if isinstance(node.func, ast.Name) else node.func.attr
        if name == "radians":
            yield from _find_terms(node.args[0], expression_range)


def _converts_degrees(node: ast.expr) -> bool:
    """Return whether an expression converts an angle from degrees, such as ``30*pi/180``."""
    return (
        _find_used_names(node) <= _ANGLE_NAMES
        and "pi" in _find_used_names(node)
        and any(_evaluate_literal(child) == 180 for child in ast.walk(node))
    )


def _find_signed_term(node: ast.BinOp, expression_range: TextRange) -> Candidate | None:
    """Return a candidate for the last number of a sum, including its sign.

    The result is None if the last term is not a number, or is in brackets.
    """
    value = _evaluate_literal(node.right)
    if value is None:
        return None
    end, text = node.right.end_col_offset or 0, expression_range.text
    text_before = text[: node.right.col_offset].rstrip()
    sign = "+" if isinstance(node.op, ast.Add) else "-"
    if not text_before.endswith(sign):
        return None
    blanks = text[len(text_before) : node.right.col_offset]
    term = expression_range.subrange(len(text_before) - 1, end)

    def write(number: float, tolerance: float) -> str:
        return f"{'-' if number < 0 else '+'}{blanks}{shortest_text(abs(number), tolerance)}"

    return Candidate(term, value if sign == "+" else -value, write)


def _evaluate_literal(node: ast.AST) -> float | None:
    """Return the value of a literal number with its sign, or None for any other node."""
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub) and isinstance(node.operand, ast.Constant):
        value = _evaluate_literal(node.operand)
        return None if value is None else -value
    if isinstance(node, ast.Constant) and isinstance(node.value, (int, float)) and not isinstance(node.value, bool):
        return float(node.value)
    return None


def _make_number_candidate(expression_range: TextRange, node: ast.expr, value: float) -> Candidate:
    text_range = expression_range.subrange(node.col_offset, node.end_col_offset or node.col_offset)
    return Candidate(text_range, value, shortest_text, value in (1.0, -1.0))
