"""The values of string and path expressions in a Python text, found without running it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from linkwright.language.python_text import Group, Item, Name, Operator, Part, PythonText, Text
from linkwright.packages import PackageFinder

SHARES = frozenset({"get_package_share_directory", "get_package_share_path", "FindPackageShare"})
"""The functions that return the share folder of a package."""
_PREFIXES = frozenset({"get_package_prefix", "FindPackagePrefix"})
PACKAGE_FUNCTIONS = SHARES | _PREFIXES
"""The functions whose argument is a package."""
JOINS = frozenset({"join", "Path", "PurePath", "PathSubstitution"})
"""The functions that join their arguments to a path."""
_WRAPPERS = frozenset(
    {
        *("str", "PythonLaunchDescriptionSource", "XMLLaunchDescriptionSource", "YAMLLaunchDescriptionSource"),
        *("AnyLaunchDescriptionSource", "FrontendLaunchDescriptionSource", "TextSubstitution", "ParameterFile"),
        *("realpath", "abspath", "normpath", "as_posix", "open"),
    }
)
"""The functions whose value is the value of their first argument."""
_MAX_DEPTH = 30


@dataclass(frozen=True, slots=True)
class Value:
    """A text or path.

    Attributes:
        text: the text. A path below a share folder begins with that folder.
        is_path: whether it begins with a known folder.
    """

    text: str
    is_path: bool = False


class PythonPaths:
    """An evaluator of the string and path expressions in a Python text.

    Args:
        python: the text.
        file: its file.
        finder: finds packages.
        defaults: the values of launch configurations, by name.
    """

    def __init__(
        self, python: PythonText, file: Path, finder: PackageFinder, defaults: Mapping[str, str] | None = None
    ) -> None:
        self._python = python
        self._defaults = defaults or {}
        self._file = file
        self._finder = finder

    def value_of(self, item: Item | None) -> Value | None:
        """Return the value of an item, or None if it is unknown."""
        return None if item is None else self._join_parts(item.parts, 0)

    def text_of(self, item: Item | None) -> str | None:
        """Return the text of an item, or None if it is a path or unknown."""
        value = self.value_of(item)
        return None if value is None or value.is_path else value.text

    def path_before(self, text: Text, item: Item) -> Value | None:
        """Return the path that a string continues, or None if it is unknown.

        The path ends with ``/`` if the string is a new component of it.

        Args:
            text: the string.
            item: the item that contains it.
        """
        number = next((index for index, part in enumerate(item.parts) if part is text), 0)
        head = item.parts[:number]
        if head and isinstance(head[-1], Operator) and head[-1].value in ("/", "+"):
            value = self._join_parts(head[:-1], 0)
            joint = "/" if head[-1].value == "/" else ""
            return None if value is None else Value(value.text + joint, value.is_path)
        if head:
            return None
        return self._join_before(item)

    def _join_before(self, item: Item) -> Value | None:
        group = item.group
        outer = group.parent.group if group.parent is not None else None
        in_list = group.opening == "[" and outer is not None
        if group.function in JOINS or (in_list and outer is not None and outer.function == "PathJoinSubstitution"):
            earlier_items = group.items[: group.items.index(item)]
            value = self._join(earlier_items, 0) if earlier_items else None
            return None if value is None else Value(value.text + "/", value.is_path)
        if in_list and not group.callee:  # This is a list of substitutions, which launch concatenates.
            return self._concatenate([self.value_of(other) for other in group.items[: group.items.index(item)]])
        return None

    def _join_parts(self, parts: Sequence[Part], depth: int) -> Value | None:
        """Return the value of terms that are joined by ``+``, ``/`` or nothing."""
        if depth > _MAX_DEPTH or not parts:
            return None
        value: Value | None = None
        mark = ""
        for index, part in enumerate(parts):
            if isinstance(part, Operator):
                if part.value not in ("+", "/") or index == 0:
                    return None
                mark = part.value
                continue
            term = self._evaluate_term(part, depth)
            if value is None and index > 0:
                return None
            if term is None:
                return None
            value = (
                term
                if value is None
                else self._concatenate([value, Value("/"), term] if mark == "/" else [value, term])
            )
            mark = ""
        return value

    @staticmethod
    def _concatenate(values: Sequence[Value | None]) -> Value | None:
        if not values or any(value is None for value in values):
            return None
        return Value("".join(value.text for value in values if value), bool(values[0] and values[0].is_path))

    def _join(self, items: Sequence[Item], depth: int) -> Value | None:
        values = [self._join_parts(item.parts, depth + 1) for item in items]
        if not values or any(value is None for value in values):
            return None
        pieces = [value.text for value in values if value is not None]
        is_path = bool(values[0] and values[0].is_path)
        return Value("/".join([pieces[0].rstrip("/"), *(piece.strip("/") for piece in pieces[1:])]), is_path)

    def _evaluate_term(self, part: Part, depth: int) -> Value | None:
        if isinstance(part, Text):
            return None if part.is_format and "{" in part.value else Value(part.value)
        if isinstance(part, Name):
            return self._evaluate_variable(part.value, depth)
        return self._evaluate_group(part, depth) if isinstance(part, Group) else None

    def _evaluate_variable(self, name: str, depth: int) -> Value | None:
        if name == "__file__":
            return Value(str(self._file), is_path=True)
        bound = self._python.bindings.get(name)
        return None if bound is None else self._join_parts(bound.parts, depth + 1)

    def _evaluate_group(self, group: Group, depth: int) -> Value | None:
        items = [item for item in group.items if item.parts]
        function = group.function
        if function in PACKAGE_FUNCTIONS:
            package = self._join_parts((group.argument("package", 0) or Item(group, 0)).parts, depth + 1)
            share = None if package is None else self._finder.find(package.text)
            return None if share is None or function in _PREFIXES else Value(str(share), is_path=True)
        if function == "LaunchConfiguration" and items:
            name = self._join_parts(items[0].parts, depth + 1)
            default = None if name is None else self._defaults.get(name.text)
            return None if default is None else Value(default)
        if function == "ThisLaunchFileDir":
            return Value(str(self._file.parent), is_path=True)
        if function == "dirname" and items:
            inner = self._join_parts(items[0].parts, depth + 1)
            return None if inner is None else Value(str(Path(inner.text).parent), inner.is_path)
        if function == "PathJoinSubstitution" and items and isinstance(items[0].parts[0], Group):
            return self._join([item for item in items[0].parts[0].items if item.parts], depth)
        if function in JOINS:
            return self._join(items, depth)
        if (function in _WRAPPERS or (not group.callee and group.opening == "(")) and items:
            return self._join_parts(items[0].parts, depth + 1)
        if group.opening == "[" and not group.callee:
            return self._concatenate([self._join_parts(item.parts, depth + 1) for item in items])
        return None
