"""Find Python uses of attributes and methods that an imported class does not have."""

from __future__ import annotations

import ast
from collections.abc import Callable, Collection, Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

from linkwright.review.sources.python.methods import find_known_attributes
from linkwright.review.sources.python.undefined_names import find_bound_names

_CLASS_NAMES = frozenset(dir(type))
"""The names that all classes have."""


class KnownClass(NamedTuple):
    """A class that has only attributes which the repository or a known package defines.

    Attributes:
        path: the path of the module.
        name: the name of the class in the module.
        attributes: the names that objects of the class may have.
    """

    path: str
    name: str
    attributes: frozenset[str]


class FailingUse(NamedTuple):
    """A use of an attribute that a class or object does not have.

    Attributes:
        path: the path of the module that defines the class.
        class_name: the name of the class.
        attribute: the name of the missing attribute.
        is_call: whether it is called.
        node: the attribute in the source.
    """

    path: str
    class_name: str
    attribute: str
    is_call: bool
    node: ast.Attribute


def read_classes(path: str, file: Path, tree: ast.Module) -> dict[str, KnownClass]:
    """Return the classes of a module whose attributes are certain, by name.

    Args:
        path: the path of the module relative to the root.
        file: the file.
        tree: its syntax tree.
    """
    count = [node.name for node in tree.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))].count
    classes = (node for node in tree.body if isinstance(node, ast.ClassDef) and count(node.name) == 1)
    found = {node.name: find_known_attributes(file, tree, node) for node in classes}
    return {
        name: KnownClass(path, name, attributes | _CLASS_NAMES)
        for name, attributes in found.items()
        if attributes is not None
    }


def find_failing_uses(
    tree: ast.Module, find_classes: Callable[[str, int], Mapping[str, KnownClass]]
) -> Iterator[FailingUse]:
    """Yield the uses of attributes that imported classes and their objects lack.

    Uses inside ``try`` are left out.

    Args:
        tree: the file with the uses.
        find_classes: the function that returns the classes of a module from its name and the number of dots before it.
    """
    bound_names = list(find_bound_names(tree))
    classes: dict[str, KnownClass] = {}
    for statement in tree.body:
        if isinstance(statement, ast.ImportFrom):
            found = find_classes(statement.module or "", statement.level)
            locals_by_name = {alias.asname or alias.name: alias.name for alias in statement.names}
            classes.update({local: found[name] for local, name in locals_by_name.items() if name in found})
    classes = {local: known for local, known in classes.items() if bound_names.count(local) == 1}
    if not classes:
        return
    objects = {**{local: local for local in classes}, **_find_objects(tree, classes.keys())}
    nodes = list(ast.walk(tree))
    guarded_ids = {id(inner) for node in nodes if isinstance(node, ast.Try)
               for part in node.body for inner in ast.walk(part)}  # fmt: skip
    called_ids = {id(node.func) for node in nodes if isinstance(node, ast.Call)}
    attributes = [node for node in nodes if isinstance(node, ast.Attribute)]
    assigned_attributes = {node.attr for node in attributes if not isinstance(node.ctx, ast.Load)}
    for node in attributes:
        known = classes.get(objects.get(ast.unparse(node.value), ""))
        is_known = known is None or node.attr.startswith("_") or node.attr in known.attributes | assigned_attributes
        if known is not None and not is_known and id(node) not in guarded_ids:
            yield FailingUse(known.path, known.name, node.attr, id(node) in called_ids, node)


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
