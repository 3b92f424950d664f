"""Find added scripts that ROS does not find, although they start nodes or it finds the others of their folder."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from pathlib import PurePosixPath

from linkwright.diagnostics import Phrase, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.launch_paths import find_launch_files
from linkwright.review.launches.programs.missing import RepositoryPackage, read_actions
from linkwright.review.versions import TEST_FOLDERS, Version, Versions

_SUFFIXES = ("", ".py")
_NODE_PARTS = ("rclpy.init(", "rclpy.spin", "__main__")
"""The texts that a script contains if it starts a node."""


def find_unusable_programs(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the added scripts that are not executable or not installed, each with a change."""
    for file in changed_files:
        path = file.new_path
        if path is None or file.old_path is not None or file.is_submodule or not _is_script(versions.new, path):
            continue
        folder = versions.new.package_of(path)
        text = None if folder is None else _find_fault(versions.new, path, RepositoryPackage(versions.new, folder))
        if text is None:
            continue
        location, starter = Location(path, 1, 1), _find_starter(versions.new, path)
        if starter is None:
            yield path, Change(text, location=location)
        else:
            text = phrase("{change}; {path} starts it", change=text, path=starter)
            yield path, Change(text, Effect.BREAKING, phrase("the node does not start"), location)


def _find_starter(version: Version, path: str) -> str | None:
    """Return a launch file with an action that passes the name of a program to another file, which starts it."""
    name = PurePosixPath(path).name
    for file in find_launch_files(version):
        if name in version.text(file) and any(
            entry.kind == "include" and name in entry.settings.values() for entry in read_actions(version, file)
        ):
            return file
    return None


def _is_script(version: Version, path: str) -> bool:
    pure_path = PurePosixPath(path)
    is_named = pure_path.suffix in _SUFFIXES and pure_path.name != "setup.py"
    return is_named and TEST_FOLDERS.isdisjoint(pure_path.parts) and version.text(path).startswith("#!")


def _find_fault(version: Version, path: str, package: RepositoryPackage) -> Phrase | None:
    """Return why ROS does not find a script, or None if it may find it, or if the script may not be a program."""
    name = PurePosixPath(path).name
    if not package.is_ros1:
        names = {PurePosixPath(other).name for other in _list_others(version, path)}
        is_program = not names.isdisjoint(package.programs) or _is_node(version, path)
        is_lost = is_program and bool(package.programs) and package.lacks(name)
        return phrase("no build file installs the program, so that ros2 run does not find it") if is_lost else None
    others = [version.file(other) for other in _list_others(version, path)]
    is_lost = not os.access(version.file(path), os.X_OK) and any(os.access(other, os.X_OK) for other in others)
    if not is_lost or name in package.programs:
        return None
    return phrase("the program is not executable, so that rosrun does not find it")


def _is_node(version: Version, path: str) -> bool:
    """Return whether a script starts a node of ROS 2 and is not a module of a Python package."""
    text = version.text(path)
    is_module = version.file(str(PurePosixPath(path).with_name("__init__.py"))).is_file()
    return not is_module and os.access(version.file(path), os.X_OK) and all(part in text for part in _NODE_PARTS)


def _list_others(version: Version, path: str) -> list[str]:
    """Return the other scripts in the folder of a script."""
    folder = PurePosixPath(path).parent.as_posix()
    paths = [other for other in version.paths(_SUFFIXES, folder) if PurePosixPath(other).parent.as_posix() == folder]
    return [other for other in paths if other != path and _is_script(version, other)]
