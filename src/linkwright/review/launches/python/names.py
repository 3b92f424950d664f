"""Look up the values of names in Python launch files, including reassigned names."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

from linkwright.packages.readers.python_values import PythonFile

_MAX_ASSIGNMENTS = 40
_WHOLE_FILE = (0, 1 << 30)
_CHOSEN_MARK = "is_chosen"
"""The attribute of expressions that represent the values that an ``if`` statement gives to a name."""
_Branching = ast.If | ast.For | ast.While | ast.Try
_Function = ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda


@dataclass(frozen=True)
class _Binding:
    """A statement that gives a name a value.

    Attributes:
        line: the last line of the statement.
        value: the value; None if the statement does not contain it, as for parameters of functions.
        block: the first and last line of the block in which the value certainly applies.
    """

    line: int
    value: ast.expr | None
    block: tuple[int, int]


class LaunchPythonFile(PythonFile):
    """A Python launch file.

    A name has the value of the last assignment before it in its function.
    """

    def resolved(self, node: ast.expr) -> ast.expr:
        """Return the expression that is assigned to a name, and any other expression unchanged."""
        for _ in range(_MAX_ASSIGNMENTS):
            if not isinstance(node, ast.Name):
                break
            value = self.assigned_expression(node.id) or self._find_last_value(node)
            if value is None:
                break
            node = value
        return node

    def _find_last_value(self, node: ast.Name) -> ast.expr | None:
        """Return the last value of a name before a line, or None if it is not certain."""
        for start, end, bindings in self._scopes:
            earlier = [binding for binding in bindings.get(node.id, ()) if binding.line < node.lineno]
            if start <= node.lineno <= end and node.id in bindings:
                latest = max(earlier, key=lambda binding: binding.line) if earlier else None
                is_certain = latest is not None and latest.block[0] <= node.lineno <= latest.block[1]
                return self._fill(latest.value, node.id) if latest is not None and is_certain else None
        return None

    def _fill(self, value: ast.expr | None, name: str) -> ast.expr | None:
        """Return the value that an ``if`` statement chooses, with the earlier literal where no branch sets the name.

        The branches of tests for different texts have one order, and those with the last value are left out.
        """
        if value is None or not is_chosen_value(value):
            return value
        if id(value) not in self._filled:
            earlier = self.resolved(ast.copy_location(ast.Name(name, ast.Load()), value))
            filled = _fill_branches(value, name, earlier) if isinstance(earlier, ast.Constant) else value
            self._filled[id(value)] = value, _sort_branches(filled)
        return self._filled[id(value)][1]

    @cached_property
    def _filled(self) -> dict[int, tuple[ast.expr, ast.expr]]:
        """The chosen values with their filled forms, by the identity of the former."""
        return {}

    @cached_property
    def _scopes(self) -> list[tuple[int, int, dict[str, list[_Binding]]]]:
        """The first line, last line and bindings of each function and of the file.

        The innermost functions come first, and the file is the last.
        """
        functions = [node for node in ast.walk(self.tree) if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef))]
        scopes = [(node.lineno, node.end_lineno or node.lineno, _collect_bindings(node)) for node in functions]
        scopes.sort(key=lambda scope: scope[1] - scope[0])
        return [*scopes, (0, len(self.source.text), _collect_bindings(self.tree))]


def _fill_branches(value: ast.expr, name: str, earlier: ast.expr) -> ast.expr:
    if isinstance(value, ast.Name) and value.id == name:
        return earlier
    if not isinstance(value, ast.IfExp) or not is_chosen_value(value):
        return value
    branches = [_fill_branches(branch, name, earlier) for branch in (value.body, value.orelse)]
    return _make_choice(value, value.test, *branches)


def _make_choice(location: ast.expr, test: ast.expr, body: ast.expr, other: ast.expr) -> ast.expr:
    choice = ast.copy_location(ast.IfExp(test, body, other), location)
    setattr(choice, _CHOSEN_MARK, True)
    return choice


def _sort_branches(value: ast.expr) -> ast.expr:
    """Return a choice by texts in the order of the texts; other values are unchanged."""
    branches: dict[str, tuple[ast.expr, ast.expr]] = {}
    last, subjects = value, set()
    while isinstance(last, ast.IfExp) and is_chosen_value(last):
        test = last.test
        if not isinstance(test, ast.Compare) or len(test.ops) != 1 or not isinstance(test.ops[0], ast.Eq):
            return value
        text = test.comparators[0]
        if not isinstance(text, ast.Constant) or not isinstance(text.value, str):
            return value
        subjects.add(ast.unparse(test.left))
        branches.setdefault(text.value, (test, last.body))
        last = last.orelse
    if len(subjects) != 1:
        return value
    result, other = last, ast.unparse(last)
    for text_value in sorted(branches, reverse=True):
        test, body = branches[text_value]
        if ast.unparse(body) != other:
            result = _make_choice(value, test, body, result)
    return result


def _collect_bindings(scope: ast.AST) -> dict[str, list[_Binding]]:
    bindings: dict[str, list[_Binding]] = {}
    for node, block in _walk_scope(scope, _WHOLE_FILE):
        for name, value in _find_bound_names(node):
            line = getattr(node, "end_lineno", None) or 0
            bindings.setdefault(name, []).append(_Binding(line, value, block))
    return bindings


def _walk_scope(scope: ast.AST, block: tuple[int, int]) -> Iterator[tuple[ast.AST, tuple[int, int]]]:
    """Yield the nodes of a function or file with the lines of their blocks.

    Nested functions are left out.
    """
    for child in ast.iter_child_nodes(scope):
        yield child, block
        if isinstance(child, _Branching):
            handlers = [handler.body for handler in child.handlers] if isinstance(child, ast.Try) else []
            final = child.finalbody if isinstance(child, ast.Try) else []
            for statements in (child.body, child.orelse, *handlers, final):
                for statement in statements:
                    lines = statements[0].lineno, statements[-1].end_lineno or statements[-1].lineno
                    yield statement, lines
                    yield from _walk_scope(statement, lines)
        elif not isinstance(child, _Function):
            yield from _walk_scope(child, block)


def _find_bound_names(node: ast.AST) -> Iterator[tuple[str, ast.expr | None]]:
    """Yield the names that a node or the branches of a statement assign; None for unknown values."""
    yield from _find_chosen_values(node).items() if isinstance(node, ast.If) else _find_simple_names(node)


def _find_simple_names(node: ast.AST) -> Iterator[tuple[str, ast.expr | None]]:
    """Yield the names that a node itself assigns, with their values; None for unknown values."""
    if isinstance(node, ast.arguments):
        arguments = [*node.posonlyargs, *node.args, *node.kwonlyargs, node.vararg, node.kwarg]
        yield from ((argument.arg, None) for argument in arguments if argument is not None)
    elif isinstance(node, ast.Assign) and len(node.targets) == 1 and isinstance(node.targets[0], ast.Name):
        yield node.targets[0].id, node.value
    elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
        yield node.target.id, node.value
    elif isinstance(node, ast.Assign) and (items := _unpack(node)):
        yield from items
    elif isinstance(node, (ast.Assign, ast.AugAssign, ast.NamedExpr, ast.For, ast.comprehension, ast.withitem)):
        targets = (child for child in ast.walk(node) if isinstance(child, ast.Name))
        yield from ((target.id, None) for target in targets if isinstance(target.ctx, ast.Store))


def _unpack(node: ast.Assign) -> list[tuple[str, ast.expr | None]]:
    """Return the names of a statement such as ``a, b = f()`` with their items; empty for other statements."""
    target = node.targets[0]
    if len(node.targets) > 1 or not isinstance(target, (ast.Tuple, ast.List)):
        return []
    names = [name.id for name in target.elts if isinstance(name, ast.Name)]
    if len(names) < len(target.elts):
        return []
    if isinstance(node.value, ast.Call):
        items = [ast.Subscript(node.value, ast.Constant(index), ast.Load()) for index in range(len(names))]
        return [(name, ast.copy_location(item, node.value)) for name, item in zip(names, items, strict=True)]
    if isinstance(node.value, (ast.Tuple, ast.List)) and len(node.value.elts) == len(names):
        return list(zip(names, node.value.elts, strict=True))
    return []


def is_chosen_value(node: ast.expr) -> bool:
    """Return whether an expression represents the values that an ``if`` statement gives to a name."""
    return hasattr(node, _CHOSEN_MARK)


def _find_chosen_values(node: ast.If) -> dict[str, ast.expr]:
    """Return the values of the names that a statement assigns, as conditional expressions.

    In a branch that does not assign it, a name has the value before the statement.
    """
    values, other_values = _find_last_values(node.body), _find_last_values(node.orelse)
    names = {name for child in ast.walk(node) for name, _ in _find_simple_names(child)}
    chosen: dict[str, ast.expr] = {}
    for name in sorted(names & (values.keys() | other_values.keys())):
        before = ast.copy_location(ast.Name(name, ast.Load()), node)
        branches = [
            branch_values.get(name) or (None if _assigns(branch, name) else before)
            for branch_values, branch in ((values, node.body), (other_values, node.orelse))
        ]
        if branches[0] is not None and branches[1] is not None:
            value = ast.copy_location(ast.IfExp(node.test, branches[0], branches[1]), node)
            setattr(value, _CHOSEN_MARK, True)
            chosen[name] = value
    return chosen


def _assigns(body: Sequence[ast.stmt], name: str) -> bool:
    return any(name == other for node in body for child in ast.walk(node) for other, _ in _find_simple_names(child))


def _find_last_values(body: Sequence[ast.stmt]) -> dict[str, ast.expr]:
    """Return the values that the statements of a block certainly give to names."""
    values: dict[str, ast.expr] = {}
    for statement in body:
        bound = dict(_find_bound_names(statement))
        nested = {name for child in ast.walk(statement) for name, _ in _find_simple_names(child)} - bound.keys()
        values = {name: value for name, value in values.items() if name not in nested and name not in bound}
        values |= {name: value for name, value in bound.items() if value is not None}
    return values
