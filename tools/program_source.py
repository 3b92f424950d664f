"""The program's source as data: its functions, the calls of each, the classes, and what is assigned to which name."""

from __future__ import annotations

import ast
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any


@dataclass
class Function:
    """A function or method: its module, its definition, its class, and what it assigns to each name, and where."""

    module: Module
    node: ast.FunctionDef | ast.AsyncFunctionDef
    owner: str
    assigned: dict[str, list[tuple[Any, ast.AST | Item]]] = field(default_factory=lambda: defaultdict(list))
    _around: dict[ast.AST, tuple[ast.AST, str]] | None = None

    @property
    def names(self) -> list[str]:
        """The names of its parameters."""
        arguments = self.node.args
        return [each.arg for each in (*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs)]

    @property
    def called(self) -> str:
        """The name it is called by: that of the class for a constructor."""
        return self.owner if self.node.name == "__init__" else self.node.name

    def reaching(self, name: str, use: ast.Name) -> list[ast.AST | Item]:
        """The values that a name may have at a use: back to the last assignment that no branch goes around."""
        blocks = self._blocks(use)
        found: list[ast.AST | Item] = []
        for target, value in sorted(self.assigned.get(name, []), key=lambda each: -each[0].lineno):
            if target.lineno > use.lineno:
                continue
            found.append(value)
            around = self._blocks(target)[:1]
            if around and around[0] in blocks and not is_made_of(value, name):
                break
        return found or [value for _, value in self.assigned.get(name, [])]

    def _blocks(self, node: ast.AST) -> list[tuple[int, str]]:
        """The blocks of statements around a node, from the inside."""
        if self._around is None:
            self._around = {}
            for parent in ast.walk(self.node):
                for name, value in ast.iter_fields(parent):
                    for child in value if isinstance(value, list) else [value]:
                        if isinstance(child, ast.AST):
                            self._around[child] = (parent, name)
        found = []
        while node in self._around:
            parent, name = self._around[node]
            if isinstance(node, (ast.stmt, ast.ExceptHandler)):
                found.append((id(parent), name))
            node = parent
        return found


@dataclass
class Module:
    """A module: its file, the folder below the package that it is in, and what it assigns at its top."""

    path: Path
    room: str
    tree: ast.Module
    constants: dict[str, ast.AST] = field(default_factory=dict)


@dataclass
class Call:
    """A call, with the function it stands in."""

    module: Module
    function: Function | None
    node: ast.Call


@dataclass
class Scope:
    """Where an expression is looked at; `bound` tells what parameters are given there, each with its own scope."""

    module: Module
    function: Function | None
    bound: dict[str, tuple[ast.AST, Scope] | None] | None = None


@dataclass
class Item:
    """What a name among several gets: one place of a value, or one of the items of a loop.

    Attributes:
        value: what is taken apart.
        index: the place in it; None where an item goes to one name.
        looped: whether the value is gone through.
    """

    value: ast.AST
    index: int | None
    looped: bool


class Program:
    """The modules below a folder.

    Attributes:
        package: the folder.
        functions: by name; a constructor by the name of its class too.
        calls: by the name of what is called.
        raised: what is raised, by room and class.
        constants: of the modules, by name.
        members: what classes assign, by class and name.
        bases: the classes that a class is derived from.
        attributes: what is assigned to attributes, by room and name.
    """

    def __init__(self, package: Path) -> None:
        self.package = package
        self.functions: dict[str, list[Function]] = defaultdict(list)
        self.calls: dict[str, list[Call]] = defaultdict(list)
        self.raised: dict[tuple[str, str], list[Call]] = defaultdict(list)
        self.constants: dict[str, list[tuple[ast.AST, Module]]] = defaultdict(list)
        self.members: dict[tuple[str, str], ast.AST] = {}
        self.bases: dict[str, list[str]] = {}
        self.attributes: dict[tuple[str, str], list[tuple[ast.expr, Scope]]] = defaultdict(list)
        for path in sorted(package.rglob("*.py")):
            if "path" not in path.parts:  # the modules that stand in for others only name what is defined elsewhere
                self._index(self._read(path))

    def where(self, call: Call) -> str:
        """The place of a call, as ``file:line``."""
        return f"{call.module.path.relative_to(self.package.parent)}:{call.node.lineno}"

    def _read(self, path: Path) -> Module:
        parts = path.relative_to(self.package).parts
        return Module(path, parts[0].removesuffix(".py"), ast.parse(path.read_text(encoding="utf-8")))

    def _index(self, module: Module) -> None:
        for statement in module.tree.body:
            for target, value in _assignments(statement):
                module.constants[target] = value
                self.constants[target].append((value, module))
        self._walk(module, module.tree, None, "")

    def _walk(self, module: Module, node: ast.AST, function: Function | None, owner: str) -> None:
        for child in ast.iter_child_nodes(node):
            inner, inside = function, owner
            if isinstance(child, ast.ClassDef):
                inside = child.name
                self.bases[child.name] = [base.id for base in child.bases if isinstance(base, ast.Name)]
                for statement in child.body:
                    for target, value in _assignments(statement):
                        self.members[child.name, target] = value
            elif isinstance(child, (ast.FunctionDef, ast.AsyncFunctionDef)):
                inner = Function(module, child, owner)
                self.functions[inner.called].append(inner)
                if inner.called != child.name:
                    self.functions[child.name].append(inner)
                _collect(child, inner.assigned)
            elif isinstance(child, ast.Call):
                name = called_name(child.func)
                if name == "__init__" and owner:
                    for base in self.bases.get(owner, ()):
                        self.calls[base].append(Call(module, function, child))
                self.calls[name].append(Call(module, function, child))
            elif isinstance(child, ast.Assign) and isinstance(child.targets[0], ast.Attribute):
                attribute = child.targets[0].attr
                self.attributes[module.room, attribute].append((child.value, Scope(module, function)))
            elif isinstance(child, ast.Raise) and isinstance(child.exc, ast.Call):
                name = called_name(child.exc.func)
                self.raised[module.room, name].append(Call(module, function, child.exc))
            self._walk(module, child, inner, inside)


def _assignments(statement: ast.AST) -> Iterator[tuple[str, ast.AST]]:
    if isinstance(statement, ast.Assign):
        for target in statement.targets:
            if isinstance(target, ast.Name):
                yield target.id, statement.value
    elif isinstance(statement, ast.AnnAssign) and isinstance(statement.target, ast.Name) and statement.value:
        yield statement.target.id, statement.value


def _collect(function: ast.AST, assigned: dict[str, list[tuple[Any, ast.AST | Item]]]) -> None:
    for node in ast.walk(function):
        if isinstance(node, ast.Assign):
            for target in node.targets:
                _collect_target(node, target, node.value, False, assigned)
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name) and node.value:
            assigned[node.target.id].append((node, node.value))
        elif isinstance(node, ast.AugAssign) and isinstance(node.target, ast.Name):
            assigned[node.target.id].append((node, node))
        elif isinstance(node, ast.NamedExpr):
            assigned[node.target.id].append((node.target, node.value))
        elif isinstance(node, ast.ExceptHandler) and node.name:
            assigned[node.name].append((node, node))
        elif isinstance(node, (ast.For, ast.comprehension)):
            _collect_target(node.target, node.target, node.iter, True, assigned)


def _collect_target(
    at: ast.AST, target: ast.AST, value: ast.AST, looped: bool, assigned: dict[str, list[tuple[Any, ast.AST | Item]]]
) -> None:
    if isinstance(target, ast.Name):
        assigned[target.id].append((at, Item(value, None, True) if looped else value))
    elif isinstance(target, ast.Tuple):
        for index, name in enumerate(target.elts):
            if isinstance(name, ast.Name):
                assigned[name.id].append((at, Item(value, index, looped)))


def called_name(function: ast.AST) -> str:
    """The last name of what is called."""
    if isinstance(function, ast.Name):
        return function.id
    return function.attr if isinstance(function, ast.Attribute) else ""


def argument_of(call: ast.Call, position: int, keyword: str) -> ast.AST | None:
    """The argument of a call at a place or by a keyword, or None."""
    for each in call.keywords:
        if each.arg == keyword:
            return each.value
    if position < len(call.args) and not any(isinstance(each, ast.Starred) for each in call.args[: position + 1]):
        return call.args[position]
    return None


def returned_values(function: ast.AST) -> list[ast.AST]:
    """What the return statements of a function give."""
    return [node.value for node in ast.walk(function) if isinstance(node, ast.Return) and node.value is not None]


def names_of(node: ast.AST | None, module: Module) -> Iterator[str]:
    """The names of a class or a tuple of classes, as after ``except``."""
    if isinstance(node, ast.Tuple):
        for each in node.elts:
            yield from names_of(each, module)
    elif isinstance(node, ast.Name):
        constant = module.constants.get(node.id)
        if constant is not None:
            yield from names_of(constant, module)
        else:
            yield node.id
    elif isinstance(node, ast.Attribute):
        yield node.attr


def is_made_of(value: ast.AST | Item, name: str) -> bool:
    """Whether a value that is assigned to a name is made of what the name had before."""
    if isinstance(value, (ast.AugAssign, Item)):
        return isinstance(value, ast.AugAssign)
    return any(isinstance(part, ast.Name) and part.id == name for part in ast.walk(value))
