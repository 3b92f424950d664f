"""Find the arguments of the command line that Python programs newly read without a check."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

from linkwright.diagnostics import Phrase, Span, phrase
from linkwright.packages.readers.python_values import PythonFile, called_name

_ARGUMENTS = "sys.argv"
_NAME = "__name__"
_MAIN = "main"
_INIT = "rclpy.init"
"""The function that takes the arguments of ROS, whatever their number."""


class ReadArgument(NamedTuple):
    """An argument that a program reads when it starts.

    Attributes:
        sentence: the argument with the statement that reads it.
        reason: why it is breaking.
        span: the location of the statement.
    """

    sentence: Phrase
    reason: Phrase
    span: Span


def find_read_arguments(old: PythonFile, new: PythonFile) -> Iterator[ReadArgument]:
    """Yield the argument of the command line that a program newly reads by its index, and without which it fails.

    Programs that use ``sys.argv`` in another way may test the number of the arguments.

    Args:
        old: the old source.
        new: the new source.
    """
    before, after = _read_indexes(old.tree), _read_indexes(new.tree)
    if before is None or not after:
        return
    index = max(after)
    if index > max(before, default=0):
        code = ast.unparse(after[index])
        yield ReadArgument(
            phrase("reads argument {index} of the command line now: `{code}`", index=index, code=code),
            phrase("callers that pass fewer arguments get an error"),
            new.span(after[index]),
        )


def _read_indexes(tree: ast.Module) -> Mapping[int, ast.stmt] | None:
    """Return the indexes that are read, each with its first statement; None if other code uses the arguments.

    Statements count if they run in any case: at module level, or in ``main``.
    """
    nodes = list(ast.walk(tree))
    calls = [node for node in nodes if isinstance(node, ast.Call) and called_name(node) == _INIT]
    passed = {id(part) for call in calls for part in ast.walk(call)}
    uses = [
        node
        for node in nodes
        if isinstance(node, ast.Attribute) and ast.unparse(node) == _ARGUMENTS and id(node) not in passed
    ]
    indexes: dict[int, ast.stmt] = {}
    reads = 0
    for statement in _list_unconditional(tree.body):
        for node in ast.walk(statement):
            if isinstance(node, ast.IfExp):
                return None  # it may test the number of the arguments
            if isinstance(node, ast.Subscript) and ast.unparse(node.value) == _ARGUMENTS:
                value = node.slice.value if isinstance(node.slice, ast.Constant) else None
                if isinstance(value, int):
                    reads += 1
                    indexes.setdefault(value, statement)
    return indexes if len(uses) == reads else None


def _list_unconditional(body: Iterable[ast.stmt]) -> Iterator[ast.stmt]:
    """Yield the simple statements of a program that run in any case."""
    for statement in body:
        if (isinstance(statement, ast.If) and _NAME in ast.unparse(statement.test)) or (
            isinstance(statement, ast.FunctionDef) and statement.name == _MAIN
        ):
            yield from _list_unconditional(statement.body)
        elif isinstance(statement, (ast.Assign, ast.AnnAssign, ast.Expr)):
            yield statement
