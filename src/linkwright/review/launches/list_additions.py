"""Find the items that a function of a Python launch file adds to a list after it made the list."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

from linkwright.packages.readers.python_values import PythonFile, called_name
from linkwright.review.launches.text import ExpressionTexts

_CONSTANTS = {"True": True, "False": False}
_Condition = tuple[ast.expr, bool]
"""The test of an ``if`` statement, and whether it holds in the branch."""


def find_added_items(python: PythonFile, name: ast.Name, texts: ExpressionTexts) -> list[str]:
    """Return the texts of the items added to a list before a use of its name.

    Items that are added under unknown conditions are left out.

    Args:
        python: the parsed file.
        name: the use of the name.
        texts: the texts of the expressions of the function.
    """
    value = python.resolved(name)
    functions = [
        node
        for node in ast.walk(python.tree)
        if isinstance(node, ast.FunctionDef) and node.lineno <= name.lineno <= (node.end_lineno or 0)
    ]
    body = max(functions, key=lambda node: node.lineno).body if functions else python.tree.body
    items = []
    for node, conditions in _find_additions(body, name.id, ()):
        if value.lineno < node.lineno < name.lineno:
            known = [_CONSTANTS.get(texts.text(test)) for test, _ in conditions]
            expected = [is_true for _, is_true in conditions]
            if known == expected:
                items.append(texts.format_joined(node))
    return items


def _find_additions(
    body: Sequence[ast.stmt], name: str, conditions: tuple[_Condition, ...]
) -> Iterator[tuple[ast.expr, tuple[_Condition, ...]]]:
    """Yield the items that statements add to a list, each with the conditions around it."""
    for statement in body:
        if isinstance(statement, ast.If):
            yield from _find_additions(statement.body, name, (*conditions, (statement.test, True)))
            yield from _find_additions(statement.orelse, name, (*conditions, (statement.test, False)))
        for item in _get_added_items(statement, name):
            yield item, conditions


def _get_added_items(statement: ast.stmt, name: str) -> Sequence[ast.expr]:
    """Return the items that a statement adds to a list by ``append`` or ``extend``."""
    call = statement.value if isinstance(statement, ast.Expr) else None
    if not isinstance(call, ast.Call) or len(call.args) != 1:
        return []
    if called_name(call) == f"{name}.append":
        return call.args
    items = call.args[0]
    is_extended = called_name(call) == f"{name}.extend"
    return items.elts if is_extended and isinstance(items, (ast.List, ast.Tuple)) else []
