"""Find Python calls of methods that an imported class does not have."""

from __future__ import annotations

import ast
from collections.abc import Callable, Collection, Iterator, Mapping
from typing import NamedTuple

from linkwright.review.sources.python_methods import defined_attributes
from linkwright.review.sources.signatures import is_plain
from linkwright.review.sources.undefined_names import bound_names

_DYNAMIC = frozenset({"setattr", "__dict__", "__setattr__", "__getattribute__", "vars"})
"""The names by which a module can give objects other attributes."""


class ModuleClasses(NamedTuple):
    """The classes of a module that certainly have no methods besides those that the module defines.

    Attributes:
        path: the path of the module.
        attributes: the names that objects of a class may have, by class.
    """

    path: str
    attributes: Mapping[str, frozenset[str]]


class FailingCall(NamedTuple):
    """A call of a method that an object does not have.

    Attributes:
        path: the path of the module that defines the class.
        class_name: the class.
        method: the method.
        node: the method in the call.
    """

    path: str
    class_name: str
    method: str
    node: ast.Attribute


def classes_of(path: str, tree: ast.Module) -> ModuleClasses:
    """Return the classes of a module without base classes and decorators."""
    names = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
    names |= {node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute)}
    defined = frozenset(defined_attributes(tree))
    if not _DYNAMIC.isdisjoint(names | defined):
        return ModuleClasses(path, {})
    classes = [node for node in tree.body if isinstance(node, ast.ClassDef) and is_plain(node)]
    count = [node.name for node in tree.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))].count
    return ModuleClasses(path, {node.name: defined for node in classes if count(node.name) == 1})


def failing_calls(tree: ast.Module, module: Callable[[str, int], ModuleClasses | None]) -> Iterator[FailingCall]:
    """Yield the calls of methods that the objects of imported classes do not have, except those below ``try``.

    Args:
        tree: the file with the calls.
        module: the function that returns a module of the repository from its name and the number of dots before it.
    """
    bound = list(bound_names(tree))
    classes: dict[str, tuple[str, str, frozenset[str]]] = {}
    for statement in tree.body:
        found = module(statement.module or "", statement.level) if isinstance(statement, ast.ImportFrom) else None
        if found is not None and isinstance(statement, ast.ImportFrom):
            classes.update(
                (alias.asname or alias.name, (found.path, alias.name, found.attributes[alias.name]))
                for alias in statement.names
                if alias.name in found.attributes and bound.count(alias.asname or alias.name) == 1
            )
    objects = _objects(tree, classes.keys()) if classes else {}
    guarded = {id(each) for node in ast.walk(tree) if isinstance(node, ast.Try)
               for part in node.body for each in ast.walk(part)}  # fmt: skip
    set_elsewhere = {node.attr for node in ast.walk(tree)
                     if isinstance(node, ast.Attribute) and not isinstance(node.ctx, ast.Load)}  # fmt: skip
    for node in ast.walk(tree) if objects else ():
        if not isinstance(node, ast.Call) or not isinstance(node.func, ast.Attribute) or id(node) in guarded:
            continue
        class_name, method = objects.get(ast.unparse(node.func.value), ""), node.func.attr
        path, name, attributes = classes.get(class_name, ("", "", frozenset()))
        if path and not method.startswith("__") and method not in attributes and method not in set_elsewhere:
            yield FailingCall(path, name, method, node.func)


def _objects(tree: ast.Module, classes: Collection[str]) -> dict[str, str]:
    """Return the classes of the variables and attributes that are only assigned objects of one class."""
    made = {
        id(target): node.value.func.id
        for node in ast.walk(tree)
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Call) and isinstance(node.value.func, ast.Name)
        for target in node.targets
    }
    assigned: dict[str, set[str]] = {}
    for node in ast.walk(tree):
        if isinstance(node, (ast.Name, ast.Attribute)) and not isinstance(node.ctx, ast.Load):
            assigned.setdefault(ast.unparse(node), set()).add(made.get(id(node), ""))
        elif isinstance(node, ast.arg):
            assigned.setdefault(node.arg, set()).add("")
    pairs = ((target, names.pop()) for target, names in assigned.items() if len(names) == 1)
    return {target: name for target, name in pairs if name in classes}
