"""Find functions of Python scripts that nothing calls."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator

from linkwright.packages.readers.python_values import called_name

_STARTS = frozenset({"rospy.init_node", "rospy.spin", "rclpy.init", "rclpy.spin", "rclpy.create_node"})
"""The calls that make a node or run it."""


def find_uncalled_functions(tree: ast.Module) -> Iterator[ast.FunctionDef]:
    """Yield the functions of a script that the script does not use.

    A script starts a node at module level, so that no other source imports it.

    Args:
        tree: the syntax tree of the source.
    """
    if not any(called_name(call) in _STARTS for call in _list_started_calls(tree.body)):
        return
    functions = [node for node in tree.body if isinstance(node, ast.FunctionDef) and not node.decorator_list]
    own = {id(node): function.name for function in functions for node in ast.walk(function)}
    used = {
        name
        for node in ast.walk(tree)
        for name in _list_words(node)
        if own.get(id(node)) != name  # a recursive call
    }
    yield from (function for function in functions if function.name not in used)


def _list_started_calls(body: Iterable[ast.stmt]) -> Iterator[ast.Call]:
    """Yield the calls that run when a source is imported."""
    for statement in body:
        if isinstance(statement, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            continue
        if isinstance(statement, ast.If) and "__name__" in ast.unparse(statement.test):
            continue
        yield from (node for node in ast.walk(statement) if isinstance(node, ast.Call))


def _list_words(node: ast.AST) -> Iterator[str]:
    """Yield the words with which a node may name a function."""
    if isinstance(node, ast.Name):
        yield node.id
    elif isinstance(node, ast.Attribute):
        yield node.attr
    elif isinstance(node, ast.Constant) and isinstance(node.value, str):
        yield from node.value.split()
