"""Find the functions of a Python source to which another function passes a variable."""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterator
from functools import cached_property

from linkwright.packages.readers.python_values import argument_of, called_name

_Function = (ast.FunctionDef, ast.AsyncFunctionDef)
_THREADS = frozenset({"Thread", "Timer"})


class PassedVariables:
    """The functions of a source to which other functions pass variables.

    Args:
        tree: the syntax tree of the source. It must not change.
    """

    def __init__(self, tree: ast.Module) -> None:
        self._tree = tree
        self._passed_by_scope: dict[int, dict[str, list[tuple[str, int]]]] = {}

    def find(self, scope: ast.AST, variable: str) -> Iterator[tuple[ast.FunctionDef | ast.AsyncFunctionDef, str]]:
        """Yield the functions that only get a variable of another function as an argument, each with the parameter.

        Args:
            scope: the function that has the variable.
            variable: the name of the variable, which has one value.
        """
        if id(scope) not in self._passed_by_scope:
            self._passed_by_scope[id(scope)] = _list_passed(scope)
        for function, index in self._passed_by_scope[id(scope)].get(variable, ()):
            definition = self._find_only(function)
            if definition is None:
                continue
            names = [argument.arg for argument in definition.args.args if argument.arg not in ("self", "cls")]
            name = names[index] if index < len(names) else None
            if name is not None and not _is_assigned(definition, name):
                yield definition, name

    def _find_only(self, name: str) -> ast.FunctionDef | ast.AsyncFunctionDef | None:
        """Return the only function with a name, if the source uses it in one place; None otherwise."""
        functions = self._functions.get(name, [])
        return functions[0] if len(functions) == 1 and self._use_counts[name] == 1 else None

    @cached_property
    def _functions(self) -> dict[str, list[ast.FunctionDef | ast.AsyncFunctionDef]]:
        """The functions and methods, by name."""
        functions: dict[str, list[ast.FunctionDef | ast.AsyncFunctionDef]] = {}
        for node in ast.walk(self._tree):
            if isinstance(node, _Function):
                functions.setdefault(node.name, []).append(node)
        return functions

    @cached_property
    def _use_counts(self) -> Counter[str]:
        """The number of uses of each name, also as an attribute."""
        nodes = (node for node in ast.walk(self._tree) if isinstance(node, (ast.Attribute, ast.Name)))
        return Counter(node.attr if isinstance(node, ast.Attribute) else node.id for node in nodes)


def _list_passed(scope: ast.AST) -> dict[str, list[tuple[str, int]]]:
    """Return the functions that get each variable as one argument, with the index of the argument, by variable."""
    passed: dict[str, list[tuple[str, int]]] = {}
    for call in ast.walk(scope):
        function, arguments = _read_call(call) if isinstance(call, ast.Call) else ("", [])
        names = [item.id if isinstance(item, ast.Name) else None for item in arguments] if function else []
        for index, name in enumerate(names):
            if name is not None and names.count(name) == 1:
                passed.setdefault(name, []).append((function, index))
    return passed


def _read_call(call: ast.Call) -> tuple[str, list[ast.expr]]:
    """Return the function of the source that a call or a thread runs, and its arguments; empty for another one."""
    if called_name(call).rpartition(".")[2] in _THREADS:
        target, arguments = argument_of(call, "target"), argument_of(call, "args")
        return _get_own_name(target), list(arguments.elts) if isinstance(arguments, (ast.List, ast.Tuple)) else []
    return _get_own_name(call.func), call.args


def _get_own_name(node: ast.expr | None) -> str:
    """Return the name of a function or of a method of the own class; empty for another expression."""
    if isinstance(node, ast.Attribute):
        return node.attr if ast.unparse(node.value) in ("self", "cls") else ""
    return node.id if isinstance(node, ast.Name) else ""


def _is_assigned(function: ast.AST, name: str) -> bool:
    nodes = (node for node in ast.walk(function) if isinstance(node, ast.Name) and node.id == name)
    return any(not isinstance(node.ctx, ast.Load) for node in nodes)
