"""Find the values of the variables of a Python loop over constants."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import product
from typing import NamedTuple

_METHODS = ("items", "keys", "values")
_CHANGING_METHODS = frozenset(
    {"append", "extend", "insert", "update", "add", "setdefault", "pop", "popitem", "remove", "clear"}
)
_MAX_ITERATIONS = 32


class _Loop(NamedTuple):
    target: ast.expr
    source: ast.expr


def find_iterations(
    tree: ast.AST, node: ast.expr, resolve: Callable[[ast.expr], ast.expr]
) -> Sequence[Mapping[str, ast.expr]]:
    """Return the values of the loop variables in an expression, by name, for each iteration.

    The loops go over lists, tuples and dictionaries that nothing changes. The result is empty if the expression has no
    variable of such a loop around it, or if an iteration is not certain.

    Args:
        tree: the syntax tree of the source.
        node: an expression in it.
        resolve: returns the expression assigned to a name or attribute, and other expressions unchanged.
    """
    names = {part.id for part in ast.walk(node) if isinstance(part, ast.Name)}
    known: list[list[dict[str, ast.expr]]] = []
    for loop in _find_loops(tree, node):
        own = {part.id for part in ast.walk(loop.target) if isinstance(part, ast.Name)} & names
        if own:
            items = [_bind(loop.target, item, resolve) for item in _list_items(tree, loop.source, resolve)]
            known.append([item for item in items if own <= item.keys()])
            if len(known[-1]) < len(items):
                return ()
    found = [{name: value for item in items for name, value in item.items()} for items in product(*known)]
    return found if known and len(found) <= _MAX_ITERATIONS else ()


def _find_loops(tree: ast.AST, node: ast.expr) -> Iterator[_Loop]:
    """Yield the loops around an expression that do not assign their variables otherwise."""
    for part in ast.walk(tree):
        if isinstance(part, ast.For):
            loops, body = [_Loop(part.target, part.iter)], part.body
        elif isinstance(part, (ast.ListComp, ast.SetComp, ast.GeneratorExp)):
            loops, body = [_Loop(item.target, item.iter) for item in part.generators], [ast.Expr(part.elt)]
        else:
            continue
        inner = [child for statement in body for child in ast.walk(statement)]
        if any(child is node for child in inner):
            assigned = {child.id for child in inner if isinstance(child, ast.Name) and isinstance(child.ctx, ast.Store)}
            for loop in loops:
                own = {child.id for child in ast.walk(loop.target) if isinstance(child, ast.Name)}
                if own.isdisjoint(assigned):
                    yield loop


def _list_items(tree: ast.AST, source: ast.expr, resolve: Callable[[ast.expr], ast.expr]) -> Sequence[ast.expr]:
    """Return the items of a list, tuple or dictionary, or nothing if they are not certain."""
    is_call = isinstance(source, ast.Call) and isinstance(source.func, ast.Attribute) and not source.args
    owner, method = source, "keys"
    if is_call and isinstance(source, ast.Call) and isinstance(source.func, ast.Attribute):
        owner, method = source.func.value, source.func.attr
    value = resolve(owner)
    if _is_changed(tree, owner):
        return ()
    if isinstance(value, ast.Dict) and method in _METHODS:
        keys = [key for key in value.keys if key is not None]
        if len(keys) < len(value.values):
            return ()
        if method == "items":
            return [ast.Tuple([key, item], ast.Load()) for key, item in zip(keys, value.values, strict=True)]
        return keys if method == "keys" else value.values
    return value.elts if isinstance(value, (ast.List, ast.Tuple)) and not is_call else ()


def _is_changed(tree: ast.AST, owner: ast.expr) -> bool:
    """Return whether a source may add items to a list or dictionary, or remove some."""
    text = ast.unparse(owner)
    for part in ast.walk(tree):
        if isinstance(part, ast.Call) and isinstance(part.func, ast.Attribute) and part.func.attr in _CHANGING_METHODS:
            changed: ast.expr | None = part.func.value
        elif isinstance(part, ast.Subscript) and not isinstance(part.ctx, ast.Load):
            changed = part.value
        else:
            changed = part.target if isinstance(part, ast.AugAssign) else None
        if changed is not None and ast.unparse(changed) == text:
            return True
    return False


def _bind(target: ast.expr, item: ast.expr, resolve: Callable[[ast.expr], ast.expr]) -> dict[str, ast.expr]:
    """Return the known values of the variables in the target of a loop for an item, by name."""
    if isinstance(target, ast.Name):
        return {target.id: item}
    value = resolve(item)
    bound: dict[str, ast.expr] = {}
    is_list = isinstance(target, (ast.Tuple, ast.List)) and isinstance(value, (ast.Tuple, ast.List))
    if is_list and isinstance(target, (ast.Tuple, ast.List)) and isinstance(value, (ast.Tuple, ast.List)):
        has_stars = any(isinstance(part, ast.Starred) for part in (*target.elts, *value.elts))
        for part, element in zip(target.elts, value.elts, strict=False) if not has_stars else ():
            bound |= _bind(part, element, resolve)
    return bound
