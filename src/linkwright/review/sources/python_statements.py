"""Read the statements of a Python source by function."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Sequence

from linkwright.diagnostics import SourceText
from linkwright.review.sources.python import parse_source
from linkwright.review.sources.statements import Statement, statement_of
from linkwright.review.sources.tokens import python_tokens

_OUTPUT = re.compile(
    r"(?:print|pprint|warn|log\w*|_?log(?:ger)?|debug|info|warning|error|critical|exception|fatal|echo|write|"
    r"set_description|input|exit)",
    re.IGNORECASE,
)
"""The functions whose strings are for human readers."""


def python_statements(source: SourceText) -> dict[str, list[Statement]]:
    """Return the statements of a source by the name of their function or class; empty for the module.

    Raises:
        SyntaxError: the text is neither Python 3 nor Python 2.
    """
    python = parse_source(source)
    functions: dict[str, list[Statement]] = {}
    text = python.source.text
    line_starts = [0]
    for line in text.splitlines(keepends=True):
        line_starts.append(line_starts[-1] + len(line))
    reader = _Reader(text, line_starts)
    for name, start, end in reader.parts(python.tree.body, ""):
        tokens = python_tokens(text, start, end)
        if tokens:
            functions.setdefault(name, []).append(statement_of(tokens))
    return functions


class _Reader:
    def __init__(self, text: str, line_starts: Sequence[int]) -> None:
        self._lines = text.splitlines()
        self._starts = line_starts

    def parts(self, body: Sequence[ast.stmt], scope: str) -> Iterator[tuple[str, int, int]]:
        """Yield the function name, start and end offset of each statement without nested statements."""
        for node in body:
            if _is_for_readers(node):
                continue
            blocks = blocks_of(node)
            if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
                inner = f"{scope}.{node.name}" if scope else node.name
                decorators = (
                    self._offset(decorator.end_lineno or 0, decorator.end_col_offset or 0)
                    for decorator in node.decorator_list
                )
                start = max([self._offset(node.lineno, node.col_offset), *decorators])
                yield inner, start, self._start(blocks[0][0])
                yield from self.parts(node.body, inner)
                continue
            start = self._offset(node.lineno, node.col_offset)
            if not blocks:
                yield scope, start, self._offset(node.end_lineno or node.lineno, node.end_col_offset or 0)
                continue
            yield scope, start, self._start(blocks[0][0])
            for block in blocks:
                yield from self.parts(block, scope)

    def _start(self, node: ast.stmt) -> int:
        """Return the offset of the first decorator of a statement, or of the statement itself."""
        places = [(node.lineno, node.col_offset)]
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            places += [(decorator.lineno, decorator.col_offset - 1) for decorator in node.decorator_list]
        return self._offset(*min(places))

    def _offset(self, line: int, column: int) -> int:
        """Return the offset in characters of a line and a column, which counts bytes in UTF-8."""
        content = self._lines[line - 1]
        if not content.isascii():
            column = len(content.encode()[: max(column, 0)].decode(errors="ignore"))
        return self._starts[line - 1] + column


def blocks_of(node: ast.stmt) -> list[list[ast.stmt]]:
    """Return the blocks of a compound statement."""
    blocks = [getattr(node, name, []) for name in ("body", "orelse", "finalbody")]
    for child in (*getattr(node, "handlers", []), *getattr(node, "cases", [])):
        blocks.insert(1, child.body)
    return [block for block in blocks if block]


def _is_for_readers(node: ast.stmt) -> bool:
    """Return whether a statement is a docstring, or prints, logs or raises an error."""
    if isinstance(node, (ast.Raise, ast.Assert, ast.Import, ast.ImportFrom)):
        return True
    if not isinstance(node, ast.Expr):
        return False
    if isinstance(node.value, ast.Constant):
        return True
    return any(_OUTPUT.fullmatch(name) or name == "get_logger" for name in called_names(node.value))


def called_names(call: ast.expr) -> list[str]:
    """Return the names in a called function, the last name first, such as ``info`` and ``get_logger``."""
    function = call.func if isinstance(call, ast.Call) else None
    names: list[str] = []
    while function is not None:
        if isinstance(function, ast.Attribute):
            names.append(function.attr)
            function = function.value
        elif isinstance(function, ast.Call):
            function = function.func
        else:
            names += [function.id] if isinstance(function, ast.Name) else []
            break
    return names
