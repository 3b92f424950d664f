"""Find the tests under which a Python launch file ends the launch with an error."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

from linkwright.packages.readers.python_values import PythonFile, called_name
from linkwright.review.launches.outlines import FailingTest

_EXIT_FUNCTIONS = ("sys.exit", "exit", "quit", "os._exit")
"""The calls that end the process."""
_FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)


def find_failing_tests(python: PythonFile) -> dict[int, tuple[FailingTest, ...]]:
    """Return the tests of the ``if`` statements around each failing statement, by the identity of the statement."""
    return dict(_find_tests(python, python.tree, ()))


def _find_tests(
    python: PythonFile, node: ast.AST, tests: tuple[FailingTest, ...]
) -> Iterator[tuple[int, tuple[FailingTest, ...]]]:
    if isinstance(node, ast.If):
        inner = (*tests, _read_test(python, node.test))
        for statement in node.body:
            if _ends_launch(statement):
                yield id(statement), inner
        yield from _find_tests_in_body(python, node.body, inner)
        negated = ast.UnaryOp(ast.Not(), node.test)
        yield from _find_tests_in_body(python, node.orelse, (*tests, FailingTest(_unparse(negated))))
    else:
        children = [child for child in ast.iter_child_nodes(node) if not isinstance(child, ast.expr)]
        yield from _find_tests_in_body(python, children, () if isinstance(node, _FUNCTIONS) else tests)


def _find_tests_in_body(
    python: PythonFile, body: Sequence[ast.AST], tests: tuple[FailingTest, ...]
) -> Iterator[tuple[int, tuple[FailingTest, ...]]]:
    for child in body:
        yield from _find_tests(python, child, tests)


def _ends_launch(statement: ast.stmt) -> bool:
    """Return whether a statement raises an exception or ends the process."""
    if isinstance(statement, ast.Raise):
        return True
    value = statement.value if isinstance(statement, ast.Expr) else None
    return isinstance(value, ast.Call) and called_name(value) in _EXIT_FUNCTIONS


def _read_test(python: PythonFile, test: ast.expr) -> FailingTest:
    """Return a test with the values that it accepts, such as of ``kind not in ("a", "b")``."""
    subject, accepted = "", frozenset[str]()
    if isinstance(test, ast.Compare) and len(test.ops) == 1:
        values = _find_accepted_values(python, test.ops[0], test.comparators[0])
        if values:
            subject, accepted = _unparse(test.left), frozenset(map(ast.dump, values))
    names = [node for node in ast.walk(test) if isinstance(node, ast.Name)]
    calls = (call for name in names for call in ast.walk(python.resolved(name)) if isinstance(call, ast.Call))
    arguments = {
        call.args[0].value
        for call in calls
        if called_name(call).rpartition(".")[2] == "LaunchConfiguration"
        and call.args
        and isinstance(call.args[0], ast.Constant)
    }
    return FailingTest(_unparse(test), subject, accepted, frozenset(map(str, arguments)))


def _find_accepted_values(python: PythonFile, operator: ast.cmpop, node: ast.expr) -> list[ast.expr]:
    """Return the only values for which a test does not hold; empty if they are unknown."""
    values = python.resolved(node)
    if isinstance(operator, ast.NotEq):
        return [values] if isinstance(values, ast.Constant) else []
    items: Sequence[ast.expr | None] = []
    if isinstance(operator, ast.NotIn) and isinstance(values, (ast.Tuple, ast.List, ast.Set)):
        items = values.elts
    elif isinstance(operator, ast.NotIn) and isinstance(values, ast.Dict):
        items = values.keys
    constants: list[ast.expr] = [item for item in items if isinstance(item, ast.Constant)]
    return constants if len(constants) == len(items) else []


def _unparse(node: ast.AST) -> str:
    return " ".join(ast.unparse(node).split())
