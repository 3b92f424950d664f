"""Evaluation of Python expressions to texts, lists and mappings.

Placeholders represent values with several possibilities.
"""

from __future__ import annotations

import ast
from collections.abc import Mapping, Sequence

from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import dataclass, field
from linkwright.loading.lean_typing import Union
from linkwright.packages.readers.python_values import argument_of, called_name
from linkwright.packages.readers.xacro_calls.call import CallingFile, launch_argument
from linkwright.packages.readers.xacro_calls.python_scopes import Binding, Scope, defaults, parameters
from linkwright.packages.readers.xacro_calls.texts import (
    UNKNOWN,
    Choice,
    Open,
    Share,
    Text,
    joined,
    joined_path,
    literal,
)

_DEEPEST = 30
_MOST_PIECES = 100
"""A text of more pieces is not followed."""
_JOINS = frozenset({"join", "Path", "PurePath", "joinpath", "PathJoinSubstitution"})
_SHARES = frozenset({"get_package_share_directory", "get_package_share_path", "FindPackageShare"})
_PASSING = frozenset(
    {
        *("str", "open", "parse", "normpath", "abspath", "realpath", "expanduser", "fspath", "which", "FindExecutable"),
        *("TextSubstitution", "ParameterValue", "list", "tuple", "sorted", "set"),
    }
)
"""Functions that return their argument, or an equivalent of it."""
_METHODS = frozenset({"perform", "as_posix", "find", "strip", "resolve", "absolute", "items", "copy", "lower"})
"""Methods that return their object, or an equivalent of it."""
_FIELD = lazy_pattern(r"\{(\w*)\}")


@dataclass(frozen=True, slots=True)
class Items:
    """A list, a tuple, or a set."""

    values: tuple[Value, ...]


@dataclass(frozen=True, slots=True)
class Entries:
    """A mapping with texts as keys."""

    values: Mapping[str, Value]


Value = Union[Text, Items, Entries]  # noqa: UP007 - as for `Text`
_OPEN: Text = (UNKNOWN,)
UNKNOWN_ENTRIES: Mapping[str, Value] = {"": _OPEN}
"""The entries that a mapping may have in addition to those in this file."""


@dataclass(eq=False)
class PythonTexts:
    """An evaluator of expressions in a Python file.

    Args:
        file: the record that receives the choices.
        calls: name -> the calls of the functions of this file, with their scopes.
    """

    file: CallingFile
    calls: Mapping[str, Sequence[tuple[ast.Call, Scope]]]
    _depth: int = 0
    _names: dict[tuple[int, str], Value] = field(default_factory=dict)

    def value(self, node: ast.expr | None, scope: Scope) -> Value:
        """Return the value of an expression, or a placeholder if the value is not known."""
        if node is None or self._depth > _DEEPEST:
            return _OPEN
        self._depth += 1
        try:
            return self._value(node, scope)
        finally:
            self._depth -= 1

    def text(self, node: ast.expr | None, scope: Scope) -> Text:
        """Return the text of an expression; the texts of several items are concatenated."""
        return _as_text(self.value(node, scope))

    def _value(self, node: ast.expr, scope: Scope) -> Value:
        if isinstance(node, ast.Constant):
            return literal(str(node.value)) if isinstance(node.value, (str, int, float)) else _OPEN
        if isinstance(node, ast.Name):
            return self._name(node.id, scope)
        if isinstance(node, (ast.List, ast.Tuple, ast.Set)):
            return Items(tuple(self._items(node.elts, scope)))
        if isinstance(node, ast.Dict):
            return self._entries(node, scope)
        if isinstance(node, ast.JoinedStr):
            return joined(self.text(piece, scope) for piece in node.values)
        if isinstance(node, ast.FormattedValue):
            return self.text(node.value, scope) if node.conversion == -1 and node.format_spec is None else _OPEN
        if isinstance(node, ast.BinOp):
            return self._operation(node, scope)
        if isinstance(node, ast.IfExp):
            return self._one_of(node, [self.value(node.body, scope), self.value(node.orelse, scope)])
        if isinstance(node, ast.BoolOp):
            return self.value(node.values[0], scope)
        if isinstance(node, ast.Subscript):
            return self._item(node, scope)
        if isinstance(node, ast.Call):
            return self._call(node, scope)
        return _OPEN

    def _items(self, nodes: Sequence[ast.expr], scope: Scope) -> list[Value]:
        found: list[Value] = []
        for node in nodes:
            if isinstance(node, ast.Starred):
                inner = self.value(node.value, scope)
                found += inner.values if isinstance(inner, Items) else [_as_text(inner)]
            else:
                found.append(self.value(node, scope))
        return found

    def _entries(self, node: ast.Dict, scope: Scope) -> Value:
        found: dict[str, Value] = {}
        for key, value in zip(node.keys, node.values, strict=True):
            inner = self.value(value, scope)
            if key is None:
                found.update(_entries_of(inner))
            elif name := _plain(self.text(key, scope)):
                found[name] = inner
            else:
                found.update(UNKNOWN_ENTRIES)
        return Entries(found)

    def _operation(self, node: ast.BinOp, scope: Scope) -> Value:
        left, right = self.value(node.left, scope), self.value(node.right, scope)
        if isinstance(node.op, ast.Div):
            return joined_path([_as_text(left), _as_text(right)])
        if isinstance(node.op, (ast.Add, ast.BitOr)):
            return _sum(left, right)
        if isinstance(node.op, ast.Mod) and (pattern := _plain(_as_text(left))):
            texts = [*map(_as_text, right.values)] if isinstance(right, Items) else [_as_text(right)]
            parts = pattern.split("%s")
            if len(parts) == len(texts) + 1 and "%" not in "".join(parts):
                return _filled(parts, texts)
        return _OPEN

    def _item(self, node: ast.Subscript, scope: Scope) -> Value:
        if isinstance(node.value, ast.Attribute) and node.value.attr == "launch_configurations":
            return self._launch_argument(node.slice, None, scope)
        owner = self.value(node.value, scope)
        if isinstance(owner, Entries):
            return owner.values.get(_plain(self.text(node.slice, scope)) or "", _OPEN)
        if isinstance(owner, Items) and isinstance(node.slice, ast.Constant) and isinstance(node.slice.value, int):
            return owner.values[node.slice.value] if abs(node.slice.value) < len(owner.values) else _OPEN
        return _OPEN

    def _get_call_value(self, owner: ast.expr, node: ast.Call, scope: Scope) -> Value:
        """Return the value of ``mapping.get(key, default)``.

        The default is returned only if the mapping is known and does not contain the key.
        """
        key, default = (*node.args, None)[:2] if node.args else (None, None)
        if isinstance(owner, ast.Attribute) and owner.attr == "launch_configurations":
            return self._launch_argument(key, default, scope)
        mapping = self.value(owner, scope)
        if not isinstance(mapping, Entries):
            return _OPEN
        name = _plain(self.text(key, scope)) or ""
        if name in mapping.values or not name or "" in mapping.values:
            return mapping.values.get(name, _OPEN)
        return self.value(default, scope)

    # --- calls ------------------------------------------------------------------------------------------------

    def _call(self, node: ast.Call, scope: Scope) -> Value:
        name = called_name(node).rpartition(".")[2]
        owner = node.func.value if isinstance(node.func, ast.Attribute) else None
        first = node.args[0] if node.args else next((keyword.value for keyword in node.keywords), None)
        if name in ("LaunchConfiguration", "LaunchConfigurationEquals"):
            return self._launch_argument(first, argument_of(node, "default"), scope)
        if name in _SHARES:
            return (Share(self.text(first, scope)),)
        if name in _JOINS:
            return self._joined_path(node, name, owner, scope)
        if name == "get" and owner is not None and first is not None and "environ" not in ast.unparse(owner):
            return self._get_call_value(owner, node, scope)
        if (name in ("getenv", "get") and len(node.args) == 2) or name == "EnvironmentVariable":
            default = argument_of(node, "default_value") or (node.args[1] if len(node.args) > 1 else None)
            return self.value(default, scope)
        if name == "format" and owner is not None:
            return self._formatted(owner, node, scope)
        if name == "dict" and not node.args:
            return Entries({keyword.arg: self.value(keyword.value, scope) for keyword in node.keywords if keyword.arg})
        if name == "product":
            return Items((Items(tuple(self._any_of(arg, scope) for arg in node.args)),))
        if name in _METHODS and owner is not None:
            return self.value(owner, scope)
        if name in _PASSING and first is not None:
            return self.value(first, scope)
        return _OPEN

    def _launch_argument(self, name: ast.expr | None, default: ast.expr | None, scope: Scope) -> Text:
        plain = _plain(self.text(name, scope))
        if plain is None:
            return _OPEN
        if default is not None:
            self.file.declare(plain, self.text(default, scope))
        return (launch_argument(plain),)

    def _joined_path(self, node: ast.Call, name: str, owner: ast.expr | None, scope: Scope) -> Value:
        parts = self._items(node.args, scope)
        if name == "PathJoinSubstitution":
            inside = parts[0] if parts else None
            parts = list(inside.values) if isinstance(inside, Items) else []
        elif name == "joinpath" and owner is not None:
            parts = [self.value(owner, scope), *parts]
        elif name == "join" and isinstance(owner, ast.Constant):
            return _OPEN
        return joined_path([_as_text(part) for part in parts])

    def _formatted(self, owner: ast.expr, node: ast.Call, scope: Scope) -> Value:
        pattern = _plain(self.text(owner, scope))
        if pattern is None:
            return _OPEN
        named = {keyword.arg: self.text(keyword.value, scope) for keyword in node.keywords if keyword.arg}
        texts = [self.text(arg, scope) for arg in node.args]
        parts = _FIELD.split(pattern)
        if "{" in "".join(parts[::2]):
            return _OPEN
        filled: list[Text] = []
        for index, key in enumerate(parts[1::2]):
            at = int(key) if key.isdigit() else index
            filled.append(named.get(key, _OPEN) if key and not key.isdigit() else (texts + [_OPEN] * (at + 1))[at])
        return _filled(parts[::2], filled)

    # --- names ------------------------------------------------------------------------------------------------

    def _name(self, name: str, scope: Scope) -> Value:
        found = scope.find(name)
        if found is None:
            return _OPEN
        home, bindings = found
        key = (id(home), name)
        if key not in self._names:
            self._names[key] = _OPEN  # breaks the recursion for a name that depends on itself
            value = self._value_of_name(name, home, bindings)
            self._names[key] = _OPEN if isinstance(value, tuple) and len(value) > _MOST_PIECES else value
        return self._names[key]

    def _value_of_name(self, name: str, home: Scope, bindings: Sequence[Binding]) -> Value:
        if not bindings and home.function is not None:
            return self._parameter(name, home)
        values = [self._bound(binding, home) for binding in bindings if not binding.is_added]
        value = values[0] if len(values) == 1 else self._one_of(bindings[0].value, values)
        for binding in bindings:
            if binding.is_added:
                value = _sum(value, self._bound(binding, home))
        if isinstance(value, Entries) and name in home.entries:
            more = {_plain(self.text(key, home)) or "": self.value(item, home) for key, item in home.entries[name]}
            value = Entries({**value.values, **more, **(UNKNOWN_ENTRIES if "" in more else {})})
        return value

    def _bound(self, binding: Binding, scope: Scope) -> Value:
        value = self._any_of(binding.value, scope) if binding.is_item else self.value(binding.value, scope)
        for index in binding.path:
            value = value.values[index] if isinstance(value, Items) and index < len(value.values) else _OPEN
        return value

    def _any_of(self, node: ast.expr | None, scope: Scope) -> Value:
        """Return a value that represents any item of an iterable expression."""
        value = self.value(node, scope)
        if not isinstance(value, Items):
            return _OPEN
        return value.values[0] if len(value.values) == 1 else self._rows_of(node, value.values, is_certain=True)

    def _one_of(self, node: ast.expr | None, values: Sequence[Value]) -> Value:
        """Return a value that represents one of several values under unknown conditions."""
        lasting = [value for value in values if value != _OPEN]
        if len(lasting) < 2 or not all(isinstance(item, tuple) for item in lasting):
            return lasting[0] if lasting else _OPEN
        return self._rows_of(node, lasting, is_certain=False)

    def _rows_of(self, node: ast.expr | None, values: Sequence[Value], *, is_certain: bool) -> Value:
        """Return a placeholder for one of several values.

        For lists of equal length, the result is a list of placeholders.
        """
        name = "unknown" if node is None else f"at:{node.lineno}:{node.col_offset}"
        width = {len(value.values) if isinstance(value, Items) else 0 for value in values}
        if len(width) != 1:
            return _OPEN
        columns = width.pop()
        rows = [
            tuple(map(_as_text, value.values)) if isinstance(value, Items) else (_as_text(value),) for value in values
        ]
        self.file.choices[name] = Choice(tuple(dict.fromkeys(rows)), is_certain)
        return Items(tuple((Open(name, column),) for column in range(columns))) if columns else (Open(name),)

    def _parameter(self, name: str, scope: Scope) -> Value:
        """Return the value of a function's parameter, from pytest or from calls in the same file."""
        function = scope.function
        assert function is not None
        outer = scope.around or scope
        for decorator in function.decorator_list:
            if isinstance(decorator, ast.Call) and called_name(decorator).endswith("parametrize") and decorator.args:
                names = self._parametrized_names(decorator.args[0], outer)
                if name in names and len(decorator.args) > 1:
                    value = self._any_of(decorator.args[1], outer)
                    if len(names) == 1:
                        return value
                    return value.values[names.index(name)] if isinstance(value, Items) else _OPEN
        default = dict(defaults(function)).get(name)
        values: list[Value] = []
        for call, calling in self.calls.get(function.name, ()):
            positions = parameters(function)
            at = positions.index(name) if name in positions else len(call.args)
            written = argument_of(call, name) or (call.args[at] if at < len(call.args) else default)
            values.append(self.value(written, calling))
        if not values:  # all callers are in other files
            value = self.value(default, outer)
            return Entries({**value.values, **UNKNOWN_ENTRIES}) if isinstance(value, Entries) else value
        return values[0] if len(values) == 1 else self._one_of(call, values)

    def _parametrized_names(self, node: ast.expr, scope: Scope) -> list[str]:
        value = self.value(node, scope)
        if isinstance(value, Items):
            return [_plain(_as_text(item)) or "" for item in value.values]
        return [word.strip() for word in (_plain(_as_text(value)) or "").split(",")]


def _plain(text: Text) -> str | None:
    """Return a text as a string, or None if the text has placeholders."""
    strings = [piece for piece in text if isinstance(piece, str)]
    return "".join(strings) if len(strings) == len(text) else None


def _as_text(value: Value) -> Text:
    if isinstance(value, Items):
        return joined(_as_text(item) for item in value.values)
    return _OPEN if isinstance(value, Entries) else value


def _entries_of(value: Value) -> Mapping[str, Value]:
    return value.values if isinstance(value, Entries) else UNKNOWN_ENTRIES


def _sum(left: Value, right: Value) -> Value:
    if isinstance(left, Entries):
        return Entries({**left.values, **_entries_of(right)})
    if isinstance(left, Items) and isinstance(right, Items):
        return Items((*left.values, *right.values))
    if isinstance(left, tuple) and isinstance(right, tuple):
        return (*left, *right)
    return _OPEN


def _filled(parts: Sequence[str], texts: Sequence[Text]) -> Text:
    """Return a text with the parts of a pattern and the given texts between them."""
    result = literal(parts[0])
    for text, part in zip(texts, parts[1:], strict=True):
        result = (*result, *text, *literal(part))
    return result
