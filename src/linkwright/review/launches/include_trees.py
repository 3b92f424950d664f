"""Expand a launch file with the files that it includes, to compare the names that nodes and parameters have there."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from functools import cached_property
from itertools import islice
from pathlib import Path
from typing import NamedTuple

from linkwright.review.launches.conditions import evaluate_condition
from linkwright.review.launches.included import MAX_INCLUDE_DEPTH, IncludedActions
from linkwright.review.launches.outlines import (
    CONDITION,
    NAMESPACE,
    NAMESPACE_OF_INCLUDED,
    PROGRAM_KINDS,
    REMAPPING,
    SERVER_PARAMETER,
    Entry,
    LaunchOutline,
)

_USED_ARGUMENT = re.compile(r"\$\((?:var|arg) (?P<name>[\w./-]+)")
_MAX_FILES = 200
"""The maximum number of included files of a tree, because a file can include another one several times."""
_FileKey = tuple["str | None", frozenset[tuple[str, str]]]
"""The path of an included file, relative to the root, and the values of its arguments."""


class TreeFile(NamedTuple):
    """A launch file in the tree of the files that another one includes.

    Attributes:
        file: the path of the file.
        path: the path relative to the root of the repository; None if it is outside.
        outline: the actions of the file; the passed arguments are the defaults.
        namespace: the namespace that the including files give to its nodes.
        conditions: the conditions of the includes around it that may not hold.
        values: the values of the arguments that the including files set, also those that the file does not declare.
        includer: the path of the file that includes it, relative to the root.
    """

    file: Path
    path: str | None
    outline: LaunchOutline
    namespace: str
    conditions: frozenset[str]
    values: Mapping[str, str]
    includer: str | None


class SetParameter(NamedTuple):
    """A parameter of ROS 1 that a tree of launch files sets.

    Attributes:
        value: the value; passed arguments have replaced variables.
        conditions: the conditions that may not hold.
        path: the path of the file that sets it, relative to the root.
    """

    value: str
    conditions: frozenset[str]
    path: str | None


class IncludeTree:
    """A launch file with the files that it includes, in one version.

    Args:
        included: the actions of the launch file.

    """

    def __init__(self, included: IncludedActions) -> None:
        self._included = included
        self._root = TreeFile(included.file, included.path, included.outline, "", frozenset(), {}, None)

    def resolve(self, text: str) -> str:
        """Return a text of the launch file with values in place of variables."""
        return self._root.outline.resolve(text)

    @cached_property
    def files(self) -> list[TreeFile]:
        """The files that the defaults may start, the launch file first."""
        files = islice(self._walk(self._root), _MAX_FILES)
        return [self._root, *(tree_file for tree_file in files if tree_file is not None)]

    def _walk(self, parent: TreeFile, only: Entry | None = None, depth: int = 0) -> Iterator[TreeFile | None]:
        """Yield the files below a file, or below one of its includes, and None for a file that cannot be read."""
        for entry in parent.outline.entries if only is None else [only]:
            conditions = _find_open_conditions(entry, parent.outline)
            if entry.kind != "include" or conditions is None:
                continue
            child = self._included.read_included_file(entry, parent.outline, parent.file)
            if child is None or depth >= MAX_INCLUDE_DEPTH:
                yield None
                continue
            passed = {name: parent.outline.resolve(value) for name, value in entry.settings.items()}
            if not (parent.outline.is_ros1 or child.outline.is_ros1):
                passed = {**parent.values, **parent.outline.values, **passed}
            namespace = parent.outline.resolve(entry.settings.get(NAMESPACE_OF_INCLUDED, ""))
            tree_file = TreeFile(
                child.file,
                self._included.find_path(child.file),
                child.outline.with_defaults(passed),
                _join(parent.namespace, namespace),
                parent.conditions | conditions,
                passed,
                parent.path,
            )
            yield tree_file
            yield from self._walk(tree_file, depth=depth + 1)

    def find_node_names(self, include: Entry) -> Counter[str] | None:
        """Return the full names of the nodes that an include starts, or None if a file cannot be read."""
        names: Counter[str] = Counter()
        for tree_file in self._walk(self._root, include):
            if tree_file is None:
                return None
            outline = tree_file.outline
            for entry in outline.entries:
                if entry.kind in PROGRAM_KINDS and _find_open_conditions(entry, outline) is not None:
                    namespace = _join(tree_file.namespace, outline.resolve(entry.settings.get(NAMESPACE, "")))
                    names[_join(namespace, outline.resolve(entry.settings.get("name", entry.name))).strip("/")] += 1
        return names

    def get_parameter_name(self, entry: Entry) -> str:
        """Return the full name of a parameter of ROS 1 that the launch file itself sets."""
        return _get_parameter_name(entry, self._root)

    def find_parameter(self, name: str) -> SetParameter | None:
        """Return the parameter of ROS 1 with a full name, or None if no file sets it.

        If several actions set it, it has the last value.
        """
        for tree_file in reversed(self.files):
            for entry in reversed(tree_file.outline.entries):
                if entry.kind != SERVER_PARAMETER or _get_parameter_name(entry, tree_file) != name:
                    continue
                conditions = _find_open_conditions(entry, tree_file.outline)
                if conditions is not None:
                    value = tree_file.outline.resolve(entry.settings.get("value", ""))
                    return SetParameter(value, tree_file.conditions | conditions, tree_file.path)
        return None

    def read_include(self, include: Entry) -> TreeFile | None:
        """Return the file of an include of the launch file, or None if it is unknown or not included by default."""
        return next(self._walk(self._root, include), None)


def _make_key(tree_file: TreeFile) -> _FileKey:
    outline = tree_file.outline
    texts = [text for entry in outline.entries for text in (entry.name, *entry.settings.values())]
    names = {match["name"] for text in texts for match in _USED_ARGUMENT.finditer(text)}
    values = {**tree_file.values, **outline.values}
    return tree_file.path, frozenset((name, outline.resolve(values[name])) for name in names if name in values)


def find_same_parameter(entry: Entry, old: IncludeTree, new: IncludeTree) -> SetParameter | None:
    """Return the parameter that has the full name and the value of an old one in the new version, or None.

    Args:
        entry: an action of the old launch file that sets a parameter of ROS 1.
        old: the old launch file with its included files.
        new: the new one.
    """
    return _find_equal_parameter(old.get_parameter_name(entry), old, new)


def _find_equal_parameter(name: str, old: IncludeTree, new: IncludeTree) -> SetParameter | None:
    """Return the parameter with a full name in the new version if it has the old value, or None."""
    before, after = old.find_parameter(name), new.find_parameter(name)
    if before is None or after is None or "$(" in name or "$(" in before.value:
        return None
    return after if after.value == before.value and after.conditions <= before.conditions else None


def find_moved_parameter(entry: Entry, path: str, old: IncludeTree, new: IncludeTree) -> SetParameter | None:
    """Return the parameter that has the full name and the value of one of an old included file, or None.

    Args:
        entry: an action of the included file that sets a parameter of ROS 1.
        path: the path of the included file in the old version, relative to the root.
        old: the old launch file with its included files.
        new: the new one.
    """
    names = {_get_parameter_name(entry, tree_file) for tree_file in old.files[1:] if tree_file.path == path}
    found = [_find_equal_parameter(name, old, new) for name in names]
    return found[0] if found and all(found) else None


def find_moved_remapping(entry: Entry, old: IncludeTree, new: IncludeTree) -> str | None:
    """Return the path of an included file that now remaps a name like a removed action, or None.

    Args:
        entry: an action of the old launch file that remaps a name for the nodes that follow.
        old: the old launch file with its included files.
        new: the new one.
    """
    target = old.resolve(entry.settings.get("to", ""))
    had_target = {tree_file.path for tree_file in old.files[1:] if _remaps(tree_file.outline, entry.name, target)}
    paths = (tree_file.path for tree_file in new.files[1:] if _remaps(tree_file.outline, entry.name, target))
    return next((path for path in paths if path not in had_target), None)


def _remaps(outline: LaunchOutline, source: str, target: str) -> bool:
    """Return whether a file remaps a name to another one, for one of its nodes or for all that follow."""
    for entry in outline.entries:
        value = entry.settings.get("to") if entry.kind == "remapping" and entry.name == source else None
        if entry.kind in PROGRAM_KINDS:
            value = entry.settings.get(f"{REMAPPING}{source}")
        if value is not None and outline.resolve(value) == target:
            return _find_open_conditions(entry, outline) is not None
    return False


def find_other_include(include: Entry, old: IncludeTree, new: IncludeTree) -> tuple[TreeFile, bool] | None:
    """Return the file of a removed include where another file now includes it with the same arguments, or None.

    The second item tells whether its nodes have the same namespace as before.

    Args:
        include: the removed include.
        old: the old launch file with its included files.
        new: the new one.
    """
    own = old.read_include(include)
    if own is None or own.path is None:
        return None
    old_files, new_files = (
        [other for other in tree.files[1:] if _make_key(other) == _make_key(own)] for tree in (old, new)
    )
    candidates = [other for other in new_files if not other.conditions]
    if len(new_files) < len(old_files) or not candidates:
        return None
    in_same_namespace = [other for other in candidates if other.namespace.strip("/") == own.namespace.strip("/")]
    return (in_same_namespace or candidates)[0], bool(in_same_namespace)


def _find_open_conditions(entry: Entry, outline: LaunchOutline) -> frozenset[str] | None:
    """Return the condition of an action if it may not hold; None if it does not hold by default."""
    condition = outline.resolve(entry.settings.get(CONDITION, ""))
    holds = evaluate_condition(condition)
    if holds is None:
        return frozenset([condition])
    return frozenset() if holds else None


def _get_parameter_name(entry: Entry, tree_file: TreeFile) -> str:
    name = tree_file.namespace
    for part in (*entry.namespaces, entry.name):
        name = _join(name, tree_file.outline.resolve(part))
    return name.strip("/")


def _join(namespace: str, name: str) -> str:
    """Return a name in a namespace. A name that begins with ``/`` has no other namespace."""
    if not namespace or not name or name.startswith("/"):
        return name or namespace
    return f"{namespace.rstrip('/')}/{name}"
