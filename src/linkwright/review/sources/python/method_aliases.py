"""Replace the local names of methods of a node by the methods."""

from __future__ import annotations

import ast
from collections import Counter

_PREFIXES = ("create_", "declare_parameter", "get_parameter")
"""The beginnings of the methods of a node that make its names and parameters."""


def replace_method_aliases(tree: ast.Module) -> None:
    """Change each ``declare("rate", 5)`` after ``declare = self.declare_parameter`` to a call of the method.

    A name that the function also defines in another way stays. Locations do not change.
    """
    for function in ast.walk(tree):
        if isinstance(function, (ast.FunctionDef, ast.AsyncFunctionDef)):
            _replace_aliases(function)


def _replace_aliases(function: ast.FunctionDef | ast.AsyncFunctionDef) -> None:
    nodes = list(ast.walk(function))
    methods = {
        node.targets[0].id: node.value
        for node in nodes
        if isinstance(node, ast.Assign)
        and isinstance(node.targets[0], ast.Name)
        and isinstance(node.value, ast.Attribute)
        and isinstance(node.value.value, ast.Name)
        and node.value.attr.startswith(_PREFIXES)
    }
    if not methods:
        return
    bound = Counter(node.id for node in nodes if isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Load))
    bound.update(node.arg for node in nodes if isinstance(node, ast.arg))
    for node in nodes:
        if not isinstance(node, ast.Call) or not isinstance(node.func, ast.Name) or bound[node.func.id] != 1:
            continue
        method = methods.get(node.func.id)
        if method is not None:
            node.func = ast.copy_location(ast.Attribute(method.value, method.attr, ast.Load()), node.func)
