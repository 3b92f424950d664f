"""Find the items that a function of a Python launch file adds to a list after it made the list."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from linkwright.packages.readers.python_values import PythonFile, called_name
from linkwright.review.launches.python.expression_texts import BoundExpression, ExpressionTexts, format_branches

_CONSTANTS = {"True": True, "False": False}
_Condition = tuple[ast.If, bool]
"""An ``if`` statement, and whether its test holds in the branch."""


class AddedItem(NamedTuple):
    """An item that a statement adds to a list.

    Attributes:
        text: the text of the item, with the conditions under which it is added if they are unknown.
        call: the call that adds it.
        branches: the ``if`` statements whose conditions the text shows.
    """

    text: str
    call: ast.Call
    branches: Sequence[ast.If] = ()


def find_added_items(python: PythonFile, name: ast.Name, texts: ExpressionTexts) -> list[AddedItem]:
    """Return the items added to a list before a use of its name, without those that are certainly not added.

    Args:
        python: the parsed file.
        name: the use of the name.
        texts: the texts of the expressions of the function.
    """
    return _find_items(python, name.id, range(python.resolved(name).lineno + 1, name.lineno), texts)


def find_later_items(added_to: BoundExpression) -> list[AddedItem]:
    """Return the items added to a list that a name has, such as one that a function gets as an argument."""
    python = added_to.texts.python
    for node in ast.walk(python.tree):
        if isinstance(node, ast.Assign) and node.value is added_to.node and isinstance(node.targets[0], ast.Name):
            lines = range(node.lineno + 1, sys.maxsize)
            return _find_items(python, node.targets[0].id, lines, added_to.texts, start=node.lineno)
    return []


def _find_items(
    python: PythonFile, name: str, lines: range, texts: ExpressionTexts, *, start: int | None = None
) -> list[AddedItem]:
    """Return the items that statements in a range of lines of a function add to a list.

    Args:
        python: the parsed file.
        name: the name of the list.
        lines: the lines.
        texts: the texts of the expressions of the function.
        start: a line of the function; None for the line after the others.
    """
    line = lines.stop if start is None else start
    functions = [
        node
        for node in ast.walk(python.tree)
        if isinstance(node, ast.FunctionDef) and node.lineno <= line <= (node.end_lineno or 0)
    ]
    body = max(functions, key=lambda node: node.lineno).body if functions else python.tree.body
    items: list[AddedItem] = []
    for node, call, conditions in _find_additions(body, name, ()):
        if node.lineno not in lines:
            continue
        known = [_CONSTANTS.get(texts.text(branch.test)) for branch, _ in conditions]
        if any(value is (not expected) for value, (_, expected) in zip(known, conditions, strict=True)):
            continue
        unknown = [condition for condition, value in zip(conditions, known, strict=True) if value is None]
        words = [format_branches(branch.test)[0 if is_true else 1] for branch, is_true in unknown]
        text = texts.format_joined(node)
        branches = [branch for branch, _ in unknown]
        items.append(AddedItem(f"{text} ({' and '.join(words)})" if words else text, call, branches))
    return items


def _find_additions(
    body: Sequence[ast.stmt], name: str, conditions: tuple[_Condition, ...]
) -> Iterator[tuple[ast.expr, ast.Call, tuple[_Condition, ...]]]:
    """Yield the items that statements add to a list, each with the call and the conditions around it."""
    for statement in body:
        if isinstance(statement, ast.If):
            yield from _find_additions(statement.body, name, (*conditions, (statement, True)))
            yield from _find_additions(statement.orelse, name, (*conditions, (statement, False)))
        call = statement.value if isinstance(statement, ast.Expr) else None
        if isinstance(call, ast.Call):
            for item in _get_added_items(call, name):
                yield item, call, conditions


def _get_added_items(call: ast.Call, name: str) -> Sequence[ast.expr]:
    """Return the items that a call of ``append`` or ``extend`` adds to a list."""
    if len(call.args) != 1:
        return []
    if called_name(call) == f"{name}.append":
        return call.args
    items = call.args[0]
    is_extended = called_name(call) == f"{name}.extend"
    return items.elts if is_extended and isinstance(items, (ast.List, ast.Tuple)) else []
