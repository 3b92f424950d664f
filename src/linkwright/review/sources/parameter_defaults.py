"""Find the default names of topics and services that Python sources read from parameters."""

from __future__ import annotations

import ast

from linkwright.packages.readers.python_values import PythonFile, argument_of, called_name

_READERS = ("get_parameter", "declare_parameter", "get_parameter_or", "get_param")
_MAX_DEPTH = 10


def find_parameter_default(python: PythonFile, node: ast.expr) -> str:
    """Return the default of the parameter that an expression reads, such as ``self.topic``; empty for others.

    Args:
        python: the parsed file.
        node: the syntax tree of the expression.
    """
    for _ in range(_MAX_DEPTH):
        value = python.resolved(node)
        if isinstance(value, ast.Call) and called_name(value).rpartition(".")[2] in _READERS:
            return _find_default(python, value)
        if isinstance(value, ast.Attribute) and isinstance(value.value, ast.Name):
            assigned = _find_assigned_value(python, value)
            if assigned is None:
                return ""
            node = assigned
        elif isinstance(value, ast.Attribute):
            node = value.value
        elif isinstance(value, ast.Call) and isinstance(value.func, ast.Attribute) and not value.args:
            node = value.func.value
        else:
            return ""
    return ""


def _find_default(python: PythonFile, call: ast.Call) -> str:
    """Return the default in a call that reads or declares a parameter, or in the only declaration of its name."""
    given = call.args[1] if len(call.args) > 1 else argument_of(call, "default")
    if given is None:
        given = argument_of(call, "value")
    if given is not None:
        return python.text(given) or ""
    name = python.text(call.args[0]) if call.args else None
    declarations = [
        declared
        for declared in python.calls("declare_parameter")
        if name is not None and declared.args and python.text(declared.args[0]) == name and declared is not call
    ]
    return _find_default(python, declarations[0]) if len(declarations) == 1 else ""


def _find_assigned_value(python: PythonFile, attribute: ast.Attribute) -> ast.expr | None:
    """Return the only expression that is assigned to an attribute such as ``self.topic``, or None."""
    text = ast.unparse(attribute)
    values = [
        node.value
        for node in ast.walk(python.tree)
        if isinstance(node, ast.Assign) and any(ast.unparse(target) == text for target in node.targets)
    ]
    return values[0] if len(values) == 1 else None
