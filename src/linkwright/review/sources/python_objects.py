"""Find Python calls of methods that an imported class does not have."""

from __future__ import annotations

import ast
from collections.abc import Callable, Collection, Iterator, Mapping
from typing import NamedTuple

from linkwright.review.sources.python_methods import find_defined_attributes
from linkwright.review.sources.signatures import is_self_contained
from linkwright.review.sources.undefined_names import find_bound_names

_DYNAMIC_NAMES = frozenset({"setattr", "__dict__", "__setattr__", "__getattribute__", "vars"})
"""The names with which a module can give objects further attributes."""


class ModuleClasses(NamedTuple):
    """The classes of a module that have only the methods which it defines.

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
        class_name: the name of the object's class.
        method: the name of the missing method.
        node: the method in the call.
    """

    path: str
    class_name: str
    method: str
    node: ast.Attribute


def read_classes(path: str, tree: ast.Module) -> ModuleClasses:
    """Return the classes of a module without base classes and decorators."""
    names = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
    names |= {node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute)}
    defined = frozenset(find_defined_attributes(tree))
    if not _DYNAMIC_NAMES.isdisjoint(names | defined):
        return ModuleClasses(path, {})
    classes = [node for node in tree.body if isinstance(node, ast.ClassDef) and is_self_contained(node)]
    count = [node.name for node in tree.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))].count
    return ModuleClasses(path, {node.name: defined for node in classes if count(node.name) == 1})


def find_failing_calls(
    tree: ast.Module, find_module: Callable[[str, int], ModuleClasses | None]
) -> Iterator[FailingCall]:
    """Yield the calls of methods that the objects of imported classes lack.

    Calls inside ``try`` are left out.

    Args:
        tree: the file with the calls.
        find_module: the function that returns a module from its name and the number of dots before it.
    """
    bound_names = list(find_bound_names(tree))
    classes: dict[str, tuple[str, str, frozenset[str]]] = {}
    for statement in tree.body:
        module_classes = (
            find_module(statement.module or "", statement.level) if isinstance(statement, ast.ImportFrom) else None
        )
        if module_classes is not None and isinstance(statement, ast.ImportFrom):
            classes.update(
                (alias.asname or alias.name, (module_classes.path, alias.name, module_classes.attributes[alias.name]))
                for alias in statement.names
                if alias.name in module_classes.attributes and bound_names.count(alias.asname or alias.name) == 1
            )
    objects = _find_objects(tree, classes.keys()) if classes else {}
    guarded_ids = {id(inner) for node in ast.walk(tree) if isinstance(node, ast.Try)
               for part in node.body for inner in ast.walk(part)}  # fmt: skip
    assigned_attributes = {node.attr for node in ast.walk(tree)
                     if isinstance(node, ast.Attribute) and not isinstance(node.ctx, ast.Load)}  # fmt: skip
    for node in ast.walk(tree) if objects else ():
        if not isinstance(node, ast.Call) or not isinstance(node.func, ast.Attribute) or id(node) in guarded_ids:
            continue
        class_name, method = objects.get(ast.unparse(node.func.value), ""), node.func.attr
        path, name, attributes = classes.get(class_name, ("", "", frozenset()))
        if path and not method.startswith("__") and method not in attributes and method not in assigned_attributes:
            yield FailingCall(path, name, method, node.func)


def _find_objects(tree: ast.Module, classes: Collection[str]) -> dict[str, str]:
    """Return the class of each variable that only gets objects of one class."""
    constructed_classes = {
        id(target): node.value.func.id
        for node in ast.walk(tree)
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Call) and isinstance(node.value.func, ast.Name)
        for target in node.targets
    }
    classes_by_target: dict[str, set[str]] = {}
    for node in ast.walk(tree):
        if isinstance(node, (ast.Name, ast.Attribute)) and not isinstance(node.ctx, ast.Load):
            classes_by_target.setdefault(ast.unparse(node), set()).add(constructed_classes.get(id(node), ""))
        elif isinstance(node, ast.arg):
            classes_by_target.setdefault(node.arg, set()).add("")
    pairs = ((target, names.pop()) for target, names in classes_by_target.items() if len(names) == 1)
    return {target: name for target, name in pairs if name in classes}
