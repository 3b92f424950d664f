"""Resolve the names, attributes, constants and results of functions of a Python source."""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from itertools import product
from pathlib import Path
from typing import TypeGuard

from linkwright.diagnostics import SourceText
from linkwright.packages.readers.python_values import UNKNOWN, PythonFile, Value
from linkwright.review.sources.message_constants import read_imported_message_constants
from linkwright.review.sources.python.loops import find_iterations
from linkwright.review.sources.python.method_aliases import replace_method_aliases
from linkwright.review.sources.shared_constants import read_imported_constants

_MAX_DEPTH = 10
_MAX_TEXTS = 8
"""The maximum number of values that an expression may have."""
_PLAIN_DECORATORS = frozenset({"property", "staticmethod", "classmethod"})


class PythonSource(PythonFile):
    """A Python source that also resolves attributes which are assigned once, constants of other modules and results."""

    def __init__(self, source: SourceText) -> None:
        super().__init__(source)
        replace_method_aliases(self.tree)
        self._loop_values: Mapping[str, ast.expr] = {}

    @cached_property
    def _attributes(self) -> dict[str, ast.expr | None]:
        attributes: dict[str, ast.expr | None] = {}
        for node in ast.walk(self.tree):
            targets = node.targets if isinstance(node, ast.Assign) else ()
            for target in targets:
                for part in ast.walk(target):
                    if isinstance(part, ast.Attribute):
                        is_first = part is target and part.attr not in attributes
                        attributes[part.attr] = node.value if is_first and isinstance(node, ast.Assign) else None
            if isinstance(node, (ast.AugAssign, ast.AnnAssign)) and isinstance(node.target, ast.Attribute):
                attributes[node.target.attr] = None
        return attributes

    @cached_property
    def _imported_constants(self) -> dict[str, ast.expr]:
        path = Path(self.source.name)
        return read_imported_message_constants(path, self.tree) | read_imported_constants(path, self.tree)

    def assigned_expression(self, name: str) -> ast.expr | None:
        """Return the expression assigned to a name or imported as it, or None if it is not certain."""
        if name in self._loop_values:
            return self._loop_values[name]
        if name in self._assignments:
            return super().assigned_expression(name)
        return self._imported_constants.get(name)

    def resolved(self, node: ast.expr) -> ast.expr:
        """Return the expression assigned to a name or attribute.

        Other expressions are returned unchanged.
        """
        if isinstance(node, ast.Attribute) and ast.unparse(node) in self._imported_constants:
            return self._imported_constants[ast.unparse(node)]
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            value = self._attributes.get(node.attr)
            if node.attr not in self._attributes:
                value = self.assigned_expression(node.attr)  # a constant of the class
            is_known = not isinstance(value, ast.Attribute) or ast.unparse(value) in self._imported_constants
            return self.resolved(value) if value is not None and is_known else node
        return super().resolved(node)

    def value(self, node: ast.expr | None, depth: int = 0) -> Value:
        """Return the value of an expression, or `UNKNOWN` if the value is not certain."""
        if depth > _MAX_DEPTH:
            return UNKNOWN
        if isinstance(node, ast.Attribute):
            resolved = self.resolved(node)
            if resolved is not node:
                return super().value(resolved, depth + 1)
        result = self._find_result(node)
        return super().value(node, depth) if result is None else self.value(result, depth + 1)

    def iterate(self, node: ast.expr | None) -> Iterator[None]:
        """Yield for each iteration of the loops over constants that give an expression its text, with their variables.

        Other expressions are in one iteration.
        """
        rows = find_iterations(self.tree, node, self.resolved) if node is not None and self.text(node) is None else ()
        texts = []
        for self._loop_values in rows:
            texts.append(self.text(node))
        for self._loop_values in rows if rows and None not in texts else ({},):
            yield
        self._loop_values = {}

    def find_in_loop(self, node: ast.expr) -> ast.expr:
        """Return the value of a variable of the loop that `iterate` runs, and any other expression unchanged."""
        return self._loop_values.get(node.id, node) if isinstance(node, ast.Name) else node

    def find_texts(self, node: ast.expr, depth: int = 0) -> Sequence[str]:
        """Return all texts that an expression may have as its value; nothing if they are not certain.

        Variables may have several values, such as one in each branch of an ``if`` statement.
        """
        text = self.text(node)
        if text is not None or depth > _MAX_DEPTH:
            return () if text is None else (text,)
        if isinstance(node, ast.Name):
            return self._join_choices(self._choices.get(node.id, ()), depth)
        if isinstance(node, ast.IfExp):
            return self._join_choices([node.body, node.orelse], depth)
        parts: Sequence[ast.expr] = ()
        if isinstance(node, ast.JoinedStr):
            parts = [piece.value if _is_plain_piece(piece) else piece for piece in node.values]
        elif isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
            parts = [node.left, node.right]
        texts = [self.find_texts(part, depth + 1) for part in parts]
        found = ["".join(combination) for combination in product(*texts)] if parts else []
        return list(dict.fromkeys(found)) if len(found) <= _MAX_TEXTS else ()

    def _join_choices(self, nodes: Sequence[ast.expr], depth: int) -> Sequence[str]:
        found = [self.find_texts(node, depth + 1) for node in nodes]
        texts = list(dict.fromkeys(text for texts in found for text in texts))
        return texts if all(found) and len(texts) <= _MAX_TEXTS else ()

    @cached_property
    def _choices(self) -> dict[str, list[ast.expr]]:
        """The expressions that are assigned to variables, without variables that get a value in another way."""
        choices: dict[str, list[ast.expr]] = {}
        bound: Counter[str] = Counter()
        for node in ast.walk(self.tree):
            if isinstance(node, ast.Assign):
                for target in node.targets:
                    if isinstance(target, ast.Name):
                        choices.setdefault(target.id, []).append(node.value)
            if isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Load):
                bound[node.id] += 1
            elif isinstance(node, ast.arg):
                bound[node.arg] += 1
            elif isinstance(node, ast.alias):
                bound[node.asname or node.name] += 1
            elif isinstance(node, ast.AugAssign) and isinstance(node.target, ast.Name):
                bound[node.target.id] += 1
        return {name: values for name, values in choices.items() if bound[name] == len(values)}

    def _find_result(self, node: ast.expr | None) -> ast.expr | None:
        """Return the result of a function without arguments that only returns an expression, or None for others.

        The function is called as ``topic()`` or ``self.topic()``, or read as the property ``self.topic``.
        """
        function = node.func if isinstance(node, ast.Call) and not node.args and not node.keywords else node
        if isinstance(function, ast.Attribute) and ast.unparse(function.value) in ("self", "cls"):
            return self._results.get((function.attr, isinstance(node, ast.Call)))
        is_called = isinstance(function, ast.Name) and isinstance(node, ast.Call)
        return self._results.get((function.id, True)) if is_called and isinstance(function, ast.Name) else None

    @cached_property
    def _results(self) -> dict[tuple[str, bool], ast.expr]:
        """The results of functions that only return an expression, by name and whether they are called."""
        functions = [node for node in ast.walk(self.tree) if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef))]
        count = [node.name for node in functions].count
        results: dict[tuple[str, bool], ast.expr] = {}
        for node in functions:
            body = node.body[ast.get_docstring(node) is not None :]
            decorators = {ast.unparse(decorator) for decorator in node.decorator_list}
            returned = body[0].value if len(body) == 1 and isinstance(body[0], ast.Return) else None
            is_plain = isinstance(node, ast.FunctionDef) and decorators <= _PLAIN_DECORATORS
            if returned is not None and is_plain and count(node.name) == 1 and not self._overrides(node.name):
                results[node.name, "property" not in decorators] = returned
        return results

    def _overrides(self, name: str) -> bool:
        """Return whether the source assigns the name of a function."""
        return self._assignments.get(name) is not None or name in self._attributes


def _is_plain_piece(piece: ast.expr) -> TypeGuard[ast.FormattedValue]:
    """Return whether a piece of an f-string is an expression without a format or conversion."""
    return isinstance(piece, ast.FormattedValue) and piece.conversion == -1 and piece.format_spec is None
