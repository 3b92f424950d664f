"""Find undefined methods that Python classes call on themselves."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping

_DYNAMIC_NAMES = ("setattr", "__dict__", "__getattr__", "__getattribute__", "__setattr__")
"""The names with which a class can get further attributes."""


def find_defined_attributes(tree: ast.AST) -> Iterator[str]:
    """Yield the attributes that a source defines in classes or assigns to objects."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ClassDef):
            for part in node.body:
                if isinstance(part, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
                    yield part.name
                else:
                    yield from (inner.id for inner in ast.walk(part) if isinstance(inner, ast.Name))
        elif isinstance(node, ast.Attribute) and not isinstance(node.ctx, ast.Load):
            yield node.attr


def find_undefined_methods(tree: ast.Module) -> dict[str, ast.Attribute]:
    """Return the first call of each undefined method that a class calls on itself.

    Classes with base classes of other files, which may define the method, are left out.
    """
    names = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
    attributes = {node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute)}
    defined = set(find_defined_attributes(tree))
    if not {*names, *attributes, *defined}.isdisjoint(_DYNAMIC_NAMES):
        return {}
    classes = {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}
    first_calls: dict[str, ast.Attribute] = {}
    for definition in classes.values():
        if _is_complete(definition, classes):
            for call in _find_own_calls(definition):
                if call.attr not in defined and not call.attr.startswith("__"):
                    first_calls.setdefault(call.attr, call)
    return first_calls


def _is_complete(definition: ast.ClassDef, classes: Mapping[str, ast.ClassDef], depth: int = 0) -> bool:
    """Return whether the source defines a class and all of its base classes."""
    if definition.decorator_list or definition.keywords or depth > len(classes):
        return False
    names = [ast.unparse(base) for base in definition.bases if ast.unparse(base) != "object"]
    return all(name in classes and _is_complete(classes[name], classes, depth + 1) for name in names)


def _find_own_calls(definition: ast.ClassDef) -> Iterator[ast.Attribute]:
    """Yield the attributes of ``self`` that methods of a class call outside of ``try``."""
    for method in definition.body:
        if not isinstance(method, (ast.FunctionDef, ast.AsyncFunctionDef)) or not method.args.args:
            continue
        first = method.args.args[0].arg
        guarded_ids = {id(inner) for node in ast.walk(method) if isinstance(node, ast.Try)
                   for part in node.body for inner in ast.walk(part)}  # fmt: skip
        calls = (node.func for node in ast.walk(method) if isinstance(node, ast.Call) and id(node) not in guarded_ids)
        for call in calls:
            if isinstance(call, ast.Attribute) and isinstance(call.value, ast.Name) and call.value.id == first:
                yield call
