"""Find methods and functions in Python that square brackets follow, where a call has parentheses."""

from __future__ import annotations

import ast
import builtins
from collections.abc import Iterator
from types import BuiltinFunctionType

_COLLECTIONS = (list, set, dict, bytearray)
_METHODS = frozenset(name for kind in _COLLECTIONS for name in dir(kind) if not name.startswith("_"))
"""The methods of collections."""
_FUNCTIONS = frozenset(name for name, value in vars(builtins).items() if isinstance(value, BuiltinFunctionType))
_CLASSES = frozenset({"bool", "bytes", "complex", "float", "int", "range", "str", "super"})
"""The classes that no annotation has with square brackets."""


def find_subscripted_methods(tree: ast.Module) -> Iterator[ast.Subscript]:
    """Yield the expressions with square brackets after a built-in function, or after a method of a collection.

    A method counts if it is the whole statement: the value of an attribute with this name would have no use there.

    Args:
        tree: the syntax tree of a source.
    """
    nodes = list(ast.walk(tree))
    bound = {node.id for node in nodes if isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Load)}
    bound |= {node.arg for node in nodes if isinstance(node, ast.arg)}
    bound |= {node.name for node in nodes if isinstance(node, (ast.FunctionDef, ast.ClassDef))}
    bound |= {alias.asname or alias.name for node in nodes if isinstance(node, ast.ImportFrom) for alias in node.names}
    statements = {id(node.value) for node in nodes if isinstance(node, ast.Expr)}
    for node in nodes:
        if not isinstance(node, ast.Subscript):
            continue
        function = node.value
        if isinstance(function, ast.Name):
            is_method = function.id in (_FUNCTIONS | _CLASSES) - bound
        else:
            is_method = isinstance(function, ast.Attribute) and function.attr in _METHODS and id(node) in statements
        if is_method:
            yield node
