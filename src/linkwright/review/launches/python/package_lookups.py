"""Find packages that a Python launch file looks up whenever it is loaded, whatever its arguments are."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

from linkwright.packages.readers.launch_files import LAUNCH_FUNCTION
from linkwright.packages.readers.python_values import called_name, parse_python
from linkwright.review.sources.names import PYTHON_SUFFIX
from linkwright.review.sources.reading import try_read_source

_LOOKUPS = ("get_package_share_directory", "get_package_share_path", "get_package_prefix")
"""The functions that fail where a package is not installed. Substitutions only fail when they are used."""
_CONDITIONAL = (ast.If, ast.IfExp, ast.Try, ast.While, ast.Lambda, ast.ClassDef, ast.BoolOp)


def looks_up_package(file: Path, package: str) -> bool:
    """Return whether a Python launch file certainly looks up a package when it is loaded."""
    source = try_read_source(file) if file.suffix == PYTHON_SUFFIX else None
    try:
        tree = None if source is None else parse_python(source.text)
    except (SyntaxError, ValueError):
        return False
    return tree is not None and package in _find_packages(tree)


def _find_packages(node: ast.AST) -> Iterator[str]:
    """Yield the packages of the calls that no condition and no other function contains."""
    if isinstance(node, _CONDITIONAL):
        return
    if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)) and node.name != LAUNCH_FUNCTION:
        return
    if isinstance(node, ast.Call) and called_name(node).rpartition(".")[2] in _LOOKUPS and node.args:
        argument = node.args[0]
        if isinstance(argument, ast.Constant) and isinstance(argument.value, str):
            yield argument.value
    for child in ast.iter_child_nodes(node):
        yield from _find_packages(child)
