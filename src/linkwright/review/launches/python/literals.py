"""Find the literals, passed to functions and loops, that appear in launch actions."""

from __future__ import annotations

import ast
from collections.abc import Collection, Iterable
from copy import copy

from linkwright.packages.readers.python_values import PythonFile, called_name
from linkwright.review.launches.outlines import Entry

_MAX_DEPTH = 20
_VIEW_METHODS = ("items", "keys", "values")
"""The methods of dictionaries whose results loops use."""
LOOP_FUNCTIONS = ("enumerate", "zip")
"""The functions whose results loops use."""
_LITERAL_NODES = (ast.Constant, ast.JoinedStr, ast.BinOp, ast.UnaryOp)


class Literals:
    """The literals that loops and functions of the repository receive.

    A literal that appears in no action, such as a flag or a dictionary item that only an ``if`` statement reads,
    remains part of the other code. To find these, the file is read once more with a mark in place of each literal.

    Args:
        python: the parsed file.
        marks_keys: whether to also mark the keys of dictionaries. The code cannot look up marked keys.
    """

    def __init__(self, python: PythonFile, *, marks_keys: bool) -> None:
        self._python = python
        self._marks_keys = marks_keys
        self._copies: dict[int, tuple[ast.expr, ast.expr]] = {}

    def mark_literals(self, node: ast.expr) -> ast.expr:
        """Return an expression with marks in place of its literals."""
        return self._mark_literals(node, 0)

    def find_shown_literals(self, entries: Iterable[Entry]) -> set[int]:
        """Return the identities (`id`) of the literals whose marks appear in actions."""
        texts = [text for entry in entries for text in (entry.name, *entry.settings, *entry.settings.values())]
        joined_texts = "\n".join(texts)
        return {key for key in self._copies if _make_mark(key) in joined_texts}

    def _mark_literals(self, node: ast.expr, depth: int) -> ast.expr:
        known = self._copies.get(id(node))
        if known is None:
            known = self._copies[id(node)] = node, self._copy_with_marks(node, depth + 1)
        return known[1]

    def _copy_with_marks(self, node: ast.expr, depth: int) -> ast.expr:
        """Return a copy of an expression with marks in place of its literals."""
        container = _find_container(self._python, node)
        if depth > _MAX_DEPTH or (container is None and not _is_literal(self._python, node)):
            return node
        if container is None:
            return ast.copy_location(ast.Constant(_make_mark(id(node))), node)
        changed = copy(container)
        if isinstance(changed, ast.Dict):
            changed.values = [self._mark_literals(value, depth) for value in changed.values]
            if self._marks_keys:
                changed.keys = [None if key is None else self._mark_literals(key, depth) for key in changed.keys]
        elif isinstance(changed, (ast.List, ast.Tuple)):
            changed.elts = [self._mark_literals(item, depth) for item in changed.elts]
        elif isinstance(changed, ast.Call) and isinstance(changed.func, ast.Attribute):
            changed.func = copy(changed.func)
            changed.func.value = self._mark_literals(changed.func.value, depth)
        elif isinstance(changed, ast.Call):
            changed.args = [self._mark_literals(argument, depth) for argument in changed.args]
        return changed


class CoveredLiterals:
    """The parts of function arguments and loop iterables that appear in actions.

    Args:
        python: the parsed file.
        shown: the identities (`id`) of the literals that appear in actions.
        shown_keys: the identities of the dictionary keys that appear in actions.

    Attributes:
        covered: the identities of the parts that belong to actions.
    """

    def __init__(self, python: PythonFile, shown: Collection[int], shown_keys: Collection[int]) -> None:
        self._python = python
        self._shown = shown
        self._shown_keys = shown_keys
        self._known: dict[int, bool] = {}
        self.covered: set[int] = set()

    def add_call(self, call: ast.Call) -> None:
        """Add the arguments of a function, and its call if all of them appear in actions."""
        arguments = [self.add(argument) for argument in call.args]
        for keyword in call.keywords:
            is_covered = self.add(keyword.value)
            arguments.append(is_covered)
            if is_covered:
                self.covered.add(id(keyword))
        if all(arguments):
            self.covered.add(id(call))

    def add(self, node: ast.expr) -> bool:
        """Add the parts of an expression, and return whether all of them appear in actions."""
        known = self._known.get(id(node))
        if known is None:
            self._known[id(node)] = True  # a name that is defined by itself
            known = self._known[id(node)] = self._add(node)
            if known:
                self.covered.add(id(node))
        return known

    def _add(self, node: ast.expr) -> bool:
        container = _find_container(self._python, node)
        if isinstance(container, ast.Dict):
            items = [self._add_item(*item) for item in zip(container.keys, container.values, strict=True)]
            return all(items)
        if isinstance(container, (ast.List, ast.Tuple)):
            items = [self.add(item) for item in container.elts]
            return all(items)
        if isinstance(container, ast.Call) and isinstance(container.func, ast.Attribute):
            return self.add(container.func.value)
        if isinstance(container, ast.Call):
            items = [self.add(argument) for argument in container.args]
            return all(items)
        return not _is_literal(self._python, node) or id(node) in self._shown

    def _add_item(self, key: ast.expr | None, value: ast.expr) -> bool:
        """Add an item of a dictionary, and return whether all of it appears in actions.

        If the value appears in no action, its key is also part of the other code.
        """
        is_covered = self.add(value)
        if is_covered and key is not None and (id(key) in self._shown_keys or not _is_literal(self._python, key)):
            self.covered.add(id(key))
            return True
        return is_covered and key is None


def _find_container(python: PythonFile, node: ast.expr) -> ast.expr | None:
    """Return the container of an expression, or None if it has none.

    A container is a dictionary, a list, a dictionary view, or a call of ``enumerate`` or ``zip``.
    """
    node = python.resolved(node)
    if isinstance(node, ast.Call):
        is_view = isinstance(node.func, ast.Attribute) and node.func.attr in _VIEW_METHODS and not node.args
        return node if is_view or called_name(node) in LOOP_FUNCTIONS else None
    return node if isinstance(node, (ast.Dict, ast.List, ast.Tuple)) else None


def _is_literal(python: PythonFile, node: ast.expr) -> bool:
    value = python.resolved(node)
    return isinstance(value, _LITERAL_NODES) and not (isinstance(value, ast.Constant) and value.value is None)


def _make_mark(key: int) -> str:
    return f"\x01{key}\x01"
