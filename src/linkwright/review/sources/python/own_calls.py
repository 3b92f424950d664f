"""Find calls by which a Python module uses its own functions and methods."""

from __future__ import annotations

import ast
from collections.abc import Collection, Iterator

from linkwright.review.sources.python.methods import find_own_uses
from linkwright.review.sources.python.signatures import Signature, read_method_signatures
from linkwright.review.sources.python.undefined_names import find_bound_names


def read_methods(tree: ast.Module) -> dict[str, Signature]:
    """Return the parameters of the methods of a module, by ``Class.method``.

    Only methods that all objects of the class certainly have count: not one that a class binds twice, that the module
    assigns to an object, or that another class of the module may replace.
    """
    definitions = [node for node in tree.body if isinstance(node, ast.ClassDef)]
    classes = {definition.name for definition in definitions}
    replaced = {
        node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute) and not isinstance(node.ctx, ast.Load)
    }
    for definition in definitions:
        names = [name for part in definition.body for name in _list_names(part)]
        if classes.intersection(ast.unparse(base) for base in definition.bases):
            replaced.update(names)
        replaced.update(name for name in names if names.count(name) > 1)
    return {
        f"{definition.name}.{method.name}": signature
        for definition in definitions
        for method, signature in read_method_signatures(definition, with_private=True)
        if method.name not in replaced
    }


def _list_names(part: ast.stmt) -> Iterator[str]:
    """Yield the names that a statement in the body of a class binds."""
    if isinstance(part, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
        yield part.name
    else:
        yield from find_bound_names(part)


def find_own_calls(tree: ast.Module, functions: Collection[str]) -> Iterator[tuple[str, ast.Call]]:
    """Yield the calls of functions and classes of the module, and of methods through ``self``, with the called names.

    Args:
        tree: the module.
        functions: the names of the searched functions, classes and methods, these as ``Class.method``.
    """
    bound = list(find_bound_names(tree))
    names = {name for name in functions if bound.count(name) == 1}
    calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call)]
    yield from ((call.func.id, call) for call in calls if isinstance(call.func, ast.Name) and call.func.id in names)
    calls_by_id = {id(call.func): call for call in calls}
    for definition in tree.body:
        if isinstance(definition, ast.ClassDef) and bound.count(definition.name) == 1:
            for attribute, is_called in find_own_uses(definition):
                name = f"{definition.name}.{attribute.attr}"
                if is_called and name in functions:
                    yield name, calls_by_id[id(attribute)]
