"""Find the uses of lost interfaces and fields in Python sources."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from linkwright.diagnostics import SourceText
from linkwright.review.caching import cached_in_review
from linkwright.review.sources.interface_uses.definitions import WHOLE, InterfaceUse, LostInterface
from linkwright.review.sources.python.source_nodes import SERVICES, SourceNodes, get_function_name
from linkwright.review.sources.python_names import parse_source

_MAX_SOURCES = 128
"""The maximum number of sources whose nodes are kept."""


def find_python_uses(text: str, interface: LostInterface) -> Iterator[InterfaceUse]:
    """Yield the places where a source uses something that an interface lost.

    Objects count if the source constructs them or gets them in a callback of a subscription or service.
    """
    nodes = _read_nodes(text)
    if nodes is not None:
        yield from _UseFinder(nodes, interface).find()


@cached_in_review(maxsize=_MAX_SOURCES)
def _read_nodes(text: str) -> SourceNodes | None:
    """Return the nodes of a source, or None if it is not Python. A review searches it for many interfaces."""
    try:
        return SourceNodes(parse_source(SourceText("", text)).tree)
    except (SyntaxError, ValueError, RecursionError):
        return None


class _UseFinder:
    """Finds the uses of a lost interface or of its lost fields in a syntax tree."""

    def __init__(self, nodes: SourceNodes, interface: LostInterface) -> None:
        self._nodes = nodes
        self._interface = interface
        self._modules: dict[str, str] = {}  # the kind of each name of a module with interfaces
        self._classes: dict[str, str] = {}  # the part of the interface by the local name of its class

    def find(self) -> Iterator[InterfaceUse]:
        """Yield the uses."""
        for node in self._nodes.imports:
            if isinstance(node, ast.Import):
                for alias in node.names:
                    package, _, module = alias.name.partition(".")
                    if package == self._interface.package and module:
                        self._modules[alias.asname or alias.name] = module
            elif not node.level:
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
            passed = [(item, name, part) for item, name in self._nodes.passed.find(function, variable)]
            variables += [item for item in passed if item not in variables]

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
        for node in self._nodes.accesses:
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
        module = self._modules.get(ast.unparse(node.value)) if self._modules else None
        if module is not None:
            return self._interface.find_classes(module).get(node.attr)
        return self._interface.inner_parts.get(node.attr) if self._find_part(node.value) == WHOLE else None

    def _find_constructors(self) -> Iterator[InterfaceUse]:
        """Yield the lost fields that constructors get by name, and the lost constants of classes."""
        for node in self._nodes.accesses:
            if isinstance(node, ast.Call):
                part = self._find_part(node.func)
                names = frozenset() if part is None else self._interface.lost_from(part)
                for keyword in node.keywords:
                    if keyword.arg in names:
                        yield from self._report(keyword.value, f"{part}{keyword.arg}")
            else:
                part = self._find_part(node.value)
                if part is not None and node.attr in self._interface.lost_from(part) & self._interface.constants:
                    yield from self._report(node, f"{part}{node.attr}")

    def _find_variables(self) -> Iterator[tuple[ast.AST, str, str]]:
        """Yield the variables that only hold objects of the interface.

        Each is given as the function in which it is known, its name, and the part of the interface.
        """
        for scope, name, classes in self._nodes.constructed:
            part, *others = {self._find_part(node) for node in classes}
            if part is not None and not others:
                yield scope, name, part
        for call in self._nodes.callback_calls:
            yield from self._find_callback_arguments(call)

    def _find_callback_arguments(self, call: ast.Call) -> Iterator[tuple[ast.AST, str, str]]:
        part = next((found for node in call.args[:2] if (found := self._find_part(node)) is not None), None)
        functions = self._nodes.find_callbacks(call)
        if part is None or len(functions) != 1:
            return
        is_service = get_function_name(call) in SERVICES
        names = [argument.arg for argument in functions[0].args.args if argument.arg not in ("self", "cls")]
        parts = ("request ", "response ") if is_service else (part,)
        assigned = {
            node.id
            for node in ast.walk(functions[0])
            if isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Load)
        }
        if (part == WHOLE) == is_service:
            yield from (
                (functions[0], name, part) for name, part in zip(names, parts, strict=False) if name not in assigned
            )

    def _find_accesses(self, scope: ast.AST, variable: str, part: str) -> Iterator[InterfaceUse]:
        names = self._interface.lost_from(part)
        fields = self._interface.field_types.get(part, {})
        for node in self._nodes.of_scope(scope):
            if not isinstance(node, ast.Attribute):
                continue
            if node.attr in names and ast.unparse(node.value) == variable:
                yield from self._report(node, f"{part}{node.attr}")
            elif isinstance(node.value, ast.Attribute) and ast.unparse(node.value.value) == variable:
                inner = fields.get(node.value.attr)
                if inner is not None and node.attr in inner.lost_from(""):
                    yield from self._report(node, node.attr, interface=inner)

    def _report(
        self,
        node: ast.stmt | ast.expr,
        name: str,
        alias: ast.alias | None = None,
        interface: LostInterface | None = None,
    ) -> Iterator[InterfaceUse]:
        place = alias or node
        field = name.rpartition(" ")[2]
        is_guarded = id(node) in self._nodes.guarded
        if not self._interface.is_removed:
            is_guarded = field in self._nodes.tested or id(node) in self._nodes.handled
        if not is_guarded:
            yield InterfaceUse(interface or self._interface, name, place.lineno, place.col_offset + 1)
