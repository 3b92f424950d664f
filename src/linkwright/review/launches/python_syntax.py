"""Find parts of the syntax tree of a Python launch file."""

from __future__ import annotations

import ast

from linkwright.packages.readers.python_values import called_name

ADD_METHODS = ("add_action", "add_entity")
"""The methods that add an action to a launch description."""
_VALUE_KEYWORDS = {"SetRemap": ("src", "dst")}
_DEFAULT_VALUE_KEYWORDS = ("name", "value")
"""The names of the arguments of the classes that set a value; the first item of each is what is set."""


def find_unused_values(tree: ast.AST) -> frozenset[int]:
    """Return the identities of the values of unused names."""
    nodes = list(ast.walk(tree))
    used = {node.id for node in nodes if isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Store)}
    assignments = (node for node in nodes if isinstance(node, ast.Assign))
    return frozenset(
        id(node.value)
        for node in assignments
        if all(isinstance(target, ast.Name) and target.id not in used for target in node.targets)
    )


def find_name_and_value(call: ast.Call, function: str) -> tuple[ast.expr | None, ast.expr | None]:
    """Return the two arguments of a call that sets a value, which may be keywords in any order."""
    keywords = {keyword.arg: keyword.value for keyword in call.keywords}
    names = _VALUE_KEYWORDS.get(function, _DEFAULT_VALUE_KEYWORDS)
    first, second = (
        call.args[index] if len(call.args) > index else keywords.get(name) for index, name in enumerate(names)
    )
    return first, second


def find_added_action(statement: ast.stmt) -> ast.expr | None:
    """Return the action that a statement adds to a launch description, or None."""
    value = statement.value if isinstance(statement, ast.Expr) else None
    is_addition = isinstance(value, ast.Call) and called_name(value).rpartition(".")[2] in ADD_METHODS
    return value.args[0] if is_addition and isinstance(value, ast.Call) and value.args else None
