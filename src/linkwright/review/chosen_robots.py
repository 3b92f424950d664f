"""Find launch files that start another robot, which lacks links of the old one."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path

from linkwright.diagnostics import joined_first, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.breaking import frame_reason
from linkwright.review.changes import MAX_NAMES, Change, Effect, Location
from linkwright.review.launches.formats import is_launch_file
from linkwright.review.launches.outlines import Entry, LaunchOutline
from linkwright.review.launches.programs import try_read_outline
from linkwright.review.robots.unpaired_robots import read_unpaired_robot
from linkwright.review.versions import Version, Versions

_SHARE_PATH = re.compile(r"\$\(find(?:-pkg-share)? (?P<package>[\w-]+)\)/(?P<path>[\w./-]+\.(?:urdf|xacro))(?![\w.])")
_CALL = re.compile(r"[(,]\s*['\"]?(?P<package>[\w-]+)['\"]?, ['\"]?(?P<path>[\w./-]+\.(?:urdf|xacro))(?![\w.])")
"""The arguments of a function of the launch file that reads a file of a package."""


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
        (old_robot,), ((new_robot, entry),) = old, new.items()
        if old_robot != new_robot and not _is_renamed(versions, old_robot, new_robot):
            location = Location(file.new_path, entry.span.line, entry.span.column)
            change = _compare_robots(versions, old_robot, new_robot, location)
            if change is not None:
                yield file.path, change


def _find_robots(version: Version, path: str, outline: LaunchOutline) -> dict[str, Entry]:
    """Return the paths of the robots that a launch file starts by default, each with an action that names it."""
    found: dict[str, Entry] = {}
    folder = version.file(path).parent
    for entry in outline.entries:
        for text in () if entry.has_value else (entry.name, *entry.settings.values()):
            resolved = outline.resolve(text)
            for match in (*_SHARE_PATH.finditer(resolved), *_CALL.finditer(resolved)):
                share: Path | None = version.share_of(match["package"], folder)
                robot = None if share is None else version.relative(share / match["path"])
                if robot is None or not version.file(robot).is_file():
                    robot = f"{match['package']}/{match['path']}"
                found.setdefault(robot, entry)
    return found


def _is_renamed(versions: Versions, old: str, new: str) -> bool:
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
    return Change(text, Effect.BREAKING, frame_reason(str(names)), location)
