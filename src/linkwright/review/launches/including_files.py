"""Find settings that move between a launch file and a file that includes it: together, they keep all names."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from functools import cached_property
from typing import NamedTuple

from linkwright.diagnostics import Phrase, phrase
from linkwright.review.file_pair import FilePair
from linkwright.review.launch_paths import is_launch_file
from linkwright.review.launches.include_trees import IncludeTree, find_moved_parameter
from linkwright.review.launches.included import IncludedActions
from linkwright.review.launches.matching import get_launch_file_stem
from linkwright.review.launches.outlines import (
    NAMESPACE,
    REMAPPING,
    SERVER_PARAMETER,
    Entry,
    LaunchOutline,
    without_condition,
)
from linkwright.review.launches.programs.sources import try_read_outline

_MAX_SEARCHED_FILES = 60


class _Includer(NamedTuple):
    """Both versions of a changed launch file that includes the compared one in both.

    Attributes:
        path: the path of the new version.
        outlines: the actions of the old and of the new version.
        trees: the old and the new version with all included files.
    """

    path: str
    outlines: tuple[LaunchOutline, LaunchOutline]
    trees: tuple[IncludeTree, IncludeTree]


class IncludingFiles:
    """The changed launch files that include a launch file in both versions.

    Args:
        pair: both versions of the included launch file.
    """

    def __init__(self, pair: FilePair) -> None:
        self._pair = pair

    def find_opposite_change(self, entry: Entry, setting: str, old: str | None, new: str | None) -> str | None:
        """Return the path of an including file that changes a setting the other way round, or None.

        It sets a value that the included file no longer sets, or the reverse.

        Args:
            entry: the action of the included file; of the old version if the action was removed.
            setting: the name of the setting; empty for a removed parameter of ROS 1.
            old: the old value; None if there was none.
            new: the new value; None if there is none.
        """
        for includer in self._includers:
            if entry.kind == SERVER_PARAMETER:
                is_opposite = find_moved_parameter(entry, self._pair.old_path, *includer.trees) is not None
            elif setting == NAMESPACE:
                is_opposite = self._keeps_node_names(includer)
            elif entry.kind == "remapping" or setting.startswith(REMAPPING):
                source = entry.name if entry.kind == "remapping" else without_condition(setting).removeprefix(REMAPPING)
                targets = [_list_targets(outline, source) for outline in includer.outlines]
                lost, gained = targets[0] - targets[1], targets[1] - targets[0]
                is_opposite = None in (old, new) and {*filter(None, [old]), *filter(None, [new])} <= (
                    gained if new is None else lost
                )
            else:
                is_opposite = False
            if is_opposite:
                return includer.path
        return None

    def _keeps_node_names(self, includer: _Includer) -> bool:
        """Return whether all nodes that an including file starts by the included one keep their full names."""
        totals: list[Counter[str]] = []
        for outline, tree in zip(includer.outlines, includer.trees, strict=True):
            names = [tree.find_node_names(entry) for entry in self._find_includes(outline)]
            if any(each is None for each in names):
                return False
            totals.append(sum(filter(None, names), Counter()))
        return bool(totals[0]) and totals[0] == totals[1]

    @cached_property
    def _includers(self) -> list[_Includer]:
        return list(self._find_includers())

    def _find_includers(self) -> Iterator[_Includer]:
        pair = self._pair
        for file in pair.versions.changed_files[:_MAX_SEARCHED_FILES]:
            if not (file.old_path and file.new_path) or file.path == pair.new_path or not is_launch_file(file.path):
                continue
            old, new = (
                try_read_outline(version, path)
                for version, path in ((pair.versions.old, file.old_path), (pair.versions.new, file.new_path))
            )
            if old is None or new is None or not (self._find_includes(old) and self._find_includes(new)):
                continue
            trees = (
                IncludeTree(IncludedActions(pair.versions.old, file.old_path, old)),
                IncludeTree(IncludedActions(pair.versions.new, file.new_path, new)),
            )
            yield _Includer(file.new_path, (old, new), trees)

    def _find_includes(self, outline: LaunchOutline) -> list[Entry]:
        """Return the actions of a file that include the compared one."""
        stem = get_launch_file_stem(self._pair.new_path)
        return [
            entry for entry in outline.entries if entry.kind == "include" and get_launch_file_stem(entry.name) == stem
        ]


def describe_opposite_change(text: Phrase, reason: Phrase, includer: str, *, is_removed: bool) -> tuple[Phrase, Phrase]:
    """Return the line and the reason for a setting that moves between a launch file and one that includes it."""
    if is_removed:
        text = phrase("{change}; {file} sets it now", change=text, file=includer)
    else:
        text = phrase("{change}; {file} no longer sets it", change=text, file=includer)
    return text, phrase("where the file is started without {file}, {reason}", file=includer, reason=reason)


def _list_targets(outline: LaunchOutline, source: str) -> set[str]:
    """Return the names to which a file remaps a name for the nodes that follow."""
    remappings = (entry for entry in outline.entries if entry.kind == "remapping" and entry.name == source)
    return {outline.resolve(entry.settings.get("to", "")) for entry in remappings}
