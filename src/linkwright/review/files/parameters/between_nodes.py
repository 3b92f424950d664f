"""Find parameters that move from a node of a YAML file to another one."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import NamedTuple

from linkwright.diagnostics import joined_first, phrase
from linkwright.review.changes import MAX_NAMES, Change, Location
from linkwright.review.files.parameters.names import find_node_name
from linkwright.review.files.parameters.yaml_values import YamlValue

_MIN_PARAMETERS = 3
"""The minimum number of equal parameters by which a move is recognized."""
_MIN_SHARE = 0.5
"""The minimum share of the removed parameters of the old node, or of the added ones of the new node, that move."""
_SECTION = ".ros__parameters."


class ParameterMove(NamedTuple):
    """Parameters that one node of a file loses and another one gets, with equal values.

    Attributes:
        old_node: the name of the node that loses them.
        new_node: the name of the node that gets them.
        paths: their new paths in the file, by old path.
    """

    old_node: str
    new_node: str
    paths: Mapping[str, str]

    def describe(self, path: str, new: Mapping[str, YamlValue]) -> Change:
        """Return the change in one line.

        Args:
            path: the path of the file.
            new: the new values by path.
        """
        names = joined_first([name.partition(_SECTION)[2] for name in self.paths], MAX_NAMES)
        text = phrase("moved from {old} to {name}: {items}", old=self.old_node, name=self.new_node, items=names)
        first = new[next(iter(self.paths.values()))]
        return Change(text, location=Location(path, first.line, first.column))


def find_parameter_moves(
    old: Mapping[str, YamlValue],
    new: Mapping[str, YamlValue],
    is_breaking: Callable[[str, YamlValue], bool],
) -> Iterator[ParameterMove]:
    """Yield the moves of parameters between nodes.

    Args:
        old: the old values by path.
        new: the new values by path.
        is_breaking: returns whether losing or adding a value is breaking, so that it needs a line of its own.
    """
    removed, added = _group_by_node(old, new, is_breaking), _group_by_node(new, old, is_breaking)
    for old_node, old_paths in removed.items():
        for new_node, new_paths in added.items():
            common = [
                key for key in old_paths if key in new_paths and _are_equal(old[old_paths[key]], new[new_paths[key]])
            ]
            least = min(len(old_paths), len(new_paths)) * _MIN_SHARE
            if len(common) >= max(_MIN_PARAMETERS, least):
                yield ParameterMove(old_node, new_node, {old_paths[key]: new_paths[key] for key in common})


def _are_equal(old: YamlValue, new: YamlValue) -> bool:
    return (old.text, old.type) == (new.text, new.type)


def _group_by_node(
    values: Mapping[str, YamlValue], others: Mapping[str, YamlValue], is_breaking: Callable[[str, YamlValue], bool]
) -> dict[str, dict[str, str]]:
    """Return the paths of the parameters that the other version lacks, by node and name."""
    groups: dict[str, dict[str, str]] = {}
    for path, value in values.items():
        node = find_node_name(path)
        if node is not None and path not in others and not is_breaking(path, value):
            groups.setdefault(node, {})[path.partition(_SECTION)[2]] = path
    return groups
