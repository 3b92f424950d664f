"""The names that a text with expressions refers to, and the origin of each name's value."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass

from linkwright.diagnostics import Span
from linkwright.loading.lean_dataclasses import NamedTuple
from linkwright.loading.lean_typing import Any
from linkwright.xacro.expressions.template import TokenKind, tokenize
from linkwright.xacro.faults import Fault
from linkwright.xmltree.positions import attribute_value_range

_MAX_SHOWN_LENGTH = 100


@dataclass(frozen=True, slots=True)
class Value:
    """The value of a name at the time when a text was evaluated.

    Attributes:
        name: the name as written, such as ``radius``, ``arm.length`` or ``$(arg prefix)``.
        kind: ``parameter``, ``property``, ``argument``, ``package`` or ``variable`` (of the environment).
        value: the value in Python notation, truncated if it is long.
        span: the location where the value is written, or None if it was passed from outside.
        written: the text at this location, such as ``${wheel_radius}``, or None.
    """

    name: str
    kind: str
    value: str
    span: Span | None = None
    written: str | None = None


class Reference(NamedTuple):
    """A name in a text.

    Attributes:
        path: the expression that starts with the name, such as ``arm.length``, or the whole substitution.
        name: the name alone.
        command: ``arg``, ``find``, ``env`` or ``optenv`` for a substitution, else None.
    """

    path: str
    name: str
    command: str | None = None


def references(text: str) -> list[Reference]:
    """Return the references in a text without repeated paths, in the order of the text."""
    unique_references = dict.fromkeys(_find_references(text))
    return list(unique_references)


def format_value(value: Any) -> str:
    """Return a value in Python notation, truncated if it is long."""
    from linkwright.xacro.expressions import sandbox
    from linkwright.xacro.expressions.bounded import RefusalError

    try:
        text = repr(value) if isinstance(value, str) else sandbox.as_text(value)
    except (RefusalError, ValueError):
        text = f"a {type(value).__name__}"
    return text if len(text) <= _MAX_SHOWN_LENGTH else f"{text[: _MAX_SHOWN_LENGTH - 3]}..."


def written_attribute(element: Any, name: str) -> str | None:
    """Return the unevaluated value of an attribute, or None if it is not in the source."""
    source = element.source
    if source is None:
        return None
    value_range = attribute_value_range(source.text, element.offset, name)
    return source.text[value_range[0] : value_range[1]] if value_range else None


def _find_references(text: str) -> Iterator[Reference]:
    try:
        tokens = tokenize(text)
    except Fault:
        return
    for kind, content, _, _ in tokens:
        if kind is TokenKind.TEXT:
            continue
        if "$" in content:
            yield from _find_references(content)
        if kind is TokenKind.SUBSTITUTION:
            yield from _find_in_substitution(content)
        else:
            yield from _find_in_expression(content)


def _find_in_substitution(content: str) -> Iterator[Reference]:
    words = content.split()
    if len(words) >= 2 and words[0] in ("arg", "find", "env", "optenv"):
        yield Reference(f"$({content})", words[1], words[0])


def _find_in_expression(content: str) -> Iterator[Reference]:
    paths = _PathCollector()
    try:
        paths.visit(ast.parse(content.strip(), mode="eval"))
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return
    yield from (reference for reference in paths.references if reference.name not in paths.bound)


class _PathCollector(ast.NodeVisitor):
    """A visitor that collects names with their attributes and keys, such as ``arm.joints[0]``.

    Variables of lambdas and comprehensions are collected in `bound`.
    """

    def __init__(self) -> None:
        self.references: list[Reference] = []
        self.bound: set[str] = set()

    def visit(self, node: ast.AST) -> None:
        if isinstance(node, ast.arg) or (isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)):
            self.bound.add(node.arg if isinstance(node, ast.arg) else node.id)
            return
        name = _root_name(node)
        if name is not None:
            self.references.append(Reference(ast.unparse(node), name))
            for descendant in ast.walk(node):
                if isinstance(descendant, ast.Subscript):
                    self.visit(descendant.slice)
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
            for descendant in (
                node.func.value,
                *node.args,
                *node.keywords,
            ):  # show the object and arguments, not the method
                self.visit(descendant)
        else:
            self.generic_visit(node)


def _root_name(node: ast.AST) -> str | None:
    """Return the first name of an expression such as ``arm.joints[0]``, or None for any other."""
    while True:
        if isinstance(node, ast.Name):
            return node.id
        if isinstance(node, ast.Attribute) or (
            isinstance(node, ast.Subscript) and isinstance(node.slice, (ast.Constant, ast.Name))
        ):
            node = node.value
        else:
            return None
