"""Find the functions of a Python source that its callbacks name, with their classes."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

_OBJECT_NAMES = frozenset({"self", "cls"})


class CallbackFunctions:
    """The functions and methods of a Python source.

    Args:
        tree: the parsed source.
    """

    def __init__(self, tree: ast.Module) -> None:
        self._classes = dict(_list_classes(tree.body, ""))
        self._methods = {
            name: {part.name for part in definition.body if isinstance(part, (ast.FunctionDef, ast.AsyncFunctionDef))}
            for name, definition in self._classes.items()
        }

    def find(self, callback: ast.expr) -> list[str]:
        """Return the qualified names of the functions that an expression may name.

        A method of an object whose class is unknown is found if only one class of the source has it.
        """
        if isinstance(callback, ast.Name):
            return [callback.id]
        if not isinstance(callback, ast.Attribute):
            return []
        owner = callback.value.id if isinstance(callback.value, ast.Name) else ""
        class_name = self._find_class(callback.lineno) if owner in _OBJECT_NAMES else owner
        if class_name in self._classes:
            related = [class_name, *self._list_related(class_name)]
            return [f"{name}.{callback.attr}" for name in related if callback.attr in self._methods[name]]
        owners = [name for name, methods in self._methods.items() if callback.attr in methods]
        return [f"{owners[0]}.{callback.attr}"] if len(owners) == 1 else []

    def qualify(self, function: ast.FunctionDef | ast.AsyncFunctionDef) -> str:
        """Return the name of a function, qualified by its class."""
        class_name = self._find_class(function.lineno)
        return f"{class_name}.{function.name}" if class_name else function.name

    def _find_class(self, line: int) -> str:
        """Return the innermost class around a line; empty if there is none."""
        around = [
            name
            for name, definition in self._classes.items()
            if definition.lineno <= line <= (definition.end_lineno or line)
        ]
        return around[-1] if around else ""

    def _list_related(self, class_name: str) -> list[str]:
        """Return the base classes and the derived classes of a class."""
        bases = {
            name: {base.id for base in definition.bases if isinstance(base, ast.Name)} & self._classes.keys()
            for name, definition in self._classes.items()
        }
        derived = {name: {other for other in bases if name in bases[other]} for name in bases}
        found: list[str] = []
        for edges in (bases, derived):
            pending = [class_name]
            while pending:
                new = [other for other in edges[pending.pop()] if other not in found and other != class_name]
                found += new
                pending += new
        return sorted(found)


def _list_classes(body: Sequence[ast.stmt], scope: str) -> Iterator[tuple[str, ast.ClassDef]]:
    """Yield the classes with their qualified names, outer classes first."""
    for node in body:
        if isinstance(node, ast.ClassDef):
            name = f"{scope}.{node.name}".lstrip(".")
            yield name, node
            yield from _list_classes(node.body, name)
