"""Find launch files that start another robot, which lacks links of the old one."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from linkwright.diagnostics import joined_first, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.breaking import frames_reason
from linkwright.review.changes import MAX_NAMES, Change, Effect, Location
from linkwright.review.launch_paths import is_launch_file
from linkwright.review.launches.conditions import evaluate_condition
from linkwright.review.launches.included import MAX_INCLUDE_DEPTH, IncludedActions, IncludedFile
from linkwright.review.launches.outlines import CONDITION, Entry, LaunchOutline
from linkwright.review.launches.programs.sources import try_read_outline
from linkwright.review.robots.unpaired_robots import read_unpaired_robot
from linkwright.review.versions import Version, Versions

_SHARE_PATH = re.compile(r"\$\(find(?:-pkg-share)? (?P<package>[\w-]+)\)/(?P<path>[\w./-]+\.(?:urdf|xacro))(?![\w.])")
_CALL = re.compile(r"[(,]\s*['\"]?(?P<package>[\w-]+)['\"]?, ['\"]?(?P<path>[\w./-]+\.(?:urdf|xacro))(?![\w.])")
"""The arguments of a function of the launch file that reads a file of a package."""

_MAX_FILES = 30
"""The maximum number of files that are read for a launch file."""


def find_chosen_robots(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the launch files that start another robot by default, each with the links that it lacks.

    Only launch files with one robot in both versions count, because several may have different namespaces.
    """
    for file in changed_files:
        if not (file.old_path and file.new_path) or file.is_submodule or not is_launch_file(file.path):
            continue
        sides = ((versions.old, file.old_path), (versions.new, file.new_path))
        outlines = [try_read_outline(version, path) for version, path in sides]
        if outlines[0] is None or outlines[1] is None:
            continue
        old, new = (
            _find_robots(version, path, outline)
            for (version, path), outline in zip(sides, outlines, strict=True)
            if outline is not None
        )
        if len(old) != 1 or len(new) != 1:
            continue
        (old_robot, old_use), (new_robot, use) = *old.items(), *new.items()
        # an included file has the line itself
        is_told = use.path != file.new_path and _are_one_file(versions, old_use.path, use.path)
        if old_robot != new_robot and not is_told and not _are_one_file(versions, old_robot, new_robot):
            location = Location(file.new_path, use.entry.span.line, use.entry.span.column)
            change = _compare_robots(versions, old_robot, new_robot, location)
            if change is not None:
                yield file.path, change


class _Use(NamedTuple):
    """A use of a robot by a launch file.

    Attributes:
        entry: the action of the launch file that names the robot, or that includes a file which does.
        path: the path of the file that names the robot.
    """

    entry: Entry
    path: str


def _find_robots(version: Version, path: str, outline: LaunchOutline) -> dict[str, _Use]:
    """Return the paths of the robots that a launch file and its included files start by default, each with its use."""
    found: dict[str, _Use] = {}
    actions = IncludedActions(version, path, outline)
    queue: list[tuple[Entry | None, IncludedFile, int]] = [(None, IncludedFile(version.file(path), outline), 0)]
    for first, (file, file_outline), depth in queue:
        for entry in file_outline.entries:
            is_off = evaluate_condition(file_outline.resolve(entry.settings.get(CONDITION, ""))) is False
            if is_off or entry.has_value:
                continue
            use = _Use(first or entry, version.relative(file) or path)
            for text in (entry.name, *entry.settings.values()):
                for robot in _find_named_robots(version, file.parent, file_outline.resolve(text)):
                    found.setdefault(robot, use)
            is_followed = entry.kind == "include" and depth < MAX_INCLUDE_DEPTH and len(queue) < _MAX_FILES
            included = actions.read_included_file(entry, file_outline, file) if is_followed else None
            if included is not None:
                queue.append((use.entry, included, depth + 1))
    return found


def _find_named_robots(version: Version, folder: Path, text: str) -> Iterator[str]:
    """Yield the paths of the robots that a text of a launch file names."""
    for match in (*_SHARE_PATH.finditer(text), *_CALL.finditer(text)):
        share: Path | None = version.share_of(match["package"], folder)
        robot = None if share is None else version.relative(share / match["path"])
        if robot is None or not version.file(robot).is_file():
            robot = f"{match['package']}/{match['path']}"
        yield robot


def _are_one_file(versions: Versions, old: str, new: str) -> bool:
    """Return whether two paths are those of one changed file."""
    return any((file.old_path, file.new_path) == (old, new) for file in versions.changed_files)


def _compare_robots(versions: Versions, old: str, new: str, location: Location) -> Change | None:
    """Return the change about the links that only the old robot has, or None."""
    if not versions.old.file(old).is_file() or not versions.new.file(new).is_file():
        return None  # a robot of another repository
    robots = (read_unpaired_robot(versions.old, old), read_unpaired_robot(versions.new, new))
    if robots[0] is None or robots[1] is None:
        return None
    lost = [name for name in robots[0][1].links if name not in robots[1][1].links]
    if not lost:
        return None
    names = joined_first(lost, MAX_NAMES)
    text = phrase("the robot '{new}' has no links {names} of '{old}'", new=new, old=old, names=names)
    return Change(text, Effect.BREAKING, frames_reason(lost), location)
