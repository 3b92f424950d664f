"""Read the texts of several lines in a source, such as templates of files that a program writes."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from linkwright.diagnostics import SourceText
from linkwright.review.sources.python_names import parse_source
from linkwright.review.sources.statements.code import is_skipped
from linkwright.review.sources.statements.cpp import is_output, read_cpp_blocks
from linkwright.review.sources.statements.literals import TEXTS_FOR_READERS
from linkwright.review.sources.statements.python import get_blocks
from linkwright.review.sources.statements.tokens import Token, TokenKind

_MIN_WORDS = 3
"""The minimum number of words of a text. Shorter ones are compared as values."""
_RAW_TEXT = re.compile(r"(?:u8|[uUL])?R\"(?P<mark>[^(\s]*)\((?P<text>.*)\)(?P=mark)\"", re.DOTALL)
_ESCAPES = {"n": "\n", "t": "\t", '"': '"', "'": "'", "\\": "\\"}
_ESCAPE = re.compile(r"\\(.)", re.DOTALL)


class LongText(NamedTuple):
    """A text of several lines.

    Attributes:
        scope: the function or class that contains it; empty for the module.
        name: the variable, parameter or function that gets it; empty if unknown.
        lines: its lines without indentation, except empty ones.
        numbers: the number in the source of each of these lines.
    """

    scope: str
    name: str
    lines: list[str]
    numbers: list[int]


def read_python_texts(source: SourceText) -> Iterator[LongText]:
    """Yield the texts of several lines in a Python source, except docstrings and output.

    Raises:
        SyntaxError: the text is neither Python 3 nor Python 2.
    """
    yield from _read_statements(parse_source(source).tree.body, "")


def _read_statements(body: Sequence[ast.stmt], scope: str) -> Iterator[LongText]:
    for node in body:
        if is_skipped(node) or isinstance(node, (ast.Raise, ast.Assert)):
            continue
        blocks = get_blocks(node)
        inner = [child for block in blocks for child in block]
        expressions = [child for child in ast.iter_child_nodes(node) if isinstance(child, (ast.expr, ast.keyword))]
        name = _find_target(node)
        for expression in expressions:
            yield from _read_expression(expression, scope, name)
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            yield from _read_statements(inner, f"{scope}.{node.name}".lstrip("."))
        else:
            yield from _read_statements(inner, scope)


def _find_target(node: ast.stmt) -> str:
    """Return the name that a statement assigns; empty if it assigns none."""
    targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
    target = targets[0]
    return ast.unparse(target) if isinstance(target, (ast.Name, ast.Attribute, ast.Subscript)) else ""


def _read_expression(node: ast.AST, scope: str, name: str) -> Iterator[LongText]:
    if isinstance(node, (ast.Constant, ast.JoinedStr)):
        yield from _make_python_text(node, scope, name)
        return
    if isinstance(node, ast.keyword):
        if node.arg in TEXTS_FOR_READERS:
            return
        name = node.arg or name
    elif isinstance(node, ast.Call):
        function = ast.unparse(node.func) if isinstance(node.func, (ast.Name, ast.Attribute)) else ""
        name = name or (function if "\n" not in function else "")
    for child in ast.iter_child_nodes(node):
        yield from _read_expression(child, scope, name)


def _make_python_text(node: ast.Constant | ast.JoinedStr, scope: str, name: str) -> Iterator[LongText]:
    parts = [node] if isinstance(node, ast.Constant) else node.values
    text = ""
    for part in parts:
        if isinstance(part, ast.Constant):
            text += part.value if isinstance(part.value, str) else ""
        elif isinstance(part, ast.FormattedValue):
            text += f"{{{ast.unparse(part.value)}}}"
    is_literal = (node.end_lineno or node.lineno) - node.lineno == text.count("\n")
    yield from _make_text(scope, name, text, node.lineno, 1 if is_literal else 0)


def _make_text(scope: str, name: str, text: str, line: int, step: int) -> Iterator[LongText]:
    """Yield the text if it has several lines.

    Args:
        scope: the function or class that contains it.
        name: the name that gets it.
        text: the value of the text.
        line: the number of its first line in the source.
        step: 1 if each line of the text is a line of the source, or else 0.
    """
    if "\n" not in text.strip() or len(text.split(None, _MIN_WORDS)) < _MIN_WORDS:
        return
    items = [(content, line + index * step) for index, row in enumerate(text.split("\n")) if (content := row.strip())]
    yield LongText(scope, name, [content for content, _ in items], [number for _, number in items])


def read_cpp_texts(source: SourceText) -> Iterator[LongText]:
    """Yield the texts of several lines in a C++ source, except output."""
    blocks, _ = read_cpp_blocks(source.text)
    for scope, statements in blocks.items():
        for tokens in statements:
            if not is_output(tokens):
                yield from _read_tokens(source, scope, tokens)


def _read_tokens(source: SourceText, scope: str, tokens: Sequence[Token]) -> Iterator[LongText]:
    index = 0
    while index < len(tokens):
        end = index
        while end < len(tokens) and tokens[end].kind is TokenKind.TEXT:
            end += 1
        texts = tokens[index:end]
        if texts:
            text = "".join(_read_cpp_text(token.text) for token in texts)
            line = source.text.count("\n", 0, texts[0].start) + 1
            line_count = source.text.count("\n", texts[0].start, texts[-1].end)
            yield from _make_text(scope, _find_name(tokens, index), text, line, int(line_count == text.count("\n")))
        index = max(end, index + 1)


def _read_cpp_text(text: str) -> str:
    raw = _RAW_TEXT.fullmatch(text)
    if raw is not None:
        return raw["text"]
    return _ESCAPE.sub(lambda match: _ESCAPES.get(match[1], match[0]), text[text.find(text[-1]) + 1 : -1])


def _find_name(tokens: Sequence[Token], index: int) -> str:
    """Return the last name before a text, such as a variable or a function."""
    words = [token.text for token in tokens[:index] if token.kind is TokenKind.WORD]
    return words[-1] if words else ""
