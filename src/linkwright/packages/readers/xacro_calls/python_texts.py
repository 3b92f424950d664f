"""Evaluate Python expressions to texts, lists and mappings.

A placeholder represents an expression that may have several values.
"""

from __future__ import annotations

import ast
from collections.abc import Mapping, Sequence

from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import dataclass, field
from linkwright.loading.lean_typing import Union
from linkwright.packages.readers.python_values import argument_of, called_name
from linkwright.packages.readers.xacro_calls.call import CallingFile, make_launch_argument
from linkwright.packages.readers.xacro_calls.python_scopes import Binding, Scope, iterate_defaults, list_parameters
from linkwright.packages.readers.xacro_calls.texts import (
    UNKNOWN,
    Choice,
    Placeholder,
    Share,
    Text,
    join_path,
    join_texts,
    make_literal,
)

_MAX_DEPTH = 30
_MAX_PIECES = 100
"""The maximum number of pieces of a text. A longer text counts as unknown."""
_JOIN_FUNCTIONS = frozenset({"join", "Path", "PurePath", "joinpath", "PathJoinSubstitution"})
_SHARE_FUNCTIONS = frozenset({"get_package_share_directory", "get_package_share_path", "FindPackageShare"})
_IDENTITY_FUNCTIONS = frozenset(
    {
        *("str", "open", "parse", "normpath", "abspath", "realpath", "expanduser", "fspath", "which", "FindExecutable"),
        *("TextSubstitution", "ParameterValue", "list", "tuple", "sorted", "set"),
    }
)
"""Functions that return their argument, or an equivalent of it."""
_IDENTITY_METHODS = frozenset({"perform", "as_posix", "find", "strip", "resolve", "absolute", "items", "copy", "lower"})
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
_UNKNOWN_TEXT: Text = (UNKNOWN,)
UNKNOWN_ENTRIES: Mapping[str, Value] = {"": _UNKNOWN_TEXT}
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
        if node is None or self._depth > _MAX_DEPTH:
            return _UNKNOWN_TEXT
        self._depth += 1
        try:
            return self._evaluate(node, scope)
        finally:
            self._depth -= 1

    def text(self, node: ast.expr | None, scope: Scope) -> Text:
        """Return the text of an expression, with the texts of several items concatenated."""
        return _as_text(self.value(node, scope))

    def _evaluate(self, node: ast.expr, scope: Scope) -> Value:
        if isinstance(node, ast.Constant):
            return make_literal(str(node.value)) if isinstance(node.value, (str, int, float)) else _UNKNOWN_TEXT
        if isinstance(node, ast.Name):
            return self._name(node.id, scope)
        if isinstance(node, (ast.List, ast.Tuple, ast.Set)):
            return Items(tuple(self._evaluate_items(node.elts, scope)))
        if isinstance(node, ast.Dict):
            return self._evaluate_entries(node, scope)
        if isinstance(node, ast.JoinedStr):
            return join_texts(self.text(piece, scope) for piece in node.values)
        if isinstance(node, ast.FormattedValue):
            return self.text(node.value, scope) if node.conversion == -1 and node.format_spec is None else _UNKNOWN_TEXT
        if isinstance(node, ast.BinOp):
            return self._operation(node, scope)
        if isinstance(node, ast.IfExp):
            return self._combine_alternatives(node, [self.value(node.body, scope), self.value(node.orelse, scope)])
        if isinstance(node, ast.BoolOp):
            return self.value(node.values[0], scope)
        if isinstance(node, ast.Subscript):
            return self._evaluate_item(node, scope)
        if isinstance(node, ast.Call):
            return self._call(node, scope)
        return _UNKNOWN_TEXT

    def _evaluate_items(self, nodes: Sequence[ast.expr], scope: Scope) -> list[Value]:
        values: list[Value] = []
        for node in nodes:
            if isinstance(node, ast.Starred):
                value = self.value(node.value, scope)
                values += value.values if isinstance(value, Items) else [_as_text(value)]
            else:
                values.append(self.value(node, scope))
        return values

    def _evaluate_entries(self, node: ast.Dict, scope: Scope) -> Value:
        entries: dict[str, Value] = {}
        for key, value in zip(node.keys, node.values, strict=True):
            entry_value = self.value(value, scope)
            if key is None:
                entries.update(_get_known_entries(entry_value))
            elif entry_name := _to_plain_string(self.text(key, scope)):
                entries[entry_name] = entry_value
            else:
                entries.update(UNKNOWN_ENTRIES)
        return Entries(entries)

    def _operation(self, node: ast.BinOp, scope: Scope) -> Value:
        left, right = self.value(node.left, scope), self.value(node.right, scope)
        if isinstance(node.op, ast.Div):
            return join_path([_as_text(left), _as_text(right)])
        if isinstance(node.op, (ast.Add, ast.BitOr)):
            return _add_values(left, right)
        if isinstance(node.op, ast.Mod) and (pattern := _to_plain_string(_as_text(left))):
            texts = [*map(_as_text, right.values)] if isinstance(right, Items) else [_as_text(right)]
            fragments = pattern.split("%s")
            if len(fragments) == len(texts) + 1 and "%" not in "".join(fragments):
                return _interleave(fragments, texts)
        return _UNKNOWN_TEXT

    def _evaluate_item(self, node: ast.Subscript, scope: Scope) -> Value:
        if isinstance(node.value, ast.Attribute) and node.value.attr == "launch_configurations":
            return self._launch_argument(node.slice, None, scope)
        owner = self.value(node.value, scope)
        if isinstance(owner, Entries):
            return owner.values.get(_to_plain_string(self.text(node.slice, scope)) or "", _UNKNOWN_TEXT)
        if isinstance(owner, Items) and isinstance(node.slice, ast.Constant) and isinstance(node.slice.value, int):
            return owner.values[node.slice.value] if abs(node.slice.value) < len(owner.values) else _UNKNOWN_TEXT
        return _UNKNOWN_TEXT

    def _get_call_value(self, owner: ast.expr, node: ast.Call, scope: Scope) -> Value:
        """Return the value of ``mapping.get(key, default)``.

        The default is returned only if the mapping is known and does not contain the key.
        """
        key, default = (*node.args, None)[:2] if node.args else (None, None)
        if isinstance(owner, ast.Attribute) and owner.attr == "launch_configurations":
            return self._launch_argument(key, default, scope)
        mapping = self.value(owner, scope)
        if not isinstance(mapping, Entries):
            return _UNKNOWN_TEXT
        name = _to_plain_string(self.text(key, scope)) or ""
        if name in mapping.values or not name or "" in mapping.values:
            return mapping.values.get(name, _UNKNOWN_TEXT)
        return self.value(default, scope)

    # --- calls ------------------------------------------------------------------------------------------------

    def _call(self, node: ast.Call, scope: Scope) -> Value:
        name = called_name(node).rpartition(".")[2]
        owner = node.func.value if isinstance(node.func, ast.Attribute) else None
        first = node.args[0] if node.args else next((keyword.value for keyword in node.keywords), None)
        if name in ("LaunchConfiguration", "LaunchConfigurationEquals"):
            return self._launch_argument(first, argument_of(node, "default"), scope)
        if name in _SHARE_FUNCTIONS:
            return (Share(self.text(first, scope)),)
        if name in _JOIN_FUNCTIONS:
            return self._join_path(node, name, owner, scope)
        if name == "get" and owner is not None and first is not None and "environ" not in ast.unparse(owner):
            return self._get_call_value(owner, node, scope)
        if (name in ("getenv", "get") and len(node.args) == 2) or name == "EnvironmentVariable":
            default = argument_of(node, "default_value") or (node.args[1] if len(node.args) > 1 else None)
            return self.value(default, scope)
        if name == "format" and owner is not None:
            return self._format(owner, node, scope)
        if name == "dict" and not node.args:
            return Entries({keyword.arg: self.value(keyword.value, scope) for keyword in node.keywords if keyword.arg})
        if name == "product":
            return Items((Items(tuple(self._evaluate_any_item(arg, scope) for arg in node.args)),))
        if name in _IDENTITY_METHODS and owner is not None:
            return self.value(owner, scope)
        if name in _IDENTITY_FUNCTIONS and first is not None:
            return self.value(first, scope)
        return _UNKNOWN_TEXT

    def _launch_argument(self, name: ast.expr | None, default: ast.expr | None, scope: Scope) -> Text:
        argument_name = _to_plain_string(self.text(name, scope))
        if argument_name is None:
            return _UNKNOWN_TEXT
        if default is not None:
            self.file.declare(argument_name, self.text(default, scope))
        return (make_launch_argument(argument_name),)

    def _join_path(self, node: ast.Call, name: str, owner: ast.expr | None, scope: Scope) -> Value:
        parts = self._evaluate_items(node.args, scope)
        if name == "PathJoinSubstitution":
            path_components = parts[0] if parts else None
            parts = list(path_components.values) if isinstance(path_components, Items) else []
        elif name == "joinpath" and owner is not None:
            parts = [self.value(owner, scope), *parts]
        elif name == "join" and isinstance(owner, ast.Constant):
            return _UNKNOWN_TEXT
        return join_path([_as_text(part) for part in parts])

    def _format(self, owner: ast.expr, node: ast.Call, scope: Scope) -> Value:
        pattern = _to_plain_string(self.text(owner, scope))
        if pattern is None:
            return _UNKNOWN_TEXT
        texts_by_name = {keyword.arg: self.text(keyword.value, scope) for keyword in node.keywords if keyword.arg}
        texts = [self.text(arg, scope) for arg in node.args]
        parts = _FIELD.split(pattern)
        if "{" in "".join(parts[::2]):
            return _UNKNOWN_TEXT
        field_texts: list[Text] = []
        for index, key in enumerate(parts[1::2]):
            position = int(key) if key.isdigit() else index
            field_texts.append(
                texts_by_name.get(key, _UNKNOWN_TEXT)
                if key and not key.isdigit()
                else (texts + [_UNKNOWN_TEXT] * (position + 1))[position]
            )
        return _interleave(parts[::2], field_texts)

    # --- names ------------------------------------------------------------------------------------------------

    def _name(self, name: str, scope: Scope) -> Value:
        lookup = scope.find(name)
        if lookup is None:
            return _UNKNOWN_TEXT
        defining_scope, bindings = lookup
        key = (id(defining_scope), name)
        if key not in self._names:
            self._names[key] = _UNKNOWN_TEXT  # end the recursion for a name that depends on itself
            value = self._evaluate_bindings(name, defining_scope, bindings)
            self._names[key] = _UNKNOWN_TEXT if isinstance(value, tuple) and len(value) > _MAX_PIECES else value
        return self._names[key]

    def _evaluate_bindings(self, name: str, defining_scope: Scope, bindings: Sequence[Binding]) -> Value:
        if not bindings and defining_scope.function is not None:
            return self._parameter(name, defining_scope)
        values = [self._evaluate_binding(binding, defining_scope) for binding in bindings if not binding.is_added]
        value = values[0] if len(values) == 1 else self._combine_alternatives(bindings[0].value, values)
        for binding in bindings:
            if binding.is_added:
                value = _add_values(value, self._evaluate_binding(binding, defining_scope))
        if isinstance(value, Entries) and name in defining_scope.entries:
            added_entries = {
                _to_plain_string(self.text(key, defining_scope)) or "": self.value(item, defining_scope)
                for key, item in defining_scope.entries[name]
            }
            value = Entries({**value.values, **added_entries, **(UNKNOWN_ENTRIES if "" in added_entries else {})})
        return value

    def _evaluate_binding(self, binding: Binding, scope: Scope) -> Value:
        value = self._evaluate_any_item(binding.value, scope) if binding.is_item else self.value(binding.value, scope)
        for index in binding.path:
            value = value.values[index] if isinstance(value, Items) and index < len(value.values) else _UNKNOWN_TEXT
        return value

    def _evaluate_any_item(self, node: ast.expr | None, scope: Scope) -> Value:
        """Return a value that represents any item of an iterable expression."""
        value = self.value(node, scope)
        if not isinstance(value, Items):
            return _UNKNOWN_TEXT
        return (
            value.values[0]
            if len(value.values) == 1
            else self._make_choice_placeholder(node, value.values, is_certain=True)
        )

    def _combine_alternatives(self, node: ast.expr | None, values: Sequence[Value]) -> Value:
        """Return a value that represents one of several values under unknown conditions."""
        known_values = [value for value in values if value != _UNKNOWN_TEXT]
        if len(known_values) < 2 or not all(isinstance(item, tuple) for item in known_values):
            return known_values[0] if known_values else _UNKNOWN_TEXT
        return self._make_choice_placeholder(node, known_values, is_certain=False)

    def _make_choice_placeholder(self, node: ast.expr | None, values: Sequence[Value], *, is_certain: bool) -> Value:
        """Return a placeholder for one of several values.

        For lists of equal length, the result is a list of placeholders.
        """
        name = "unknown" if node is None else f"at:{node.lineno}:{node.col_offset}"
        widths = {len(value.values) if isinstance(value, Items) else 0 for value in values}
        if len(widths) != 1:
            return _UNKNOWN_TEXT
        columns = widths.pop()
        rows = [
            tuple(map(_as_text, value.values)) if isinstance(value, Items) else (_as_text(value),) for value in values
        ]
        self.file.choices[name] = Choice(tuple(dict.fromkeys(rows)), is_certain)
        if not columns:
            return (Placeholder(name),)
        return Items(tuple((Placeholder(name, column),) for column in range(columns)))

    def _parameter(self, name: str, scope: Scope) -> Value:
        """Return the value of a function's parameter, from pytest or from calls in the same file."""
        function = scope.function
        assert function is not None
        outer_scope = scope.enclosing or scope
        for decorator in function.decorator_list:
            if isinstance(decorator, ast.Call) and called_name(decorator).endswith("parametrize") and decorator.args:
                names = self._parametrized_names(decorator.args[0], outer_scope)
                if name in names and len(decorator.args) > 1:
                    value = self._evaluate_any_item(decorator.args[1], outer_scope)
                    if len(names) == 1:
                        return value
                    return value.values[names.index(name)] if isinstance(value, Items) else _UNKNOWN_TEXT
        default = dict(iterate_defaults(function)).get(name)
        values: list[Value] = []
        for call, calling_scope in self.calls.get(function.name, ()):
            positions = list_parameters(function)
            position = positions.index(name) if name in positions else len(call.args)
            argument = argument_of(call, name) or (call.args[position] if position < len(call.args) else default)
            values.append(self.value(argument, calling_scope))
        if not values:  # all callers are in other files
            value = self.value(default, outer_scope)
            return Entries({**value.values, **UNKNOWN_ENTRIES}) if isinstance(value, Entries) else value
        return values[0] if len(values) == 1 else self._combine_alternatives(call, values)

    def _parametrized_names(self, node: ast.expr, scope: Scope) -> list[str]:
        value = self.value(node, scope)
        if isinstance(value, Items):
            return [_to_plain_string(_as_text(item)) or "" for item in value.values]
        return [word.strip() for word in (_to_plain_string(_as_text(value)) or "").split(",")]


def _to_plain_string(text: Text) -> str | None:
    """Return a text as a string, or None if the text has placeholders."""
    strings = [piece for piece in text if isinstance(piece, str)]
    return "".join(strings) if len(strings) == len(text) else None


def _as_text(value: Value) -> Text:
    if isinstance(value, Items):
        return join_texts(_as_text(item) for item in value.values)
    return _UNKNOWN_TEXT if isinstance(value, Entries) else value


def _get_known_entries(value: Value) -> Mapping[str, Value]:
    return value.values if isinstance(value, Entries) else UNKNOWN_ENTRIES


def _add_values(left: Value, right: Value) -> Value:
    if isinstance(left, Entries):
        return Entries({**left.values, **_get_known_entries(right)})
    if isinstance(left, Items) and isinstance(right, Items):
        return Items((*left.values, *right.values))
    if isinstance(left, tuple) and isinstance(right, tuple):
        return (*left, *right)
    return _UNKNOWN_TEXT


def _interleave(parts: Sequence[str], texts: Sequence[Text]) -> Text:
    """Return a text of the parts of a pattern, with the given texts between them."""
    result = make_literal(parts[0])
    for text, part in zip(texts, parts[1:], strict=True):
        result = (*result, *text, *make_literal(part))
    return result
