"""Put dictionaries in place of the objects of the repository's own classes of dictionaries in a launch file."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence
from copy import deepcopy

from linkwright.packages.readers.python_values import PythonFile, called_name
from linkwright.review.launches.python.helpers import HelperFunctions
from linkwright.review.launches.python.imported_values import inline_values
from linkwright.review.launches.python.names import LaunchPythonFile

_MAX_DEPTH = 5
"""The maximum number of methods that call each other."""
_ITEM_METHODS = frozenset({"__setitem__", "setdefault"})
_READING_METHODS = frozenset({"copy", "get", "items", "keys", "values"})
_Items = dict[str, tuple[ast.expr, ast.expr]]
"""The key and the value of each item, by the text of the key."""


class _UnknownItemsError(Exception):
    """A statement with an unknown effect on the items of a dictionary."""


def expand_dictionary_classes(python: LaunchPythonFile, helpers: HelperFunctions) -> LaunchPythonFile:
    """Return a launch file with a dictionary in place of each object of a class derived from ``dict``.

    The dictionary has the items that the statements after the construction of the object put into it. These statements
    are left out. An object stays if a statement has an unknown effect on it.
    """
    for body in _find_bodies(python.tree):
        for statement in list(body):
            target = statement.targets[0] if isinstance(statement, ast.Assign) and len(statement.targets) == 1 else None
            if not isinstance(statement, ast.Assign) or not isinstance(target, ast.Name):
                continue
            found = _find_class(python, statement.value, helpers)
            if found is not None:
                _expand(body, statement, target.id, _DictionaryClass(*found, helpers))
    return python


def _find_bodies(tree: ast.Module) -> Iterator[list[ast.stmt]]:
    """Yield the statements of the file and of each of its functions."""
    yield tree.body
    yield from (node.body for node in ast.walk(tree) if isinstance(node, ast.FunctionDef))


def _find_class(python: PythonFile, node: ast.expr, helpers: HelperFunctions) -> tuple[PythonFile, ast.ClassDef] | None:
    """Return the class of a constructed dictionary of the repository, with its file, or None."""
    name = called_name(node) if isinstance(node, ast.Call) else ""
    found = helpers.find_class(python, name) if name.isidentifier() else None
    if found is None or not any(_is_name(base, "dict") for base in found[1].bases):
        return None
    return (LaunchPythonFile(python.source), found[1]) if found[0] is python else found  # the file changes


def _expand(body: list[ast.stmt], assignment: ast.Assign, name: str, dictionary: _DictionaryClass) -> None:
    """Replace an object by a dictionary with its items, if they are known."""
    call = assignment.value
    calls = [
        statement
        for statement in body[body.index(assignment) + 1 :]
        if isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Call)
        if called_name(statement.value).startswith(f"{name}.")
    ]
    known = {id(node) for statement in calls for node in ast.walk(statement)}
    others = (node for statement in body if statement is not assignment for node in ast.walk(statement))
    if not isinstance(call, ast.Call) or any(id(node) not in known and _changes(node, name) for node in others):
        return
    items: _Items = {}
    try:
        dictionary.construct(call, items)
        for statement in calls:
            method = called_name(statement.value).partition(".")[2] if isinstance(statement.value, ast.Call) else ""
            if isinstance(statement.value, ast.Call):
                dictionary.call(method, statement.value, {}, items)
    except _UnknownItemsError:
        return
    keys: list[ast.expr | None] = [key for key, _ in items.values()]
    assignment.value = ast.Dict(keys, [value for _, value in items.values()])
    for node in ast.walk(assignment.value):
        if isinstance(node, (ast.expr, ast.keyword)):
            ast.copy_location(node, call)
    body[:] = [statement for statement in body if all(statement is not other for other in calls)]


def _changes(node: ast.AST, name: str) -> bool:
    """Return whether a node may change the items of an object, or gives its name another value."""
    if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
        return node.id == name
    if isinstance(node, ast.Subscript) and isinstance(node.ctx, ast.Store):
        return _is_name(node.value, name)
    if not isinstance(node, ast.Call) or not isinstance(node.func, ast.Attribute):
        return False
    return _is_name(node.func.value, name) and node.func.attr not in _READING_METHODS


class _DictionaryClass:
    """A class derived from ``dict``.

    Args:
        python: the file that defines it.
        node: its definition.
        helpers: the modules of the repository.
    """

    def __init__(self, python: PythonFile, node: ast.ClassDef, helpers: HelperFunctions) -> None:
        self._python = python
        self._helpers = helpers
        self._methods = {item.name: item for item in node.body if isinstance(item, ast.FunctionDef)}

    def construct(self, call: ast.Call, items: _Items) -> None:
        """Add the items of a new object."""
        if "__init__" in self._methods:
            self.call("__init__", call, {}, items)
        else:
            self._update(call, {}, items)

    def call(self, method: str, call: ast.Call, values: Mapping[str, ast.expr], items: _Items, depth: int = 0) -> None:
        """Add the items that a call of a method puts into the dictionary.

        Raises:
            _UnknownItemsError: they are unknown.
        """
        arguments = [self._substitute(argument, values) for argument in call.args]
        if method not in self._methods:
            self._call_of_dict(method, call, values, items)
            return
        function = self._methods[method]
        names = [argument.arg for argument in function.args.args[1:]]
        if depth > _MAX_DEPTH or any(keyword.arg not in names for keyword in call.keywords):
            raise _UnknownItemsError
        if len(arguments) > len(names) or any(isinstance(argument, ast.Starred) for argument in arguments):
            raise _UnknownItemsError
        defaults = function.args.defaults
        bound = dict(zip(names[len(names) - len(defaults) :], defaults, strict=False))
        bound |= dict(zip(names, arguments, strict=False))
        bound |= {keyword.arg or "": self._substitute(keyword.value, values) for keyword in call.keywords}
        self._run(function.body, bound, items, depth)

    def _call_of_dict(self, method: str, call: ast.Call, values: Mapping[str, ast.expr], items: _Items) -> None:
        if method in _ITEM_METHODS and len(call.args) == 2:
            self._set(*(self._substitute(argument, values) for argument in call.args), items=items)
        elif method in ("update", "__init__"):
            self._update(call, values, items)
        else:
            raise _UnknownItemsError

    def _update(self, call: ast.Call, values: Mapping[str, ast.expr], items: _Items) -> None:
        for argument in call.args:
            node = self._substitute(argument, values)
            if not isinstance(node, ast.Dict):
                raise _UnknownItemsError
            for key, value in zip(node.keys, node.values, strict=True):
                if key is None:
                    raise _UnknownItemsError
                self._set(key, value, items=items)
        for keyword in call.keywords:
            if keyword.arg is None:
                raise _UnknownItemsError
            self._set(ast.Constant(keyword.arg), self._substitute(keyword.value, values), items=items)

    def _set(self, key: ast.expr, value: ast.expr, *, items: _Items) -> None:
        items[ast.unparse(key)] = deepcopy(key), deepcopy(value)

    def _run(self, body: Sequence[ast.stmt], values: dict[str, ast.expr], items: _Items, depth: int) -> None:
        for statement in body:
            if isinstance(statement, ast.Pass) or (isinstance(statement, ast.Return) and _returns_itself(statement)):
                continue
            if isinstance(statement, ast.If):
                branch = statement.body if _is_instance(statement.test, values) else statement.orelse
                self._run(branch, values, items, depth)
            elif isinstance(statement, ast.For) and isinstance(statement.target, ast.Name):
                iterable = self._substitute(statement.iter, values)
                if not isinstance(iterable, (ast.List, ast.Tuple, ast.Set)):
                    raise _UnknownItemsError
                for item in iterable.elts:
                    self._run(statement.body, {**values, statement.target.id: item}, items, depth)
            elif isinstance(statement, ast.Assign) and len(statement.targets) == 1:
                self._assign(statement.targets[0], self._substitute(statement.value, values), values, items)
            elif isinstance(statement, ast.Expr):
                self._run_expression(statement.value, values, items, depth)
            else:
                raise _UnknownItemsError

    def _assign(self, target: ast.expr, value: ast.expr, values: dict[str, ast.expr], items: _Items) -> None:
        if isinstance(target, ast.Name):
            values[target.id] = value
        elif isinstance(target, ast.Subscript) and _is_name(target.value, "self"):
            self._set(self._substitute(target.slice, values), value, items=items)
        else:
            raise _UnknownItemsError

    def _run_expression(self, node: ast.expr, values: Mapping[str, ast.expr], items: _Items, depth: int) -> None:
        if isinstance(node, ast.Constant):
            return  # a docstring
        if not isinstance(node, ast.Call) or not isinstance(node.func, ast.Attribute):
            raise _UnknownItemsError
        owner = node.func.value
        if _is_name(owner, "self"):
            self.call(node.func.attr, node, values, items, depth + 1)
        elif isinstance(owner, ast.Call) and _is_name(owner.func, "super"):
            self._call_of_dict(node.func.attr, node, values, items)
        else:
            raise _UnknownItemsError

    def _substitute(self, node: ast.expr, values: Mapping[str, ast.expr]) -> ast.expr:
        """Return an expression with the values of local names and of the names of the module."""
        return inline_values(node, self._python, self._helpers, values)


def _is_name(node: ast.expr, name: str) -> bool:
    return isinstance(node, ast.Name) and node.id == name


def _returns_itself(statement: ast.Return) -> bool:
    return statement.value is None or _is_name(statement.value, "self")


def _is_instance(test: ast.expr, values: Mapping[str, ast.expr]) -> bool:
    """Return whether a local name has the type of a test such as ``isinstance(name, str)``."""
    if isinstance(test, ast.Call) and called_name(test) == "isinstance" and len(test.args) == 2:
        value = values.get(test.args[0].id) if isinstance(test.args[0], ast.Name) else None
        type_name = ast.unparse(test.args[1])
        if type_name == "str" and isinstance(value, ast.Constant):
            return isinstance(value.value, str)
        if type_name == "str" and isinstance(value, (ast.List, ast.Tuple, ast.Set, ast.Dict)):
            return False
    raise _UnknownItemsError
