"""Leave out statements of Python that have no effect, and split assignments of several values."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

_EXITS = (ast.Return, ast.Raise, ast.Continue, ast.Break)


def list_effective_statements(body: Sequence[ast.stmt]) -> Iterator[ast.stmt]:
    """Yield the statements of a block that have an effect, one for each assigned value.

    Left out are a ``return`` or the like after another one, and an assignment that is repeated at once. Other
    statements that cannot run are kept: a ``return`` before them tells more than that they are gone.

    Args:
        body: the statements of the block.
    """
    previous: ast.stmt | None = None
    for part in (part for statement in body for part in _split(statement)):
        is_exit = isinstance(part, _EXITS) and type(part) is type(previous)
        is_repeated = previous is not None and ast.dump(part) == ast.dump(previous) and _is_repeatable(part)
        if not is_exit and not is_repeated:
            yield part
        previous = part


def _split(statement: ast.stmt) -> Sequence[ast.stmt]:
    """Return an assignment such as ``a, b = x, y`` as one for each value, if these do not depend on each other."""
    if not isinstance(statement, ast.Assign) or len(statement.targets) != 1:
        return [statement]
    target, value = statement.targets[0], statement.value
    if not isinstance(target, ast.Tuple) or not isinstance(value, ast.Tuple) or len(target.elts) != len(value.elts):
        return [statement]
    if any(isinstance(item, ast.Starred) for item in (*target.elts, *value.elts)) or _can_change(value):
        return [statement]
    if not _list_stored(target).isdisjoint(_list_loaded(value)):
        return [statement]
    return [
        ast.copy_location(ast.Assign([item], part), statement)
        for item, part in zip(target.elts, value.elts, strict=True)
    ]


def _is_repeatable(statement: ast.stmt) -> bool:
    """Return whether a statement is an assignment with the same effect if it runs twice."""
    if not isinstance(statement, ast.Assign) or _can_change(statement):
        return False
    stored = {name for target in statement.targets for name in _list_stored(target)}
    return stored.isdisjoint(_list_loaded(statement.value))


def _can_change(node: ast.AST) -> bool:
    """Return whether an expression calls something, which may change other values."""
    kinds = (ast.Call, ast.Await, ast.Yield, ast.YieldFrom, ast.NamedExpr)
    return any(isinstance(part, kinds) for part in ast.walk(node))


def _list_stored(target: ast.expr) -> set[str]:
    """Return the names, attributes and items that get a value, with those in front of their dots and brackets."""
    nodes = list(ast.walk(target))
    stored = (node for node in nodes if isinstance(node, (ast.Name, ast.Attribute, ast.Subscript)))
    return {ast.unparse(node) for node in stored if isinstance(node.ctx, ast.Store)} | {
        ast.unparse(node.value) for node in nodes if isinstance(node, ast.Subscript)
    }


def _list_loaded(node: ast.expr) -> set[str]:
    return {ast.unparse(part) for part in ast.walk(node) if isinstance(part, (ast.Name, ast.Attribute, ast.Subscript))}
