"""Find the functions of a Python source to which another function passes a variable."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from linkwright.packages.readers.python_values import argument_of, called_name

_Function = (ast.FunctionDef, ast.AsyncFunctionDef)
_THREADS = frozenset({"Thread", "Timer"})


def find_passed(
    tree: ast.Module, scope: ast.AST, variable: str
) -> Iterator[tuple[ast.FunctionDef | ast.AsyncFunctionDef, str]]:
    """Yield the functions that only get a variable of another function as an argument, each with the parameter.

    Args:
        tree: the syntax tree of the source.
        scope: the function that has the variable.
        variable: the name of the variable, which has one value.
    """
    for call in ast.walk(scope):
        function, arguments = _read_call(call) if isinstance(call, ast.Call) else ("", [])
        indexes = [index for index, item in enumerate(arguments) if isinstance(item, ast.Name) and item.id == variable]
        definition = _find_only(tree, function) if len(indexes) == 1 else None
        if definition is None:
            continue
        names = [argument.arg for argument in definition.args.args if argument.arg not in ("self", "cls")]
        name = names[indexes[0]] if indexes[0] < len(names) else None
        if name is not None and not _is_assigned(definition, name):
            yield definition, name


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


def _find_only(tree: ast.Module, name: str) -> ast.FunctionDef | ast.AsyncFunctionDef | None:
    """Return the only function with a name, if the source uses it in one place; None otherwise."""
    nodes = list(ast.walk(tree)) if name else []
    functions = [node for node in nodes if isinstance(node, _Function) and node.name == name]
    uses = [
        getattr(node, "attr", getattr(node, "id", "")) for node in nodes if isinstance(node, (ast.Attribute, ast.Name))
    ]
    return functions[0] if len(functions) == 1 and uses.count(name) == 1 else None


def _is_assigned(function: ast.AST, name: str) -> bool:
    nodes = (node for node in ast.walk(function) if isinstance(node, ast.Name) and node.id == name)
    return any(not isinstance(node.ctx, ast.Load) for node in nodes)
