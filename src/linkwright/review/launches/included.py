"""Read the files that a launch file includes, if the repository has them."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import cached_property, lru_cache
from pathlib import Path

from linkwright.diagnostics import LinkwrightError
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.launches.conditions import condition_holds
from linkwright.review.launches.effects import offers_nothing
from linkwright.review.launches.formats import is_launch_file
from linkwright.review.launches.matching import launch_file_key
from linkwright.review.launches.outlines import CONDITION, Entry, LaunchOutline
from linkwright.review.launches.reading import read_outline
from linkwright.review.launches.titles import served_names
from linkwright.review.versions import Version, Versions

_SHARED = re.compile(r"\$\(find(?:-pkg-share)? (?P<package>[\w.-]+)\)/(?P<path>[^$]+)")
_BESIDE = "$(dirname)/"
_MOVABLE = ("node", "include", "process", "argument")
_STARTING = ("node", "include", "process", "action")
_MAX_DEPTH = 3
_MAX_FILES = 30
_MAX_BYTES = 1 << 20
_MAX_CHANGED = 60
_LAUNCH_SUFFIXES = (".launch", ".xml", "launch.py", "launch.yaml", "launch.yml")
Program = tuple[str, str]
"""The kind and the name of an action that starts a program."""
_FILE_WITHOUT_NODES = re.compile(
    r"rviz|rqt|[^/]*gui[^/]*$|(^|[/_])(machines?|upload(_\w+)?|params?|parameters)[._]launch"
)
"""The files that, judging by their name, start no programs for other programs."""
_Key = tuple[str, str, "str | None", tuple[str, ...]]
"""The kind, the name, the name of the node and the names that it serves."""
_USED_ARGUMENT = re.compile(r"\$\((?:var|arg) (?P<name>[\w./-]+)\)")


class IncludedActions:
    """The actions of the files that a launch file includes.

    Args:
        version: the version of the repository.
        path: the path of the launch file, relative to the root.
        outline: the actions of the file.

    Attributes:
        outline: the actions of the file.
    """

    def __init__(self, version: Version, path: str, outline: LaunchOutline) -> None:
        self._version = version
        self._path = path
        self.outline = outline
        self._outlines: dict[Path, LaunchOutline | None] = {}

    def lone_file(self, entry: Entry, other: IncludedActions) -> str | None:
        """Return the included file with an action, or None if there is none or the other version has one, too."""
        if entry.kind not in _MOVABLE:
            return None
        return None if other._file_with(entry) else self._file_with(entry)

    def _file_with(self, entry: Entry) -> str | None:
        name = entry.settings.get("name")
        for path, outline in self._included.items():
            for other in outline.entries:
                is_same = (other.kind, other.name) == (entry.kind, entry.name)
                if is_same and (name is None or other.settings.get("name") in (None, name)):
                    return path
        return None

    @cached_property
    def _included(self) -> dict[str, LaunchOutline]:
        """The outlines of the included files, by path."""
        found: dict[str, LaunchOutline] = {}
        waiting = [(self._version.file(self._path), self.outline, 0)]
        for file, outline, depth in waiting:
            for entry in outline.entries if depth < _MAX_DEPTH else ():
                inner = self._file_of(entry, file)
                path = None if inner is None else self._version.relative(inner)
                if inner is None or path is None or path in found or len(found) >= _MAX_FILES:
                    continue
                inner_outline = self._read_outline(inner)
                if inner_outline is not None:
                    found[path] = inner_outline
                    waiting.append((inner, inner_outline, depth + 1))
        return found

    def _file_of(self, entry: Entry, includer: Path) -> Path | None:
        """Return the file that an action includes, or None if the repository does not have it."""
        if entry.kind != "include":
            return None
        shared = _SHARED.fullmatch(entry.name)
        if shared is not None:
            share = self._version.share_of(shared["package"], includer.parent)
            if share is None:  # a package without package.xml, as rosbuild has
                share = next((folder for folder in includer.parents if folder.name == shared["package"]), None)
            file = None if share is None else _file_below(share, shared["path"])
        elif entry.name.startswith(_BESIDE) and "$" not in entry.name.removeprefix(_BESIDE):
            file = includer.parent / entry.name.removeprefix(_BESIDE)
        else:
            file = None
        return None if file is None or ".." in file.parts or not file.is_file() else file

    def started_programs(self, entry: Entry) -> Counter[Program]:
        """Count the shared programs that an included file starts by default; an unknown file counts as one program."""
        return Counter(self._programs_of_action(entry, self.outline, self._version.file(self._path), 0))

    def all_started_programs(self, values: Mapping[str, str] | None = None) -> Counter[Program]:
        """Count the shared programs that the launch file and its included files start by default.

        Args:
            values: other defaults of arguments, by name.
        """
        outline = self.outline.with_defaults(values) if values else self.outline
        return Counter(self._programs_of_file(outline, self._version.file(self._path), 0))

    def _programs_of_file(self, outline: LaunchOutline, file: Path, depth: int) -> Iterator[Program]:
        for entry in outline.entries:
            if entry.kind in _STARTING and condition_holds(outline.resolve(entry.settings.get(CONDITION, ""))) is False:
                continue
            if entry.kind == "include":
                yield from self._programs_of_action(entry, outline, file, depth)
            elif entry.kind in _STARTING and not offers_nothing(entry):
                yield entry.kind, outline.resolve(entry.name)

    def _programs_of_action(self, entry: Entry, outline: LaunchOutline, file: Path, depth: int) -> Iterator[Program]:
        resolved = replace(entry, name=outline.resolve(entry.name))
        inner_file = self._file_of(resolved, file) if depth < _MAX_DEPTH else None
        inner = None if inner_file is None else self._read_outline(inner_file)
        if inner_file is None or inner is None:
            if not _FILE_WITHOUT_NODES.search(resolved.name):
                yield resolved.kind, resolved.name
            return
        passed = {name: outline.resolve(value) for name, value in entry.settings.items()}
        inherited = {} if outline.is_ros1 or inner.is_ros1 else outline.values
        yield from self._programs_of_file(inner.with_defaults({**inherited, **passed}), inner_file, depth + 1)

    def _read_outline(self, file: Path) -> LaunchOutline | None:
        if file not in self._outlines:
            self._outlines[file] = _try_read_outline(file, self._version.root)
        return self._outlines[file]

    def undeclared_arguments(self) -> dict[str, Entry]:
        """Return the undeclared arguments without a default, each with the first action that uses it.

        Arguments that a file of another package may declare, and actions that cannot be read, are left out.
        """
        entries = self.outline.entries
        if any(entry.kind == "action" or (entry.has_value and "$(" in entry.name) for entry in entries):
            return {}
        outlines = [self.outline, *self._included.values()]
        declared = {entry.name for outline in outlines for entry in outline.entries if entry.has_value}
        file = self._version.file(self._path)
        unknown = [
            entry.span.line for entry in entries if entry.kind == "include" and self._file_of(entry, file) is None
        ]
        undeclared: dict[str, Entry] = {}
        for entry in entries:
            if unknown and entry.span.line > min(unknown):
                continue
            for text in (entry.name, *entry.settings.values()):
                for match in _USED_ARGUMENT.finditer(text):
                    if match["name"] not in declared:
                        undeclared.setdefault(match["name"], entry)
        return undeclared


def callers_of(version: Version, path: str, name: str) -> Iterator[tuple[LaunchOutline, Entry]]:
    """Yield the callers of a launch file that contain a name, each with the including action.

    Args:
        version: the version of the repository.
        path: the path of the included file, relative to the root.
        name: the name to search for, such as the name of an argument.
    """
    key = launch_file_key(path)
    for caller in version.paths(_LAUNCH_SUFFIXES):
        text = version.text(caller) if caller != path else ""
        outline = _try_read_outline(version.file(caller), version.root) if key in text and name in text else None
        if outline is not None:
            includes = (entry for entry in outline.entries if entry.kind == "include")
            yield from ((outline, entry) for entry in includes if launch_file_key(entry.name) == key)


def _file_below(share: Path, path: str) -> Path | None:
    """Return a file of a package. The build may install it in a folder other than its source folder."""
    if (share / path).is_file() or ".." in Path(path).parts:
        return share / path
    found = [file for file in sorted(share.rglob(Path(path).name)) if file.is_file()]
    return found[0] if len(found) == 1 else None


def file_with_moved_action(entry: Entry, versions: Versions, path: str, *, is_removed: bool) -> str | None:
    """Return the other changed launch file to or from which an action moved, or None if there is none.

    Args:
        entry: the action.
        versions: both versions.
        path: the path of the launch file, in the version that has the action.
        is_removed: True if the new version of the file lacks the action, False if the old one does.
    """
    if entry.kind not in ("node", "include"):
        return None
    key = _move_key(entry)
    for file in versions.changed_files[:_MAX_CHANGED]:
        if path in (file.old_path, file.new_path) or not is_launch_file(file.path):
            continue
        old = _move_keys(versions.old.file(file.old_path), versions.old.root) if file.old_path else frozenset()
        new = _move_keys(versions.new.file(file.new_path), versions.new.root) if file.new_path else frozenset()
        if (key in new) > (key in old) if is_removed else (key in old) > (key in new):
            return file.new_path if is_removed else file.old_path
    return None


def _move_key(entry: Entry) -> _Key:
    """Return the properties that an action keeps when it moves to another file."""
    return entry.kind, entry.name, entry.settings.get("name"), tuple(served_names(entry))


@lru_cache(maxsize=256)
def _move_keys(file: Path, root: Path) -> frozenset[_Key]:
    """Return the keys of the actions of a file. The result is cached: the file does not change during a review."""
    outline = _try_read_outline(file, root)
    return frozenset() if outline is None else frozenset(map(_move_key, outline.entries))


def _try_read_outline(file: Path, root: Path) -> LaunchOutline | None:
    try:
        return read_outline(file, root) if file.stat().st_size <= _MAX_BYTES else None
    except (LinkwrightError, UnreadableFileError, OSError, ValueError, RecursionError):
        return None
