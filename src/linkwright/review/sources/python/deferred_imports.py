"""Find modules that a Python source newly imports in its functions, or newly with the source itself."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

from linkwright.diagnostics import Phrase, Span, phrase, quoted_names
from linkwright.packages.readers.python_values import PythonFile, called_name

_IMPORT_FUNCTIONS = ("import_module", "importlib.import_module", "__import__")
_Imports = dict[str, "ast.expr | ast.stmt"]


def find_deferred_imports(old: PythonFile, new: PythonFile) -> Iterator[tuple[Phrase, Span]]:
    """Yield the sentences about the modules that move between the beginning of a source and its functions.

    A source that imports a module only in functions can be loaded without the module.

    Args:
        old: the old source.
        new: the new source.
    """
    (old_first, old_later), (new_first, new_later) = (_read_imports(python) for python in (old, new))
    deferred = [name for name in old_first if name in new_later and name not in new_first]
    moved = [name for name in old_later if name in new_first and name not in old_first]
    if deferred:
        functions = quoted_names(_find_functions(new, deferred))
        text = phrase("imported only in {functions} now: {names}", functions=functions, names=quoted_names(deferred))
        yield text, new.span(new_later[deferred[0]])
    if moved:
        yield phrase("imported with the module now: {names}", names=quoted_names(moved)), new.span(new_first[moved[0]])


def _read_imports(python: PythonFile) -> tuple[_Imports, _Imports]:
    """Return the modules that a source imports when it is loaded, and those that its functions import."""
    first: _Imports = {}
    later: _Imports = {}

    def read(node: ast.AST, found: _Imports) -> None:
        for child in ast.iter_child_nodes(node):
            if isinstance(child, (ast.expr, ast.stmt)):
                found.update({name: child for name in _list_modules(child) if name not in found})
            is_function = isinstance(child, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda))
            read(child, later if is_function else found)

    read(python.tree, first)
    return first, later


def _list_modules(node: ast.AST) -> list[str]:
    """Return the modules that a statement or a call imports."""
    if isinstance(node, ast.Import):
        return [alias.name for alias in node.names]
    if isinstance(node, ast.ImportFrom):
        return [node.module] if node.module and node.level == 0 else []
    if isinstance(node, ast.Call) and called_name(node) in _IMPORT_FUNCTIONS and node.args:
        value = node.args[0]
        return [value.value] if isinstance(value, ast.Constant) and isinstance(value.value, str) else []
    return []


def _find_functions(python: PythonFile, modules: Sequence[str]) -> list[str]:
    """Return the names of the functions that import modules."""
    functions = (node for node in ast.walk(python.tree) if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)))
    return [
        f"{function.name}()"
        for function in functions
        if any(name in modules for part in ast.walk(function) for name in _list_modules(part))
    ]
