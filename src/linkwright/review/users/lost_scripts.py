"""Find commands that start what does not exist, and removed and renamed programs of ROS 1 that no build file names."""

from __future__ import annotations

import os
import posixpath
import re
from collections.abc import Iterator, Sequence
from pathlib import PurePosixPath
from typing import NamedTuple

from linkwright.diagnostics import Phrase, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.packages.launch_files import is_launch_file_name
from linkwright.packages.manifest import package_name
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.command_files import list_command_files
from linkwright.review.files.build.cmake_files import CMAKE_FILE
from linkwright.review.files.build.facts import FactKind
from linkwright.review.files.build.setup_files import SETUP_FILE
from linkwright.review.installed_paths import read_package_facts
from linkwright.review.launch_paths import is_launch_file
from linkwright.review.launches.programs.missing import RepositoryPackage, find_packages
from linkwright.review.versions import TEST_FOLDERS, Version, Versions

_SUFFIXES = ("", ".py", ".sh", ".bash", ".pl", ".rb")
_PATH = re.compile(r"(?<![\w./$}~*-])(?P<path>(?:\.{1,2}/)*(?:[\w.-]+/)*[\w-][\w.-]*)(?![\w/*])")
_RUN = re.compile(r"\b(?:ros2\s+run|rosrun)\s+(?P<package>[\w-]+)\s+(?P<program>[\w.-]+)")
_LAUNCH = re.compile(r"\b(?:ros2\s+launch|roslaunch)\s+(?P<package>[\w-]+)\s+(?P<file>[\w.-]+)")
_BIN_FOLDERS = r"/(?:[\w.-]+/)*(?:s?bin|lib/[\w-]+)/"
"""The beginning of the absolute path of an installed program."""
_LIST_ITEM = re.compile(r"\s*-\s*[\"']?[\w./*-]+[\"']?\s*")
"""A line of YAML that lists a path, such as one whose changes start a job."""
_NO_USE = re.compile(r"\s*@?(?:#|echo\b|printf\b)|.*(?:\brm\b|\s-[efrsx]\s|\|\|)")
"""A line that is a comment or a message, removes or tests a file, or continues without it."""
_BRANCH = re.compile(r"\s*(?:-\s+)?(?P<word>if|elif|else|fi)\b")
_END_OF_BRANCHES = re.compile(r"\bfi\b")
_EXISTENCE_TEST = re.compile(r"^(?!.*!)(?:.*\s-[efrsx]\s|.*\b(?:command\s+-v|which|type|hash)\s)")
"""The test of an ``if`` command for an existing file or program."""
_YAML_SUFFIXES = (".yml", ".yaml")
_PROGRAM = FactKind.EXECUTABLE


class _Lost(NamedTuple):
    """The programs and launch files that the new version lacks.

    Attributes:
        programs: the removed and renamed programs, by their old paths.
        launch_files: the names of removed and renamed launch files.
        installed: the names of programs that a package no longer installs.
    """

    programs: dict[str, ChangedFile]
    launch_files: frozenset[str]
    installed: frozenset[str]

    @property
    def words(self) -> frozenset[str]:
        """The names, of which a file that uses one of them has at least one."""
        return self.launch_files | self.installed | {PurePosixPath(path).name for path in self.programs}


def find_lost_scripts(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the commands that start what no longer exists, and lost programs of ROS 1, each with a change."""
    programs = {file.old_path: file for file in changed_files if file.old_path and _is_lost_program(versions, file)}
    launch_files = (PurePosixPath(file.old_path or "").name for file in changed_files if _is_lost_launch_file(file))
    lost = _Lost(programs, frozenset(launch_files), frozenset(_list_uninstalled(versions, changed_files)))
    for file in programs.values():
        change = _find_lost_name(versions, file)
        if change is not None:
            yield file.path, change
    for path in list_command_files(versions.new) if lost.words else ():
        text = versions.new.text(path)
        if any(word in text for word in lost.words):
            yield from ((path, change) for change in _find_commands(versions, path, text, lost))
    yield from _find_missing_starts(versions, changed_files)


def _find_missing_starts(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the new commands that start a program or launch file which a package of the repository never had."""
    changed = {file.new_path: file.old_path for file in changed_files if file.new_path and not file.is_submodule}
    for path in list_command_files(versions.new) if changed else ():
        old_path = changed.get(path)
        old_lines = set(versions.old.text(old_path).splitlines()) if old_path else set()
        tests = _ShellTests()
        for number, line in enumerate(versions.new.text(path).splitlines() if path in changed else (), 1):
            tests.read(line)
            run, launch = tests.find_starts(line)
            if line in old_lines or _NO_USE.match(line):
                continue
            if run is not None and _never_existed(versions, run["package"], run["program"], is_launch=False):
                yield path, _make_missing_change(run["package"], run["program"], path, number)
            if launch is not None and _never_existed(versions, launch["package"], launch["file"], is_launch=True):
                yield path, _make_missing_change(launch["package"], launch["file"], path, number)


def _never_existed(versions: Versions, package: str, name: str, *, is_launch: bool) -> bool:
    """Return whether neither version has a program or launch file of a package of the repository."""
    old, new = (find_packages(version).get(package) for version in (versions.old, versions.new))
    if new is None or new.may_generate or (old is not None and (name in old.names or old.has(name))):
        return False
    if is_launch:
        return is_launch_file(name) and name not in new.names
    return new.lacks(name) and (PurePosixPath(name).suffix in _SUFFIXES[1:] or not new.may_compute_names)


def _make_missing_change(package: str, name: str, path: str, line: int) -> Change:
    text = phrase("starts '{package}/{name}', which does not exist", name=name, package=package)
    return _make_change(text, path, line)


def _is_lost_launch_file(file: ChangedFile) -> bool:
    return file.old_path is not None and file.old_path != file.new_path and is_launch_file_name(file.old_path)


def _list_uninstalled(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[str]:
    """Yield the names of the programs that packages no longer install."""
    names = (CMAKE_FILE, SETUP_FILE)
    paths = (file.old_path or "" for file in changed_files)
    folders = {versions.old.package_of(path) for path in paths if path.endswith(names)}
    for folder in folders:
        old, new = (
            None if folder is None else read_package_facts(version, folder) for version in (versions.old, versions.new)
        )
        if old is not None and new is not None and new.unknown <= old.unknown:
            before, after = ({fact.name for fact in facts.facts if fact.kind is _PROGRAM} for facts in (old, new))
            yield from before - after


def _is_lost_program(versions: Versions, file: ChangedFile) -> bool:
    path = PurePosixPath(file.old_path or "")
    if file.is_submodule or file.old_path == file.new_path or path.suffix not in _SUFFIXES or path.name == "setup.py":
        return False
    return versions.old.text(file.old_path or "").startswith("#!") or path.suffix in _SUFFIXES[1:4]


def _find_commands(versions: Versions, path: str, text: str, lost: _Lost) -> Iterator[Change]:
    """Yield the lines of a file with commands that name something lost."""
    names = "|".join(map(re.escape, sorted(lost.installed))) or "(?!)"
    installed = re.compile(rf"(?<![\w.}}]){_BIN_FOLDERS}(?:{names})(?![\w/.-])")
    tests = _ShellTests()
    for number, line in enumerate(text.splitlines(), 1):
        tests.read(line)
        if _NO_USE.match(line) or (path.endswith(_YAML_SUFFIXES) and _LIST_ITEM.fullmatch(line)):
            continue
        for match in _PATH.finditer(line):
            target = _resolve(versions.new, path, match["path"], lost.programs)
            if target is not None and not tests.find(match["path"]):
                yield _make_change(phrase("names '{path}', which no longer exists", path=match["path"]), path, number)
        for match in (match for match in installed.finditer(line) if not tests.find(match[0])):
            yield _make_change(phrase("names '{path}', which is no longer installed", path=match[0]), path, number)
        run, launch = tests.find_starts(line)
        if (
            run is not None
            and not tests.find(run["program"])
            and _is_lost_executable(versions, run["package"], run["program"], lost)
        ):
            yield _make_start_change(run["package"], run["program"], path, number)
        if (
            launch is not None
            and not tests.find(launch["file"])
            and _is_lost_launch(versions, launch["package"], launch["file"], lost)
        ):
            yield _make_start_change(launch["package"], launch["file"], path, number)


class _ShellTests:
    """The tests of a shell script around its lines that hold only if a file or program exists."""

    def __init__(self) -> None:
        self._tests: list[str] = []

    def read(self, line: str) -> None:
        """Enter or leave a branch of an ``if`` command."""
        match = _BRANCH.match(line)
        if match is None:
            return
        if match["word"] == "if" and not _END_OF_BRANCHES.search(line):
            self._tests.append("")
        if match["word"] == "fi":
            del self._tests[-1:]
        elif self._tests:
            self._tests[-1] = line if _EXISTENCE_TEST.search(line) else ""

    def find(self, path: str) -> bool:
        """Return whether a test around the current line names a file or program."""
        name = re.compile(rf"(?<![\w.-]){re.escape(PurePosixPath(path).name)}(?![\w.-])")
        return any(name.search(test) for test in self._tests)

    def find_starts(self, line: str) -> tuple[re.Match[str] | None, re.Match[str] | None]:
        """Return the program and the launch file that a line starts, except those that are tested for."""
        run, launch = _RUN.search(line), _LAUNCH.search(line)
        return (
            None if run is None or self.find(run["program"]) else run,
            None if launch is None or self.find(launch["file"]) else launch,
        )


def _make_start_change(package: str, name: str, path: str, line: int) -> Change:
    return _make_change(
        phrase("starts '{package}/{name}', which no longer exists", name=name, package=package), path, line
    )


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


def _is_lost_executable(versions: Versions, package: str, name: str, lost: _Lost) -> bool:
    old, new = (find_packages(version).get(package) for version in (versions.old, versions.new))
    is_named = name in lost.installed or any(PurePosixPath(path).name == name for path in lost.programs)
    return is_named and old is not None and new is not None and old.has(name) and new.lacks(name)


def _is_lost_launch(versions: Versions, package: str, name: str, lost: _Lost) -> bool:
    """Return whether a package had a launch file that it no longer has under this name, in any of its folders."""
    old, new = (find_packages(version).get(package) for version in (versions.old, versions.new))
    is_named = name in lost.launch_files and old is not None and name in old.names
    return is_named and new is not None and name not in new.names and not new.may_generate


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
