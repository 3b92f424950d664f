"""The bindings of names in a Python file, by function."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from linkwright.loading.lean_dataclasses import dataclass, field

Function = ast.FunctionDef | ast.AsyncFunctionDef


@dataclass(frozen=True, slots=True)
class Binding:
    """A statement or expression that binds a name to a value.

    Attributes:
        value: the expression; None if there is none, or it cannot be read.
        path: the position of the name's item in the value, for ``a, (b, c) = value``.
        is_item: whether the name is bound to each item of the value in turn, as in a loop.
        is_added: whether the value is added to the previous value, as by ``+=``, ``append``, ``extend`` and ``update``.
    """

    value: ast.expr | None
    path: tuple[int, ...] = ()
    is_item: bool = False
    is_added: bool = False


@dataclass(eq=False)
class Scope:
    """The names of a function, or of the module.

    Attributes:
        enclosing: the enclosing scope; None for the module.
        function: the function; None for the module.
        names: name -> the bindings of the name.
        entries: name -> the keys and values in assignments ``name[key] = value``.
    """

    enclosing: Scope | None = None
    function: Function | None = None
    names: dict[str, list[Binding]] = field(default_factory=dict)
    entries: dict[str, list[tuple[ast.expr, ast.expr]]] = field(default_factory=dict)

    def find(self, name: str) -> tuple[Scope, list[Binding]] | None:
        """Return the innermost scope that binds a name, with the bindings, or None."""
        scope: Scope | None = self
        while scope is not None:
            if name in scope.names:
                return scope, scope.names[name]
            scope = scope.enclosing
        return None


def walk_with_scopes(tree: ast.Module) -> list[tuple[ast.AST, Scope]]:
    """Return the nodes of a file, each with its scope, and read the bindings of all scopes.

    Outer nodes come first.
    """
    nodes: list[tuple[ast.AST, Scope]] = []
    pending: list[tuple[ast.AST, Scope]] = [(tree, Scope())]
    while pending:
        node, scope = pending.pop()
        nodes.append((node, scope))
        child_scope = scope
        if isinstance(node, Function):
            child_scope = Scope(scope, node)
            for argument in (*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs):
                child_scope.names[argument.arg] = []
        else:
            _record_bindings(node, scope)
        pending.extend((child, child_scope) for child in reversed(list(ast.iter_child_nodes(node))))
    return nodes


def _record_bindings(node: ast.AST, scope: Scope) -> None:
    if isinstance(node, ast.Assign):
        for target in node.targets:
            _bind_target(target, Binding(node.value), scope)
    elif isinstance(node, (ast.AnnAssign, ast.NamedExpr)) and node.value is not None:
        _bind_target(node.target, Binding(node.value), scope)
    elif isinstance(node, ast.AugAssign):
        _bind_target(node.target, Binding(node.value, is_added=isinstance(node.op, ast.Add)), scope)
    elif isinstance(node, (ast.For, ast.AsyncFor, ast.comprehension)):
        _bind_target(node.target, Binding(node.iter, is_item=True), scope)
    elif isinstance(node, ast.withitem) and node.optional_vars is not None:
        _bind_target(node.optional_vars, Binding(node.context_expr), scope)
    elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
        _record_addition(node.func, node.args, scope)


def _record_addition(method: ast.Attribute, args: list[ast.expr], scope: Scope) -> None:
    """Record the items that ``append``, ``extend`` or ``update`` add to a name of a scope."""
    bindings = scope.names.get(method.value.id) if isinstance(method.value, ast.Name) else None
    if bindings and len(args) == 1 and method.attr in ("append", "extend", "update"):
        value = ast.copy_location(ast.List(args, ast.Load()), args[0]) if method.attr == "append" else args[0]
        bindings.append(Binding(value, is_added=True))


def _bind_target(target: ast.expr, binding: Binding, scope: Scope) -> None:
    if isinstance(target, ast.Name):
        scope.names.setdefault(target.id, []).append(binding)
    elif isinstance(target, ast.Subscript) and isinstance(target.value, ast.Name) and binding.value is not None:
        scope.entries.setdefault(target.value.id, []).append((target.slice, binding.value))
    elif isinstance(target, (ast.Tuple, ast.List)):
        for index, element in enumerate(target.elts):
            element_binding = Binding(binding.value, (*binding.path, index), binding.is_item, binding.is_added)
            _bind_target(element, element_binding, scope)


def list_parameters(function: Function) -> list[str]:
    """Return the names of a function's parameters that can be passed by position."""
    return [argument.arg for argument in (*function.args.posonlyargs, *function.args.args)]


def iterate_defaults(function: Function) -> Iterator[tuple[str, ast.expr]]:
    """Yield each parameter of a function that has a default, and the default."""
    names = list_parameters(function)
    values = function.args.defaults
    yield from zip(names[len(names) - len(values) :], values, strict=True)
    for argument, default in zip(function.args.kwonlyargs, function.args.kw_defaults, strict=True):
        if default is not None:
            yield argument.arg, default
