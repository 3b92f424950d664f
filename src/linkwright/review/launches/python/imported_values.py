"""Put the values that a Python launch file imports from modules of the repository into its syntax tree."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from copy import deepcopy

from linkwright.packages.readers.python_values import PythonFile, called_name
from linkwright.review.launches.python.helpers import HelperFunctions
from linkwright.review.launches.python.names import LaunchPythonFile

_MAX_DEPTH = 5
"""The maximum number of names and modules through which a value is followed."""
_LISTS_OF_ACTIONS = frozenset({"LaunchDescription", "GroupAction", "add_action", "add_entity"})
"""The calls whose first argument is an action or a list of actions."""


def assign_imported_values(python: LaunchPythonFile, helpers: HelperFunctions) -> LaunchPythonFile:
    """Return a launch file in which names imported from modules of the repository are assigned.

    The assignments have the location of the import. Only values with calls, such as actions and substitutions, are
    assigned.
    """
    assignments = [
        _make_assignment(name, value, node)
        for node in python.tree.body
        if isinstance(node, ast.ImportFrom)
        for name, value in _find_values(python, node, helpers)
    ]
    if not assignments:
        return python
    result = LaunchPythonFile(python.source)
    imports = {(node.lineno, node.col_offset): node for node in assignments}
    position = 1 + max(
        number for number, node in enumerate(result.tree.body) if (node.lineno, node.col_offset) in imports
    )
    result.tree.body[position:position] = assignments
    return result


def uses_unknown_actions(python: LaunchPythonFile, helpers: HelperFunctions) -> bool:
    """Return whether a launch file has imported actions whose values are unknown.

    Args:
        python: the launch file with its imported values.
        helpers: the modules of the repository.
    """
    calls = (node for node in ast.walk(python.tree) if isinstance(node, ast.Call))
    lists = (call.args[0] for call in calls if call.args and called_name(call).split(".")[-1] in _LISTS_OF_ACTIONS)
    return any(_is_unknown(python, item, helpers) for item in lists)


def _is_unknown(
    python: LaunchPythonFile, node: ast.expr, helpers: HelperFunctions, *, is_imported: bool = False
) -> bool:
    """Return whether an action or an item of a list of actions is imported and has no known value."""
    node = node.value if isinstance(node, ast.Starred) else node
    if isinstance(node, ast.Name):
        is_imported = is_imported or helpers.is_imported(python, node.id)
        value = python.resolved(node)
        return is_imported if value is node else _is_unknown(python, value, helpers, is_imported=is_imported)
    if isinstance(node, (ast.List, ast.Tuple)):
        return any(_is_unknown(python, item, helpers, is_imported=is_imported) for item in node.elts)
    makes_action = isinstance(node, ast.Call) and called_name(node).rpartition(".")[2][:1].isupper()
    return is_imported and not makes_action


def _find_values(python: PythonFile, node: ast.ImportFrom, helpers: HelperFunctions) -> Iterator[tuple[str, ast.expr]]:
    for alias in node.names:
        name = alias.asname or alias.name
        value = helpers.find_imported_value(python, name)
        if value is None:
            continue
        expression = _Inliner(value[0], helpers).visit(deepcopy(value[1]))
        if any(isinstance(child, ast.Call) for child in ast.walk(expression)):
            yield name, expression


def inline_values(
    node: ast.expr, python: PythonFile, helpers: HelperFunctions, values: Mapping[str, ast.expr]
) -> ast.expr:
    """Return a copy of an expression with values in place of names.

    Args:
        node: the expression.
        python: the module that contains it.
        helpers: the modules of the repository.
        values: the values of local names.
    """
    result: ast.expr = _Inliner(python, helpers, values=values).visit(deepcopy(node))
    return result


def _make_assignment(name: str, value: ast.expr, node: ast.ImportFrom) -> ast.Assign:
    """Return an assignment in the place of an import."""
    assignment = ast.Assign([ast.Name(name, ast.Store())], value)
    for child in ast.walk(assignment):
        if isinstance(child, (ast.expr, ast.stmt, ast.keyword)):
            ast.copy_location(child, node)
    return assignment


class _Inliner(ast.NodeTransformer):
    """A transformer that puts the values of the names of a module in their places.

    Args:
        python: the module.
        helpers: the modules of the repository.
        depth: the number of names that led to the module.
        values: the values of local names.
    """

    def __init__(
        self,
        python: PythonFile,
        helpers: HelperFunctions,
        depth: int = 0,
        values: Mapping[str, ast.expr] | None = None,
    ) -> None:
        self._python = python
        self._helpers = helpers
        self._depth = depth
        self._values = values or {}

    def visit_Name(self, node: ast.Name) -> ast.expr:
        """Return the value of a name, or the name if its value is unknown."""
        if self._depth >= _MAX_DEPTH or not isinstance(node.ctx, ast.Load):
            return node
        if node.id in self._values:
            return deepcopy(self._values[node.id])
        value = self._python.assigned_expression(node.id)
        definition = (self._python, value) if value is not None else None
        definition = definition or self._helpers.find_imported_value(self._python, node.id)
        if definition is None:
            return node
        file, expression = definition
        result: ast.expr = _Inliner(file, self._helpers, self._depth + 1).visit(deepcopy(expression))
        return result
