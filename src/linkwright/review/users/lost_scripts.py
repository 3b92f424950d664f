"""Find removed and renamed programs: commands that still start them, and programs of ROS 1 that no build file names."""

from __future__ import annotations

import os
import posixpath
import re
from collections.abc import Iterator, Sequence
from pathlib import PurePosixPath

from linkwright.diagnostics import Phrase, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.packages.manifest import package_name
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.command_files import list_command_files
from linkwright.review.launches.missing_programs import RepositoryPackage, find_packages
from linkwright.review.versions import TEST_FOLDERS, Version, Versions

_SUFFIXES = ("", ".py", ".sh", ".bash", ".pl", ".rb")
_PATH = re.compile(r"(?<![\w./$}~*-])(?P<path>(?:\.{1,2}/)*(?:[\w.-]+/)*[\w-][\w.-]*)(?![\w/*])")
_RUN = re.compile(r"\b(?:ros2\s+run|rosrun)\s+(?P<package>[\w-]+)\s+(?P<program>[\w.-]+)")
_LIST_ITEM = re.compile(r"\s*-\s*[\"']?[\w./*-]+[\"']?\s*")
"""A line of YAML that lists a path, such as one whose changes start a job."""
_NO_USE = re.compile(r"\s*@?(?:#|echo\b|printf\b)|.*(?:\brm\b|\s-[efrsx]\s|\|\|)")
"""A line that is a comment or a message, removes or tests a file, or continues without it."""
_YAML_SUFFIXES = (".yml", ".yaml")


def find_lost_scripts(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the commands that name a program which no longer exists, and lost programs of ROS 1, each with a change."""
    lost = {file.old_path: file for file in changed_files if file.old_path and _is_lost_program(versions, file)}
    if not lost:
        return
    for file in lost.values():
        change = _find_lost_name(versions, file)
        if change is not None:
            yield file.path, change
    names = {PurePosixPath(path).name for path in lost}
    for path in list_command_files(versions.new):
        text = versions.new.text(path)
        if any(name in text for name in names):
            yield from ((path, change) for change in _find_commands(versions, path, text, lost))


def _is_lost_program(versions: Versions, file: ChangedFile) -> bool:
    path = PurePosixPath(file.old_path or "")
    if file.is_submodule or file.old_path == file.new_path or path.suffix not in _SUFFIXES or path.name == "setup.py":
        return False
    return versions.old.text(file.old_path or "").startswith("#!") or path.suffix in _SUFFIXES[1:4]


def _find_commands(versions: Versions, path: str, text: str, lost: dict[str, ChangedFile]) -> Iterator[Change]:
    """Yield the lines of a file with commands that name a lost program."""
    for number, line in enumerate(text.splitlines(), 1):
        if _NO_USE.match(line) or (path.endswith(_YAML_SUFFIXES) and _LIST_ITEM.fullmatch(line)):
            continue
        for match in _PATH.finditer(line):
            target = _resolve(versions.new, path, match["path"], lost)
            if target is not None:
                yield _make_change(phrase("names '{path}', which no longer exists", path=match["path"]), path, number)
        run = _RUN.search(line)
        if run is not None and _is_lost_executable(versions, run["package"], run["program"], lost):
            text_of_run = phrase(
                "starts '{name}' of '{package}', which no longer exists", name=run["program"], package=run["package"]
            )
            yield _make_change(text_of_run, path, number)


def _make_change(text: Phrase, path: str, line: int) -> Change:
    return Change(text, Effect.BREAKING, phrase("the command fails"), Location(path, line, 1))


def _resolve(version: Version, path: str, name: str, lost: dict[str, ChangedFile]) -> str | None:
    """Return the lost program that a path in a command means, relative to the root or to the folder of the file."""
    if "/" not in name:
        return None
    folders = (".", PurePosixPath(path).parent.as_posix())
    candidates = [posixpath.normpath(posixpath.join(folder, name)) for folder in folders]
    if any(version.file(candidate).exists() for candidate in candidates):
        return None
    return next((candidate for candidate in candidates if candidate in lost), None)


def _is_lost_executable(versions: Versions, package: str, name: str, lost: dict[str, ChangedFile]) -> bool:
    old, new = (find_packages(version).get(package) for version in (versions.old, versions.new))
    is_named = any(PurePosixPath(path).name == name for path in lost)
    return is_named and old is not None and new is not None and old.has(name) and new.lacks(name)


def _find_lost_name(versions: Versions, file: ChangedFile) -> Change | None:
    """Return the change of the name of a program of ROS 1 that no build file installs."""
    old_path = file.old_path or ""
    path, folder = PurePosixPath(old_path), versions.old.package_of(old_path)
    if folder is None or not TEST_FOLDERS.isdisjoint(path.parts) or not os.access(versions.old.file(old_path), os.X_OK):
        return None
    package = package_name(versions.old.file(folder))
    new = find_packages(versions.new).get(package or "")
    old = RepositoryPackage(versions.old, folder)
    is_program = versions.old.text(old_path).startswith("#!") and old.is_ros1 and path.name not in old.programs
    if not is_program or new is None or not new.lacks(path.name):
        return None
    text = phrase("program '{name}' removed", name=path.name)
    if file.new_path is not None and PurePosixPath(file.new_path).name != path.name:
        text = phrase("program '{old}' renamed to '{new}'", old=path.name, new=PurePosixPath(file.new_path).name)
    reason = phrase("rosrun and launch files do not find '{name}'", name=path.name)
    is_old = file.new_path is None
    return Change(text, Effect.BREAKING, reason, Location(file.new_path or old_path, 1, 1, is_old=is_old))
