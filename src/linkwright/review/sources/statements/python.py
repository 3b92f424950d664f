"""Read the statements of a Python source by function."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Mapping, Sequence

from linkwright.diagnostics import SourceText
from linkwright.review.caching import cached_in_review
from linkwright.review.sources.python_names import parse_source
from linkwright.review.sources.statements.literals import Statement, parse_statement
from linkwright.review.sources.statements.tokens import tokenize_python

_OUTPUT = re.compile(
    r"(?:print|pprint|warn|log\w*|_?log(?:ger)?|debug|info|warning|error|critical|exception|fatal|echo|write|"
    r"set_description|input|exit|(?:local|ros)_?(?:debug|info|warn|warning|err|error|critical|fatal))",
    re.IGNORECASE,
)
"""The functions whose strings are for human readers."""


@cached_in_review(maxsize=8)
def read_python_statements(text: str) -> Mapping[str, Sequence[Statement]]:
    """Return the statements of a source by function or class.

    Statements of the module have an empty name. The result is kept, because several comparisons in a row read the same
    two sources.

    Raises:
        SyntaxError: the text is neither Python 3 nor Python 2.
    """
    python = parse_source(SourceText("", text))
    functions: dict[str, list[Statement]] = {}
    text = python.source.text
    line_starts = [0]
    for line in text.splitlines(keepends=True):
        line_starts.append(line_starts[-1] + len(line))
    reader = _Reader(text, line_starts)
    for name, start, end in reader.read_parts(python.tree.body, ""):
        tokens = tokenize_python(text, start, end)
        if tokens:
            functions.setdefault(name, []).append(parse_statement(tokens))
    return functions


class _Reader:
    def __init__(self, text: str, line_starts: Sequence[int]) -> None:
        self._lines = text.splitlines()
        self._line_starts = line_starts

    def read_parts(self, body: Sequence[ast.stmt], scope: str) -> Iterator[tuple[str, int, int]]:
        """Yield the scope, start and end of each statement without nested statements."""
        for node in body:
            if _is_for_readers(node):
                continue
            blocks = get_blocks(node)
            if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
                inner_scope = f"{scope}.{node.name}" if scope else node.name
                decorators = (
                    self._to_offset(decorator.end_lineno or 0, decorator.end_col_offset or 0)
                    for decorator in node.decorator_list
                )
                start = max([self._to_offset(node.lineno, node.col_offset), *decorators])
                yield inner_scope, start, self._find_start(blocks[0][0])
                yield from self.read_parts(node.body, inner_scope)
                continue
            start = self._to_offset(node.lineno, node.col_offset)
            if not blocks:
                yield scope, start, self._to_offset(node.end_lineno or node.lineno, node.end_col_offset or 0)
                continue
            yield scope, start, self._find_start(blocks[0][0])
            for block in blocks:
                yield from self.read_parts(block, scope)

    def _find_start(self, node: ast.stmt) -> int:
        """Return the offset of the first decorator of a statement, or of the statement itself."""
        positions = [(node.lineno, node.col_offset)]
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            positions += [(decorator.lineno, decorator.col_offset - 1) for decorator in node.decorator_list]
        return self._to_offset(*min(positions))

    def _to_offset(self, line: int, column: int) -> int:
        """Return the offset in characters of a line and a column, which counts bytes in UTF-8."""
        content = self._lines[line - 1]
        if not content.isascii():
            column = len(content.encode()[: max(column, 0)].decode(errors="ignore"))
        return self._line_starts[line - 1] + column


def get_blocks(node: ast.stmt) -> list[list[ast.stmt]]:
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
    return any(_OUTPUT.fullmatch(name) or name == "get_logger" for name in list_called_names(node.value))


def list_called_names(call: ast.expr) -> list[str]:
    """Return the names in a called function, the last name first.

    They are ``info`` and ``get_logger`` for a call of a logger.
    """
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
