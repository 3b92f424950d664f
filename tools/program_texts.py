"""The texts that an expression of the program may give, as templates with ``{}`` for what cannot be told.

An f-string, a choice, a sum or a constant is followed to the texts it may give; so are names, functions that return
texts, and parameters. What stands in quotes or angle brackets is the user's and is a ``{}``.
"""

from __future__ import annotations

import ast
import builtins
import itertools
import re
from collections.abc import Iterable, Iterator

from program_source import (
    Function,
    Item,
    Program,
    Scope,
    called_name,
    is_made_of,
    names_of,
    returned_values,
)

HOLE = "{}"
DEEPEST = 12
_MOST = 400
_QUOTED_BY_NAME = frozenset({"did_you_mean", "nearest", "display_path", "attribute_name"})


class UnboundError(Exception):
    """An expression depends on a parameter of a function whose calls are to be looked at."""

    def __init__(self, function: Function) -> None:
        self.function = function


class Texts:
    """Follows the expressions of a program; there is a method for each kind of node, all with the same parameters."""

    # ruff: noqa: ARG002, N802

    def __init__(self, program: Program) -> None:
        self._program = program

    def of(self, node: ast.AST | None, scope: Scope, depth: int = 0, asking: bool = False) -> set[str]:
        """The texts that an expression may give.

        Args:
            node: the expression; None gives no text.
            scope: where it stands.
            depth: how far it has been followed.
            asking: raise where a parameter is not bound, instead of taking it for a hole.

        Raises:
            UnboundError: with the function whose parameter it is.
        """
        if node is None:
            return set()
        if depth > DEEPEST:
            return {HOLE}
        method = getattr(self, f"_of_{type(node).__name__}", None)
        if method is None:
            return {HOLE}
        found: set[str] = method(node, scope, depth + 1, asking)
        return found if len(found) <= _MOST else {HOLE}

    def _of_Constant(self, node: ast.Constant, scope: Scope, depth: int, asking: bool) -> set[str]:
        return {node.value} if isinstance(node.value, str) else set() if node.value is None else {str(node.value)}

    def _of_JoinedStr(self, node: ast.JoinedStr, scope: Scope, depth: int, asking: bool) -> set[str]:
        parts: list[set[str]] = []
        for index, part in enumerate(node.values):
            if isinstance(part, ast.Constant):
                parts.append({str(part.value)})
                continue
            assert isinstance(part, ast.FormattedValue)
            before = node.values[index - 1] if index else None
            after = node.values[index + 1] if index + 1 < len(node.values) else None
            quoted = _is_quoted(before, after)
            if quoted or part.conversion != -1 or part.format_spec is not None:
                parts.append({HOLE})
            else:
                parts.append(self.of(part.value, scope, depth, asking) or {HOLE})
        return _product(parts)

    def _of_BinOp(self, node: ast.BinOp, scope: Scope, depth: int, asking: bool) -> set[str]:
        if not isinstance(node.op, ast.Add):
            return {HOLE}
        sides = (node.left, node.right)
        return _product([self.of(side, scope, depth, asking) or {HOLE} for side in sides])

    def _of_IfExp(self, node: ast.IfExp, scope: Scope, depth: int, asking: bool) -> set[str]:
        return self.of(node.body, scope, depth, asking) | self.of(node.orelse, scope, depth, asking)

    def _of_BoolOp(self, node: ast.BoolOp, scope: Scope, depth: int, asking: bool) -> set[str]:
        values = node.values if isinstance(node.op, ast.Or) else node.values[-1:]
        return set().union(*(self.of(value, scope, depth, asking) for value in values))

    def _of_NamedExpr(self, node: ast.NamedExpr, scope: Scope, depth: int, asking: bool) -> set[str]:
        return self.of(node.value, scope, depth, asking)

    def _of_Name(self, node: ast.Name, scope: Scope, depth: int, asking: bool) -> set[str]:
        name, function = node.id, scope.function
        if function is not None:
            found: set[str] = set()
            if name in function.names:
                if scope.bound is None or name not in scope.bound:
                    if asking:
                        raise UnboundError(function)
                    found |= {HOLE}
                else:
                    bound = scope.bound[name]
                    found |= self.of(bound[0], bound[1], depth, asking) if bound else {HOLE}
            values = function.reaching(name, node)
            for value in values:
                found |= self._assigned(name, value, scope, depth, asking)
            if found or values:
                return found
        if name in scope.module.constants:
            return self.of(scope.module.constants[name], Scope(scope.module, None), depth, asking)
        known = self._program.constants.get(name, [])
        if len(known) == 1:
            return self.of(known[0][0], Scope(known[0][1], None), depth, asking)
        return {HOLE}

    def _assigned(self, name: str, value: ast.AST | Item, scope: Scope, depth: int, asking: bool) -> set[str]:
        if isinstance(value, ast.AugAssign):
            assert scope.function is not None
            if isinstance(value.value, ast.Constant) and not isinstance(value.value.value, str):
                return {HOLE}
            others = [each for _, each in scope.function.assigned[name] if not isinstance(each, (ast.AugAssign, Item))]
            before = set().union(*(self.of(each, scope, depth, asking) for each in others))
            return _product([before or {HOLE}, self.of(value.value, scope, depth, asking)])
        if isinstance(value, ast.ExceptHandler):
            return self._exception(value, scope, depth)
        if isinstance(value, Item):
            return self._item(value, scope, depth, asking)
        if is_made_of(value, name):
            return set()  # made of itself: the other values tell
        return self.of(value, scope, depth, asking)

    def _item(self, item: Item, scope: Scope, depth: int, asking: bool) -> set[str]:
        """One name of several that are assigned together, or the target of a loop."""
        found: set[str] = set()
        for value in self._alternatives(item.value, scope, item.looped):
            if item.index is None:
                found |= self.of(value, scope, depth, asking)
            elif isinstance(value, ast.Tuple) and item.index < len(value.elts):
                found |= self.of(value.elts[item.index], scope, depth, asking)
            elif isinstance(value, ast.Call):
                for function in self._resolve(value, scope):
                    inner = Scope(function.module, function, bound_arguments(function, value, scope))
                    for returned in returned_values(function.node):
                        for each in self._alternatives(returned, inner, False):
                            if isinstance(each, ast.Tuple) and item.index < len(each.elts):
                                found |= self.of(each.elts[item.index], inner, depth, asking)
        return found or {HOLE}

    def _alternatives(self, value: ast.AST, scope: Scope, looped: bool) -> Iterator[ast.AST]:
        if isinstance(value, ast.IfExp):
            yield from self._alternatives(value.body, scope, looped)
            yield from self._alternatives(value.orelse, scope, looped)
        elif looped and isinstance(value, (ast.Tuple, ast.List)):
            yield from value.elts
        elif looped and isinstance(value, ast.Name) and value.id in scope.module.constants:
            yield from self._alternatives(scope.module.constants[value.id], scope, True)
        elif not looped:
            yield value

    def _exception(self, handler: ast.ExceptHandler, scope: Scope, depth: int) -> set[str]:
        found = {HOLE}
        for name in names_of(handler.type, scope.module):
            foreign = hasattr(builtins, name) and scope.module.room != "xacro"
            for call in self._program.raised.get((scope.module.room, name), ()):
                if call.node.args and (call.module is scope.module or not foreign):
                    found |= self.of(call.node.args[0], Scope(call.module, call.function), depth)
        return found

    def _of_Subscript(self, node: ast.Subscript, scope: Scope, depth: int, asking: bool) -> set[str]:
        if isinstance(node.value, ast.Name):
            value = scope.module.constants.get(node.value.id)
            if isinstance(value, ast.Dict):
                return set().union(*(self.of(each, scope, depth, asking) for each in value.values))
        return {HOLE}

    def _of_Call(self, node: ast.Call, scope: Scope, depth: int, asking: bool) -> set[str]:
        name = called_name(node.func)
        if name == "did_you_mean":
            return {"did you mean {}?"}
        if name == "next" and node.args and isinstance(node.args[0], ast.GeneratorExp):
            rest = (self.of(each, scope, depth, asking) for each in node.args[1:])
            return self.of(node.args[0].elt, scope, depth, asking).union(*rest)
        if name == "str" and node.args:
            return self.of(node.args[0], scope, depth, asking)
        if isinstance(node.func, ast.Attribute):
            if name in ("strip", "rstrip"):
                characters = str(node.args[0].value) if node.args and isinstance(node.args[0], ast.Constant) else None
                return {text.rstrip(characters) for text in self.of(node.func.value, scope, depth, asking)}
            if name == "format":
                texts = self.of(node.func.value, scope, depth, asking)
                return {re.sub(r"\{\w*\}", HOLE, text) for text in texts}
            if name == "get" and isinstance(node.func.value, ast.Name):
                table = scope.module.constants.get(node.func.value.id)
                if isinstance(table, ast.Dict):
                    parts = [*table.values, *node.args[1:]]
                    return set().union(*(self.of(each, scope, depth, asking) for each in parts))
            if name == "join":
                return {HOLE}
        found: set[str] = set()
        for function in self._resolve(node, scope):
            inner = Scope(function.module, function, bound_arguments(function, node, scope))
            for returned in returned_values(function.node):
                found |= self.of(returned, inner, depth, asking)
        return found or {HOLE}

    def _of_Attribute(self, node: ast.Attribute, scope: Scope, depth: int, asking: bool) -> set[str]:
        """What classes give an attribute of theirs, or an attribute that a few places of the room set to texts."""
        if isinstance(node.value, ast.Name) and node.value.id == "self" and scope.function is not None:
            found = self.of_class(scope.function.owner, node.attr, scope, depth)
            if found:
                return found
        values = self._program.attributes.get((scope.module.room, node.attr), [])
        if not values or not all(isinstance(value, (ast.Constant, ast.JoinedStr)) for value, _ in values):
            return {HOLE}
        found = set()
        for value, where in values:
            found |= self.of(value, where, depth)
        return found or {HOLE}

    def _resolve(self, call: ast.Call, scope: Scope) -> list[Function]:
        name = called_name(call.func)
        if name in _QUOTED_BY_NAME:
            return []
        candidates = [each for each in self._program.functions.get(name, []) if each.node.name == name]
        same = [each for each in candidates if each.module is scope.module]
        if same:
            return same
        if isinstance(call.func, ast.Attribute) and not name.startswith("_") and len(candidates) > 1:
            return [each for each in candidates if each.module.room == scope.module.room]
        return candidates if len(candidates) == 1 else []

    def of_class(self, owner: str, name: str, scope: Scope, depth: int) -> set[str]:
        """What the class, or each of those derived from it, gives a name."""
        value = self._program.members.get((owner, name))
        if value is not None:
            return self.of(value, Scope(scope.module, None), depth)
        derived = [each for each, bases in self._program.bases.items() if owner in bases]
        return set().union(*(self.of_class(each, name, scope, depth) for each in derived))


def bound_arguments(function: Function, call: ast.Call, around: Scope) -> dict[str, tuple[ast.AST, Scope] | None]:
    """What a call gives for each parameter of a function, with the scope that it is to be looked at in."""
    names = function.names
    if names and names[0] in ("self", "cls"):
        names = names[1:]
    arguments = function.node.args
    positional = [each.arg for each in (*arguments.posonlyargs, *arguments.args)]
    given: dict[str, tuple[ast.AST, Scope] | None] = dict.fromkeys(function.names)
    here = Scope(function.module, None)
    for name, default in zip(reversed(positional), reversed(arguments.defaults), strict=False):
        given[name] = (default, here)
    for argument, keyword_default in zip(arguments.kwonlyargs, arguments.kw_defaults, strict=True):
        if keyword_default is not None:
            given[argument.arg] = (keyword_default, here)
    for name, value in zip(names, call.args, strict=False):
        given[name] = None if isinstance(value, ast.Starred) else (value, around)
    for keyword in call.keywords:
        if keyword.arg in given:
            given[keyword.arg] = (keyword.value, around)
    return given


def _is_quoted(before: ast.AST | None, after: ast.AST | None) -> bool:
    """Whether a filled-in part between these two stands in quotes or angle brackets: it is a word of the user's."""
    if not isinstance(before, ast.Constant):
        return False
    sign = str(before.value)[-1:]
    if sign in ("'", '"'):
        return isinstance(after, ast.Constant) and str(after.value).startswith(sign)
    return sign in ("<", "/", ".", "$")


def _product(parts: Iterable[set[str]]) -> set[str]:
    parts = list(parts)
    count = 1
    for part in parts:
        count *= max(1, len(part))
    if count > _MOST:
        parts = [part if len(part) == 1 else {HOLE} for part in parts]
    return {"".join(texts) for texts in itertools.product(*parts)}
