"""Find the parameters of ROS 1 that a YAML file of ROS 2 has below the name of a node and ``ros__parameters``."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from linkwright.diagnostics import Phrase, joined_first, phrase
from linkwright.review.changes import MAX_NAMES, Change, Location
from linkwright.review.files.parameters.names import find_node_name, list_part_paths
from linkwright.review.files.parameters.yaml_values import YamlValue

_MIN_SHARE = 0.5
"""The minimum share of the old values that the nodes of the new file have."""
_KEY = "ros__parameters"


@dataclass(frozen=True)
class MigratedNode:
    """A node whose parameters of ROS 1 move below its name.

    Attributes:
        path: the new path of its parameters.
        parts: the new paths of the old parts.
    """

    path: str
    parts: Mapping[str, str]

    @property
    def _old_names(self) -> Phrase | str:
        return joined_first(list(self.parts), MAX_NAMES)

    def describe(self) -> Phrase:
        """Return the sentence about the move."""
        return phrase("{old} moved to {name}", old=self._old_names, name=self.path)

    def describe_as_name(self) -> str:
        """Return the short form for a list of moves."""
        return f"{self._old_names} -> {self.path}"


def find_migrated_nodes(old: Mapping[str, YamlValue], new: Mapping[str, YamlValue]) -> list[MigratedNode]:
    """Return the nodes whose parameters the old file has in the format of ROS 1; empty for other files.

    ROS 1 has the parameters of a node below its name, as in ``amcl.rate``, or without it if a launch file gives the
    name.

    Args:
        old: the old values by path.
        new: the new values by path.
    """
    nodes = list(dict.fromkeys(node for name in new if (node := find_node_name(name)) is not None))
    if not nodes or any(find_node_name(name) is not None for name in old):
        return []
    new_parts = {part for name in new for part in list_part_paths(name)}
    parts: dict[str, dict[str, str]] = {}
    for key in dict.fromkeys(list_part_paths(name)[0] for name in old):
        named = [node for node in nodes if key not in old and _get_base_name(node) == key.strip("/")]
        owners = named or [node for node in nodes if f"{node}.{_KEY}.{key}" in new_parts]
        if len(owners) == 1:
            path = f"{owners[0]}.{_KEY}"
            parts.setdefault(path, {})[key] = path if named else f"{path}.{key}"
    candidates = [MigratedNode(path, names) for path, names in parts.items()]
    migrated = [node for node in candidates if _has_moved(node, old, new)]
    kept = sum(rename_migrated(name, migrated) in new for name in old)
    return migrated if kept >= _MIN_SHARE * len(old) else []


def _has_moved(node: MigratedNode, old: Mapping[str, YamlValue], new: Mapping[str, YamlValue]) -> bool:
    """Return whether the new file has enough of the parameters of a node at their new paths."""
    moved = [renamed for name in old if (renamed := rename_migrated(name, [node])) != name]
    return sum(name in new for name in moved) >= _MIN_SHARE * len(moved)


def _get_base_name(node: str) -> str:
    """Return the name of a node without its namespaces, which can be parts of the file."""
    return node.strip("/").rpartition("/")[2].rpartition(".")[2]


def rename_migrated(name: str, nodes: list[MigratedNode]) -> str:
    """Return the new path of an old value."""
    key = list_part_paths(name)[0]
    path = next((node.parts[key] for node in nodes if key in node.parts), None)
    return name if path is None else f"{path}{name.removeprefix(key)}"


def describe_migration(nodes: list[MigratedNode], new: Mapping[str, YamlValue], path: str) -> Change:
    """Return the line about the nodes whose parameters moved.

    Args:
        nodes: the nodes, at least one.
        new: the new values by path.
        path: the path of the new file.
    """
    first = next(value for name, value in new.items() if name.startswith(f"{nodes[0].path}."))
    names = tuple(node.describe_as_name() for node in nodes[1:])
    return Change(nodes[0].describe(), location=Location(path, first.line, first.column), other_names=names)
