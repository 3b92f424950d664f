"""Find the ranges of parameters that Python sources declare with a description."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from linkwright.packages.readers.python_values import PythonFile, argument_of, called_name
from linkwright.review.sources.names import Detail

_RANGES = ("floating_point_range", "integer_range")
_LIMITS = ((Detail.MINIMUM, "from_value"), (Detail.MAXIMUM, "to_value"))
_DESCRIPTOR = "ParameterDescriptor"
_NUMBER = re.compile(r"-?\d+(?:\.\d*)?(?:e[-+]?\d+)?")
_RANGE_TYPES = frozenset({"FloatingPointRange", "IntegerRange"})


class PythonRanges:
    """The ranges in descriptions of parameters.

    Args:
        python: the parsed file.
    """

    def __init__(self, python: PythonFile) -> None:
        self._python = python

    def find(self, descriptor: ast.expr | None, line: int) -> Iterator[tuple[Detail, str]]:
        """Yield the limits of a parameter whose declaration gets a description.

        Args:
            descriptor: the expression for the description; None if there is none.
            line: the line of the declaration.
        """
        scope = [] if descriptor is None else self._list_assignments(line)
        given = None if descriptor is None else self._find_range(descriptor, scope)
        for detail, field in _LIMITS if given is not None else ():
            limit = self._find_field(given, field, scope)
            if limit is not None:
                yield detail, self._format(limit)

    def _list_assignments(self, line: int) -> list[tuple[ast.expr, ast.expr]]:
        """Return the targets and values of the assignments of a function before a line, the last one first.

        An item that ``append`` adds to a list is a value of it.
        """
        functions = [
            node
            for node in ast.walk(self._python.tree)
            if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef))
            and node.lineno <= line <= (node.end_lineno or node.lineno)
        ]
        own: ast.AST = max(functions, key=lambda node: node.lineno) if functions else self._python.tree
        found: list[tuple[int, ast.expr, ast.expr]] = []
        for node in ast.walk(own):
            if isinstance(node, ast.Assign) and node.lineno < line:
                found += ((node.lineno, target, node.value) for target in node.targets)
            elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
                is_addition = node.func.attr == "append" and bool(node.args) and node.lineno < line
                found += [(node.lineno, node.func.value, node.args[0])] if is_addition else []
        return [(target, value) for _, target, value in sorted(found, key=lambda item: -item[0])]

    def _find_range(self, descriptor: ast.expr, scope: list[tuple[ast.expr, ast.expr]]) -> ast.expr | None:
        """Return the expression for the range in a description, or None."""
        name = ast.unparse(descriptor)
        for target, value in scope:
            text = ast.unparse(target)
            if any(text == f"{name}.{field}" for field in _RANGES):
                return self._find_first(value)
            if text == name:
                return self._read_descriptor(value)
        return self._read_descriptor(self._python.resolved(descriptor))

    def _read_descriptor(self, node: ast.expr) -> ast.expr | None:
        if not isinstance(node, ast.Call) or called_name(node).rpartition(".")[2] != _DESCRIPTOR:
            return None
        values = (argument_of(node, field) for field in _RANGES)
        given = next((value for value in values if value is not None), None)
        return None if given is None else self._find_first(given)

    def _find_first(self, node: ast.expr) -> ast.expr | None:
        """Return the only item of a list, or an item of its own."""
        resolved = self._python.resolved(node)
        if isinstance(resolved, (ast.List, ast.Tuple)):
            return resolved.elts[0] if len(resolved.elts) == 1 else None
        return node

    def _find_field(
        self, given: ast.expr | None, field: str, scope: list[tuple[ast.expr, ast.expr]]
    ) -> ast.expr | None:
        """Return the expression for a limit of a range, or None."""
        if given is None:
            return None
        name = ast.unparse(given)
        for target, value in scope:
            text = ast.unparse(target)
            if text == f"{name}.{field}":
                return value
            if text == name:
                return self._read_limit(value, field)
        return self._read_limit(self._python.resolved(given), field)

    @staticmethod
    def _read_limit(node: ast.expr, field: str) -> ast.expr | None:
        is_range = isinstance(node, ast.Call) and called_name(node).rpartition(".")[2] in _RANGE_TYPES
        return argument_of(node, field) if is_range and isinstance(node, ast.Call) else None

    def _format(self, node: ast.expr) -> str:
        """Return a number, or another expression as it is written."""
        text = ast.unparse(self._python.resolved(node))
        return text if _NUMBER.fullmatch(text) else ast.unparse(node)
