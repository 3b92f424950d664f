"""List the nodes of a Python source that use interfaces, once for all interfaces."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cached_property

from linkwright.packages.readers.python_values import called_name
from linkwright.review.sources.python.passed_variables import PassedVariables

SERVICES = frozenset({"Service", "create_service"})
"""The functions that offer a service."""
_SUBSCRIPTION = re.compile(r"\w*subscri(?:be|ber|ption)", re.IGNORECASE)
"""The functions that make a subscription, of rospy and rclpy or their wrappers in a repository."""
_TESTS = frozenset({"hasattr", "getattr"})
"""The functions with which a source tests whether an object has a field."""
_CALLBACK_INDEX = 2
"""The index of the callback among the arguments of subscriptions and services, in ROS 1 and ROS 2."""
_Function = (ast.FunctionDef, ast.AsyncFunctionDef)


class SourceNodes:
    """The nodes of a syntax tree, by their use. Each list is in the order of `ast.walk` and made when first needed.

    Args:
        tree: the syntax tree. It must not change.
    """

    def __init__(self, tree: ast.Module) -> None:
        self._tree = tree
        self._scope_nodes: dict[int, list[ast.AST]] = {}

    @cached_property
    def _nodes(self) -> list[ast.AST]:
        return list(ast.walk(self._tree))

    @cached_property
    def imports(self) -> list[ast.Import | ast.ImportFrom]:
        """The statements that import modules or names."""
        return [node for node in self._nodes if isinstance(node, (ast.Import, ast.ImportFrom))]

    @cached_property
    def accesses(self) -> list[ast.Call | ast.Attribute]:
        """The calls and the accesses of attributes."""
        return [node for node in self._nodes if isinstance(node, (ast.Call, ast.Attribute))]

    @cached_property
    def callback_calls(self) -> list[ast.Call]:
        """The calls that make a subscription or offer a service."""
        calls = (node for node in self._nodes if isinstance(node, ast.Call))
        return [
            call for call in calls if (name := get_function_name(call)) in SERVICES or _SUBSCRIPTION.fullmatch(name)
        ]

    def find_callbacks(self, call: ast.Call) -> list[ast.FunctionDef | ast.AsyncFunctionDef]:
        """Return the functions with the name of the callback of a subscription or service."""
        keywords = {keyword.arg: keyword.value for keyword in call.keywords}
        callback = call.args[_CALLBACK_INDEX] if len(call.args) > _CALLBACK_INDEX else None
        callback = callback or keywords.get("callback") or keywords.get("handler")
        name = callback.attr if isinstance(callback, ast.Attribute) else getattr(callback, "id", "")
        return self._functions.get(name, [])

    @cached_property
    def _functions(self) -> dict[str, list[ast.FunctionDef | ast.AsyncFunctionDef]]:
        """The functions and methods, by name."""
        functions: dict[str, list[ast.FunctionDef | ast.AsyncFunctionDef]] = {}
        for node in self._nodes:
            if isinstance(node, _Function):
                functions.setdefault(node.name, []).append(node)
        return functions

    @cached_property
    def constructed(self) -> list[tuple[ast.AST, str, list[ast.expr]]]:
        """The variables that only get results of calls.

        Each is given as the function or class in which it is known, its name, and the called functions.
        """
        scopes = (node for node in self._nodes if isinstance(node, (ast.Module, ast.ClassDef, *_Function)))
        return [
            (scope, name, [function for function in functions if function is not None])
            for scope in scopes
            for name, functions in self._find_assigned(scope).items()
            if None not in functions
        ]

    def _find_assigned(self, scope: ast.AST) -> dict[str, list[ast.expr | None]]:
        """Return the functions whose results each variable of a scope gets, by name; None for another value.

        The variables of a class are its members.
        """
        nodes = self.of_scope(scope)
        called_functions = {
            id(target): node.value.func
            for node in nodes
            if isinstance(node, ast.Assign) and isinstance(node.value, ast.Call)
            for target in node.targets
        }
        kind = ast.Attribute if isinstance(scope, ast.ClassDef) else ast.Name
        assigned: dict[str, list[ast.expr | None]] = {}
        for node in nodes:
            if isinstance(node, kind) and not isinstance(node.ctx, ast.Load):
                assigned.setdefault(ast.unparse(node), []).append(called_functions.get(id(node)))
            elif isinstance(node, ast.arg) and kind is ast.Name:
                assigned.setdefault(node.arg, []).append(None)
        return assigned

    def of_scope(self, scope: ast.AST) -> list[ast.AST]:
        """Return the nodes of a function or module without those of inner ones, or all nodes of a class."""
        nodes = self._scope_nodes.get(id(scope))
        if nodes is None:
            nodes = list(ast.walk(scope) if isinstance(scope, ast.ClassDef) else _walk_scope(scope))
            self._scope_nodes[id(scope)] = nodes
        return nodes

    @cached_property
    def passed(self) -> PassedVariables:
        """The functions to which other functions pass variables."""
        return PassedVariables(self._tree)

    @cached_property
    def guarded(self) -> set[int]:
        """The identities of nodes inside ``try``."""
        parts = (part for node in self._nodes if isinstance(node, ast.Try) for part in node.body)
        return {id(inner) for part in parts for inner in ast.walk(part)}

    @cached_property
    def handled(self) -> set[int]:
        """The identities of nodes whose ``AttributeError`` is handled, also in functions called there."""
        bodies = [
            inner
            for node in self._nodes
            if isinstance(node, ast.Try)
            and any("AttributeError" in ast.unparse(handler.type) for handler in node.handlers if handler.type)
            for part in node.body
            for inner in ast.walk(part)
        ]
        called = {called_name(node).rpartition(".")[2] for node in bodies if isinstance(node, ast.Call)}
        functions = (function for name in called for function in self._functions.get(name, ()))
        return {id(node) for node in bodies} | {id(inner) for function in functions for inner in ast.walk(function)}

    @cached_property
    def tested(self) -> set[object]:
        """The names of attributes that the source looks up with ``hasattr`` or ``getattr``."""
        calls = (node for node in self._nodes if isinstance(node, ast.Call))
        return {
            argument.value
            for call in calls
            if isinstance(call.func, ast.Name) and call.func.id in _TESTS
            for argument in call.args[1:2]
            if isinstance(argument, ast.Constant)
        }


def get_function_name(call: ast.Call) -> str:
    """Return the last part of the name of a called function; empty if it has none."""
    return call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")


def _walk_scope(scope: ast.AST) -> Iterator[ast.AST]:
    """Yield the nodes of a function or module without those of inner functions and classes."""
    stack = list(ast.iter_child_nodes(scope))
    while stack:
        node = stack.pop(0)
        yield node
        if not isinstance(node, (*_Function, ast.Lambda, ast.ClassDef)):
            stack[:0] = ast.iter_child_nodes(node)
