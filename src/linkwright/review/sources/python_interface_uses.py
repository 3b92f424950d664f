"""Find the uses of lost interfaces and fields in Python sources."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from linkwright.diagnostics import SourceText
from linkwright.packages.readers.python_values import called_name
from linkwright.review.sources.interface_uses import WHOLE, InterfaceUse, LostInterface
from linkwright.review.sources.passed_variables import find_passed
from linkwright.review.sources.python import parse_source

_SUBSCRIPTION = re.compile(r"\w*subscri(?:be|ber|ption)", re.IGNORECASE)
"""The functions that make a subscription, of rospy and rclpy or their wrappers in a repository."""
_SERVICES = frozenset({"Service", "create_service"})
_TESTS = frozenset({"hasattr", "getattr"})
"""The functions with which a source tests whether an object has a field."""
_CALLBACK_INDEX = 2
"""The index of the callback among the arguments of subscriptions and services, in ROS 1 and ROS 2."""
_Function = (ast.FunctionDef, ast.AsyncFunctionDef)


def find_python_uses(text: str, interface: LostInterface) -> Iterator[InterfaceUse]:
    """Yield the places where a source uses something that an interface lost.

    Objects count if the source constructs them or gets them in a callback of a subscription or service.
    """
    try:
        tree = parse_source(SourceText("", text)).tree
    except (SyntaxError, ValueError, RecursionError):
        return
    yield from _UseFinder(tree, interface).find()


class _UseFinder:
    """Finds the uses of a lost interface or of its lost fields in a syntax tree."""

    def __init__(self, tree: ast.Module, interface: LostInterface) -> None:
        self._tree = tree
        self._interface = interface
        self._nodes = list(ast.walk(tree))
        self._guarded = {
            id(inner)
            for node in self._nodes
            if isinstance(node, ast.Try)
            for part in node.body
            for inner in ast.walk(part)
        }
        self._handled = set(self._find_handled())
        self._tested = {
            argument.value
            for node in self._nodes
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in _TESTS
            for argument in node.args[1:2]
            if isinstance(argument, ast.Constant)
        }
        self._modules: dict[str, str] = {}  # the kind of each name of a module with interfaces
        self._classes: dict[str, str] = {}  # the part of the interface by the local name of its class

    def find(self) -> Iterator[InterfaceUse]:
        """Yield the uses."""
        for node in self._nodes:
            if isinstance(node, ast.Import):
                for alias in node.names:
                    package, _, module = alias.name.partition(".")
                    if package == self._interface.package and module:
                        self._modules[alias.asname or alias.name] = module
            elif isinstance(node, ast.ImportFrom) and not node.level:
                yield from self._read_import(node)
        if self._interface.is_removed:
            yield from self._find_attributes_of_modules()
            return
        if not (self._classes or self._modules):
            return
        yield from self._find_constructors()
        variables = list(self._find_variables())
        for function, variable, part in variables:  # the loop appends to the list
            yield from self._find_accesses(function, variable, part)
            passed = [(item, name, part) for item, name in find_passed(self._tree, function, variable)]
            variables += [item for item in passed if item not in variables]

    def _find_handled(self) -> Iterator[int]:
        """Yield the identities of nodes whose ``AttributeError`` is handled, also in functions called there."""
        bodies = [
            inner
            for node in self._nodes
            if isinstance(node, ast.Try)
            and any("AttributeError" in ast.unparse(handler.type) for handler in node.handlers if handler.type)
            for part in node.body
            for inner in ast.walk(part)
        ]
        called = {called_name(node).rpartition(".")[2] for node in bodies if isinstance(node, ast.Call)}
        functions = [node for node in self._nodes if isinstance(node, _Function) and node.name in called]
        yield from (id(node) for node in bodies)
        yield from (id(inner) for function in functions for inner in ast.walk(function))

    def _read_import(self, node: ast.ImportFrom) -> Iterator[InterfaceUse]:
        package, _, module = (node.module or "").partition(".")
        if package != self._interface.package:
            return
        for alias in node.names:
            if not module:
                self._modules[alias.asname or alias.name] = alias.name
                continue
            classes = self._interface.find_classes(module)
            if alias.name in classes and self._interface.is_removed:
                yield from self._report(node, "", alias)
            elif alias.name in classes:
                self._classes[alias.asname or alias.name] = classes[alias.name]
            elif alias.name == "*" and not self._interface.is_removed:
                self._classes.update(classes)

    def _find_attributes_of_modules(self) -> Iterator[InterfaceUse]:
        for node in self._nodes:
            if isinstance(node, ast.Attribute):
                module = self._modules.get(ast.unparse(node.value))
                if module is not None and node.attr in self._interface.find_classes(module):
                    yield from self._report(node, "")

    def _find_part(self, node: ast.expr | None) -> str | None:
        """Return the part of the interface that an expression for a class names, or None."""
        if isinstance(node, ast.Name):
            return self._classes.get(node.id)
        if not isinstance(node, ast.Attribute):
            return None
        module = self._modules.get(ast.unparse(node.value))
        if module is not None:
            return self._interface.find_classes(module).get(node.attr)
        return self._interface.inner_parts.get(node.attr) if self._find_part(node.value) == WHOLE else None

    def _find_constructors(self) -> Iterator[InterfaceUse]:
        """Yield the lost fields that constructors get by name, and the lost constants of classes."""
        for node in self._nodes:
            if isinstance(node, ast.Call):
                part = self._find_part(node.func)
                names = frozenset() if part is None else self._interface.lost_from(part)
                for keyword in node.keywords:
                    if keyword.arg in names:
                        yield from self._report(keyword.value, f"{part}{keyword.arg}")
            elif isinstance(node, ast.Attribute):
                part = self._find_part(node.value)
                if part is not None and node.attr in self._interface.lost_from(part) & self._interface.constants:
                    yield from self._report(node, f"{part}{node.attr}")

    def _find_variables(self) -> Iterator[tuple[ast.AST, str, str]]:
        """Yield the variables that only hold objects of the interface.

        Each is given as the function in which it is known, its name, and the part of the interface.
        """
        scopes = [node for node in self._nodes if isinstance(node, (ast.Module, ast.ClassDef, *_Function))]
        for scope in scopes:
            parts: dict[str, set[str | None]] = {}
            nodes = list(ast.walk(scope) if isinstance(scope, ast.ClassDef) else _walk_scope(scope))
            constructed = {
                id(target): self._find_part(node.value.func)
                for node in nodes
                if isinstance(node, ast.Assign) and isinstance(node.value, ast.Call)
                for target in node.targets
            }
            kind = ast.Attribute if isinstance(scope, ast.ClassDef) else ast.Name  # of a class, only its members
            for node in nodes:
                if isinstance(node, kind) and not isinstance(node.ctx, ast.Load):
                    parts.setdefault(ast.unparse(node), set()).add(constructed.get(id(node)))
                elif isinstance(node, ast.arg) and kind is ast.Name:
                    parts.setdefault(node.arg, set()).add(None)
            for name, found in parts.items():
                (part, *others) = found
                if part is not None and not others:
                    yield scope, name, part
        for call in self._nodes:
            if isinstance(call, ast.Call):
                yield from self._find_callback_arguments(call)

    def _find_callback_arguments(self, call: ast.Call) -> Iterator[tuple[ast.AST, str, str]]:
        name = call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")
        if name not in _SERVICES and not _SUBSCRIPTION.fullmatch(name):
            return
        part = next((found for node in call.args[:2] if (found := self._find_part(node)) is not None), None)
        keywords = {keyword.arg: keyword.value for keyword in call.keywords}
        callback = call.args[_CALLBACK_INDEX] if len(call.args) > _CALLBACK_INDEX else None
        callback = callback or keywords.get("callback") or keywords.get("handler")
        function_name = callback.attr if isinstance(callback, ast.Attribute) else getattr(callback, "id", "")
        functions = [node for node in self._nodes if isinstance(node, _Function) and node.name == function_name]
        if part is None or len(functions) != 1:
            return
        names = [argument.arg for argument in functions[0].args.args if argument.arg not in ("self", "cls")]
        parts = ("request ", "response ") if name in _SERVICES else (part,)
        assigned = {
            node.id
            for node in ast.walk(functions[0])
            if isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Load)
        }
        if (part == WHOLE) == (name in _SERVICES):
            yield from (
                (functions[0], name, part) for name, part in zip(names, parts, strict=False) if name not in assigned
            )

    def _find_accesses(self, scope: ast.AST, variable: str, part: str) -> Iterator[InterfaceUse]:
        names = self._interface.lost_from(part)
        for node in ast.walk(scope) if isinstance(scope, ast.ClassDef) else _walk_scope(scope):
            is_access = isinstance(node, ast.Attribute) and node.attr in names
            if isinstance(node, ast.Attribute) and is_access and ast.unparse(node.value) == variable:
                yield from self._report(node, f"{part}{node.attr}")

    def _report(self, node: ast.stmt | ast.expr, name: str, alias: ast.alias | None = None) -> Iterator[InterfaceUse]:
        place = alias or node
        field = name.rpartition(" ")[2]
        is_guarded = id(node) in self._guarded
        if not self._interface.is_removed:
            is_guarded = field in self._tested or id(node) in self._handled
        if not is_guarded:
            yield InterfaceUse(self._interface, name, place.lineno, place.col_offset + 1)


def _walk_scope(scope: ast.AST) -> Iterator[ast.AST]:
    """Yield the nodes of a function or module without those of inner functions and classes."""
    stack = list(ast.iter_child_nodes(scope))
    while stack:
        node = stack.pop(0)
        yield node
        if not isinstance(node, (*_Function, ast.Lambda, ast.ClassDef)):
            stack[:0] = ast.iter_child_nodes(node)
