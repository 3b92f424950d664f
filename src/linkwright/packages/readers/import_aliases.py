"""Replace the other names that a Python file gives to imported classes and functions by their own names."""

from __future__ import annotations

import ast
from collections.abc import Collection

_MODULES = frozenset(
    {
        "ament_index_python",
        "launch",
        "launch_ros",
        "launch_testing",
        "launch_testing_ros",
        "moveit_configs_utils",
        "os",
        "pathlib",
    }
)
"""The packages whose classes and functions the readers of Python files know by their names."""


def replace_import_aliases(tree: ast.Module) -> None:
    """Change ``from launch_ros.actions import Node as N`` and each ``N`` to ``Node`` in a syntax tree.

    Only names of modules that readers know are replaced. A name that the file also defines in another way stays, and
    so does one whose own name the file uses for something else. Locations do not change.
    """
    nodes = list(ast.walk(tree))
    aliases = [
        alias
        for node in nodes
        if isinstance(node, ast.ImportFrom) and not node.level and (node.module or "").partition(".")[0] in _MODULES
        for alias in node.names
        if alias.asname is not None
    ]
    if not aliases:
        return
    bound = _find_bound_names(nodes, [id(alias) for alias in aliases])
    replaced = {alias.asname: alias for alias in aliases if alias.asname not in bound and alias.name not in bound}
    for alias in replaced.values():
        alias.asname = None
    names = {name: alias.name for name, alias in replaced.items()}
    for node in nodes:
        if isinstance(node, ast.Name):
            node.id = names.get(node.id, node.id)


def _find_bound_names(nodes: Collection[ast.AST], ignored: Collection[int]) -> set[str]:
    """Return the names that statements define, without those of some imports.

    An import of the same class under its own name does not count.
    """
    bound: set[str] = set()
    for node in nodes:
        if isinstance(node, ast.ImportFrom) and (node.module or "").partition(".")[0] in _MODULES:
            continue
        if isinstance(node, (ast.Import, ast.ImportFrom)):
            bound |= {alias.asname or alias.name for alias in node.names if id(alias) not in ignored}
        elif isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Load):
            bound.add(node.id)
        elif isinstance(node, ast.arg):
            bound.add(node.arg)
        elif isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            bound.add(node.name)
    return bound
