"""Read the files that a launch file includes, if the repository has them."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

from linkwright.diagnostics import LinkwrightError, Phrase
from linkwright.review.caching import cached_in_review
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.launch_paths import is_launch_file
from linkwright.review.launches.argument_uses import USED_ARGUMENT, find_defaulted_arguments, uses_argument
from linkwright.review.launches.bridged_topics import find_bridged_topics
from linkwright.review.launches.common_files import find_known_arguments, find_starting_include
from linkwright.review.launches.conditions import evaluate_condition
from linkwright.review.launches.effects import offers_nothing
from linkwright.review.launches.matching import get_launch_file_stem
from linkwright.review.launches.outlines import CONDITION, Entry, LaunchOutline, without_condition
from linkwright.review.launches.reading import read_outline
from linkwright.review.launches.static_transforms import compare_transforms
from linkwright.review.launches.titles import find_served_names
from linkwright.review.sources.names import PYTHON_SUFFIX
from linkwright.review.versions import Version, Versions

_ARGUMENT = re.compile(r"\$\((?:var|arg) ")
_PACKAGE_PATH = re.compile(r"\$\(find(?:-pkg-share)? (?P<package>[\w.-]+)\)/(?P<path>[^$]+)")
_OWN_FOLDER = "$(dirname)/"
_MOVABLE_KINDS = ("node", "include", "process", "argument")
STARTING_KINDS = ("node", "include", "process", "action")
MAX_INCLUDE_DEPTH = 3
_MAX_INCLUDED_FILES = 30
_MAX_BYTES = 1 << 20
_MAX_SEARCHED_FILES = 60
_LAUNCH_SUFFIXES = (".launch", ".xml", "launch.py", "launch.yaml", "launch.yml")
Program = tuple[str, str]
"""The kind and the name of an action that starts a program."""
_FILE_WITHOUT_NODES = re.compile(
    r"rviz|rqt|[^/]*gui[^/]*$|(^|[/_])(machines?|upload(_\w+)?|params?|parameters)[._]launch"
)
"""The files that, judging by their name, start no programs for other programs."""
_MoveKey = tuple[str, str, "str | None", tuple[str, ...]]
"""The kind, the name, the name of the node and the names that it serves."""
_USED_ARGUMENT = re.compile(r"\$\((?:var|arg) (?P<name>[\w./-]+)\)")


class IncludedFile(NamedTuple):
    """An included launch file.

    Attributes:
        file: the path of the file.
        outline: the actions of the file; the arguments that the including file passes are the defaults.
    """

    file: Path
    outline: LaunchOutline


class UndeclaredArgument(NamedTuple):
    """An argument that a launch file uses and that neither it nor a file of the repository declares.

    Attributes:
        entry: the first action that uses it, or that includes a file which does.
        is_certain: whether no included file of another package may declare it.
    """

    entry: Entry
    is_certain: bool


class IncludedActions:
    """The actions of the files that a launch file includes.

    Args:
        version: the version of the repository.
        path: the path of the launch file, relative to the root.
        outline: the actions of the file.

    Attributes:
        path: the path of the launch file, relative to the root.
        outline: the actions of the file.
    """

    def __init__(self, version: Version, path: str, outline: LaunchOutline) -> None:
        self._version = version
        self.path = path
        self.outline = outline
        self._outlines: dict[Path, LaunchOutline | None] = {}

    @property
    def file(self) -> Path:
        """The launch file."""
        return self._version.file(self.path)

    def find_path(self, file: Path) -> str | None:
        """Return the path of a file relative to the root, or None if it is outside of the repository."""
        return self._version.relative(file)

    def find_unmatched_file(self, entry: Entry, other: IncludedActions) -> str | None:
        """Return the included file with an action that the other version does not include.

        It may be a file of a common package, as it is written. The result is None if there is no such file.
        """
        if entry.kind not in _MOVABLE_KINDS or other._find_file_with(entry):
            return None
        file = self._find_file_with(entry)
        if file is None and other._find_common_file_with(entry, other.outline) is None:
            file = self._find_common_file_with(entry, other.outline)
        return file

    def _find_common_file_with(self, entry: Entry, own: LaunchOutline) -> str | None:
        """Return the included file of a common package that starts a node of an outline, or None."""
        for outline in (self.outline, *self._included.values()):
            include = find_starting_include(entry, own, outline)
            if include is not None:
                return include.name
        return None

    def offers_bridged_topic(self, name: str) -> bool:
        """Return whether a bridge of Gazebo in the file or in its included files publishes a topic."""
        for outline in (self.outline, *self._included.values()):
            for entry in outline.entries if name else ():
                if name.strip("/") in find_bridged_topics(entry, outline, is_remapped=False):
                    return True
        return False

    def _find_file_with(self, entry: Entry) -> str | None:
        """Return the included file with an equal action, or None if there is none."""
        name = entry.settings.get("name")
        for path, outline in self._included.items():
            for other in outline.entries:
                is_same_action = (other.kind, other.name) == (entry.kind, entry.name)
                if is_same_action and (name is None or other.settings.get("name") in (None, name)):
                    return path
        return None

    def find_replacing_node(self, entry: Entry, old: IncludedActions) -> tuple[Entry, str] | None:
        """Return the node of a newly included file that has the name of a removed node, with the path of the file.

        Args:
            entry: the removed node.
            old: the actions of the old version.
        """
        name = entry.settings.get("name")
        if entry.kind != "node" or not name:
            return None
        for path, outline in self._included.items():
            named = [other for other in outline.entries if other.kind == "node" and other.settings.get("name") == name]
            if named and path not in old._included:
                return (named[0], path) if len(named) == 1 and named[0].name != entry.name else None
        return None

    @property
    def included_outlines(self) -> list[LaunchOutline]:
        """The outlines of the included files of the repository."""
        return list(self._included.values())

    @cached_property
    def _included(self) -> dict[str, LaunchOutline]:
        """The outlines of the included files, by path."""
        outlines: dict[str, LaunchOutline] = {}
        queue = [(self.file, self.outline, 0)]
        for file, outline, depth in queue:
            for entry in outline.entries if depth < MAX_INCLUDE_DEPTH else ():
                included_file = self.find_included_file(entry, file)
                path = None if included_file is None else self._version.relative(included_file)
                if included_file is None or path is None or path in outlines or len(outlines) >= _MAX_INCLUDED_FILES:
                    continue
                included_outline = self._read_outline(included_file)
                if included_outline is not None:
                    outlines[path] = included_outline
                    queue.append((included_file, included_outline, depth + 1))
        return outlines

    def find_included_file(self, entry: Entry, includer: Path) -> Path | None:
        """Return the file that an action includes, or None if the repository does not have it."""
        if entry.kind != "include":
            return None
        package_path = _PACKAGE_PATH.fullmatch(entry.name)
        if package_path is not None:
            package_folder = self._version.share_of(package_path["package"], includer.parent)
            if package_folder is None:  # a package without package.xml, as rosbuild has
                package_folder = next(
                    (folder for folder in includer.parents if folder.name == package_path["package"]), None
                )
            file = None if package_folder is None else _find_package_file(package_folder, package_path["path"])
        elif entry.name.startswith(_OWN_FOLDER) and "$" not in entry.name.removeprefix(_OWN_FOLDER):
            file = includer.parent / entry.name.removeprefix(_OWN_FOLDER)
        else:
            file = None
        return None if file is None or ".." in file.parts or not file.is_file() else file

    def count_started_programs(self, entry: Entry) -> Counter[Program]:
        """Count the shared programs that an included file starts by default.

        An unknown file counts as one program.
        """
        return Counter(self._find_action_programs(entry, self.outline, self.file, 0))

    def count_all_started_programs(self, values: Mapping[str, str] | None = None) -> Counter[Program]:
        """Count the shared programs that the launch file and its included files start by default.

        Args:
            values: the defaults that replace those of the file, by argument name.
        """
        outline = self.outline.with_defaults(values) if values else self.outline
        return Counter(self._find_file_programs(outline, self.file, 0))

    def _find_file_programs(self, outline: LaunchOutline, file: Path, depth: int) -> Iterator[Program]:
        """Yield the shared programs that a launch file starts by default."""
        for entry in outline.entries:
            if (
                entry.kind in STARTING_KINDS
                and evaluate_condition(outline.resolve(entry.settings.get(CONDITION, ""))) is False
            ):
                continue
            if entry.kind == "include":
                yield from self._find_action_programs(entry, outline, file, depth)
            elif entry.kind in STARTING_KINDS and not offers_nothing(entry):
                yield entry.kind, outline.resolve(entry.name)

    def _find_action_programs(self, entry: Entry, outline: LaunchOutline, file: Path, depth: int) -> Iterator[Program]:
        """Yield the shared programs that an include starts by default."""
        included = self.read_included_file(entry, outline, file) if depth < MAX_INCLUDE_DEPTH else None
        if included is not None:
            yield from self._find_file_programs(included.outline, included.file, depth + 1)
            return
        name = outline.resolve(entry.name)
        if not _FILE_WITHOUT_NODES.search(name):
            yield entry.kind, name

    def read_included_file(self, entry: Entry, outline: LaunchOutline, file: Path) -> IncludedFile | None:
        """Return the file that an action includes, or None if the repository does not have it or cannot read it.

        Args:
            entry: the action.
            outline: the actions of the including file.
            file: the including file.
        """
        included_file = self.find_included_file(replace(entry, name=outline.resolve(entry.name)), file)
        included_outline = None if included_file is None else self._read_outline(included_file)
        if included_file is None or included_outline is None:
            return None
        passed_values = {
            name: _name_callers_variables(outline.resolve(value), entry.settings)
            for name, value in entry.settings.items()
        }
        inherited_values = {} if outline.is_ros1 or included_outline.is_ros1 else outline.values
        return IncludedFile(included_file, included_outline.with_defaults({**inherited_values, **passed_values}))

    def _read_outline(self, file: Path) -> LaunchOutline | None:
        if file not in self._outlines:
            self._outlines[file] = _try_read_outline(file, self._version.root)
        return self._outlines[file]

    def find_undeclared_arguments(self, depth: int = 0) -> dict[str, UndeclaredArgument]:
        """Return the undeclared arguments without a default, also those of included files of ROS 2.

        Each comes with the first action that uses it, or that includes a file which does. Actions that cannot be read
        are left out. An argument for which the launch file has a default of its own elsewhere is not declared by
        files of other packages.
        """
        entries = self.outline.entries
        if self.outline.has_unknown_actions or any(
            entry.kind == "action" or (entry.has_value and "$(" in entry.name) for entry in entries
        ):
            return {}
        outlines = [self.outline, *(() if self.outline.is_ros1 else self._included.values())]
        declared = {entry.name for outline in outlines for entry in outline.entries if entry.has_value}
        unknown_includes = [
            entry
            for entry in entries
            if entry.kind == "include"
            and not self.outline.is_ros1
            and self.find_included_file(entry, self.file) is None
        ]
        defaulted = find_defaulted_arguments(self.file) if unknown_includes else frozenset()
        undeclared: dict[str, UndeclaredArgument] = {}
        for entry in entries:
            used = [name for text in (entry.name, *entry.settings.values()) for name in _USED_ARGUMENT.findall(text)]
            missing = sorted(self._find_missing_arguments(entry, depth))
            for name in (*used, *missing):
                may_be_declared = any(self._may_declare(include, name, entry) for include in unknown_includes)
                is_certain = not may_be_declared or (name in defaulted and name in used)
                if name not in declared and (name not in undeclared or is_certain > undeclared[name].is_certain):
                    undeclared[name] = UndeclaredArgument(entry, is_certain)
        return undeclared

    def _find_missing_arguments(self, include: Entry, depth: int) -> set[str]:
        """Return the arguments that an included file of ROS 2 uses, and that neither it nor the include sets."""
        file = (
            None if self.outline.is_ros1 or depth >= MAX_INCLUDE_DEPTH else self.find_included_file(include, self.file)
        )
        outline = None if file is None else self._read_outline(file)
        path = None if file is None else self._version.relative(file)
        holds = evaluate_condition(self.outline.resolve(include.settings.get(CONDITION, "")))
        if outline is None or path is None or outline.is_ros1 or holds is False:
            return set()
        passed = {without_condition(setting) for setting in include.settings}
        undeclared = IncludedActions(self._version, path, outline).find_undeclared_arguments(depth + 1)
        return {name for name, argument in undeclared.items() if argument.is_certain} - passed

    def find_node(self, program: re.Pattern[str]) -> Entry | None:
        """Return a node of the launch file or of its included files whose program matches a pattern, or None."""
        outlines = (self.outline, *self._included.values())
        entries = (entry for outline in outlines for entry in outline.entries if entry.kind == "node")
        return next((entry for entry in entries if program.match(entry.name)), None)

    def may_use(self, name: str) -> bool:
        """Return whether a file that the launch file of ROS 2 includes uses an argument, which it gets from there."""
        files = [] if self.outline.is_ros1 else self._included.items()
        return any(uses_argument(self._version.file(path), name, outline.entries) for path, outline in files)

    def passes_on(self, name: str) -> bool:
        """Return whether an included file of ROS 2 uses an argument that the include does not set.

        It gets the value of the callers of the launch file.
        """
        for entry in self.outline.entries:
            file = None if name in map(without_condition, entry.settings) else self.find_included_file(entry, self.file)
            outline = None if file is None else self._read_outline(file)
            path = None if file is None else self._version.relative(file)
            if file is None or outline is None or path is None:
                continue
            if uses_argument(file, name, outline.entries) or IncludedActions(self._version, path, outline).may_use(
                name
            ):
                return True
        return False

    def find_declaration(self, name: str) -> tuple[str, str | None] | None:
        """Return an included file of ROS 2 that declares and uses an argument which the include does not set, or None.

        The file gets the value of the callers of the launch file. It comes with the default of the argument.
        """
        for include in self.outline.entries:
            holds = evaluate_condition(self.outline.resolve(include.settings.get(CONDITION, "")))
            if include.kind != "include" or holds is False or name in map(without_condition, include.settings):
                continue
            file = self.find_included_file(include, self.file)
            outline = None if file is None else self._read_outline(file)
            path = None if file is None else self._version.relative(file)
            if file is None or outline is None or path is None or outline.is_ros1 or self.outline.is_ros1:
                continue
            declaration = next(
                (entry for entry in outline.entries if entry.kind == "argument" and entry.name == name), None
            )
            if declaration is not None and uses_argument(file, name, outline.entries):
                return path, declaration.settings.get("default")
        return None

    def passes_to_unknown_file(self, name: str) -> bool:
        """Return whether the launch file passes the value of an argument to a file outside of the repository."""
        includes = [entry for entry in self.outline.entries if entry.kind == "include"]
        return any(
            self._is_unknown(entry) and name in USED_ARGUMENT.findall(value)
            for entry in includes
            for setting, value in entry.settings.items()
            if setting != CONDITION
        )

    def _may_declare(self, include: Entry, name: str, user: Entry) -> bool:
        """Return whether a file outside of the repository may declare an argument that a later action uses.

        A file that a group includes declares arguments only for the actions of the group. In Python, the order of the
        lines does not tell the order of the actions.
        """
        known = find_known_arguments(include.name)
        is_around = user.groups[: len(include.groups)] == include.groups
        is_before = include.span.line < user.span.line or (include is not user and self.file.suffix == PYTHON_SUFFIX)
        return is_before and is_around and (known is None or name in known)

    def _is_unknown(self, include: Entry) -> bool:
        resolved = replace(include, name=self.outline.resolve(include.name))
        return self.find_included_file(resolved, self.file) is None


def _name_callers_variables(value: str, passed: Collection[str]) -> str:
    """Return a passed value in which unknown arguments of the including file differ from those of the included one.

    Args:
        value: the value.
        passed: the names of the arguments that the included file gets.
    """
    return _USED_ARGUMENT.sub(
        lambda match: f"$({match['name']} of the including file)" if match["name"] in passed else match[0], value
    )


def find_callers(version: Version, path: str, name: str) -> Iterator[tuple[LaunchOutline, Entry]]:
    """Yield the callers of a launch file that contain a name, each with the including action.

    Args:
        version: the version of the repository.
        path: the path of the included file, relative to the root.
        name: the name to search for, such as the name of an argument.
    """
    yield from ((actions.outline, entry) for actions, entry in find_including_files(version, path, name))


def find_including_files(version: Version, path: str, name: str = "") -> Iterator[tuple[IncludedActions, Entry]]:
    """Yield the launch files that include another one and contain a name, each with the including action."""
    key = get_launch_file_stem(path)
    for caller in version.paths(_LAUNCH_SUFFIXES):
        text = version.text(caller) if caller != path else ""
        outline = _try_read_outline(version.file(caller), version.root) if key in text and name in text else None
        if outline is None:
            continue
        actions = IncludedActions(version, caller, outline)
        for entry in outline.entries:
            if entry.kind == "include" and get_launch_file_stem(entry.name) == key:
                file = actions.find_included_file(entry, actions.file)
                if file is None or version.relative(file) == path:  # another package may have a file of that name
                    yield actions, entry


def _find_package_file(package_folder: Path, path: str) -> Path | None:
    """Return a file of a package, or None if it is unknown.

    The build may install the file in a folder other than its source folder.
    """
    if (package_folder / path).is_file() or ".." in Path(path).parts:
        return package_folder / path
    files = [file for file in sorted(package_folder.rglob(Path(path).name)) if file.is_file()]
    return files[0] if len(files) == 1 else None


def find_equal_action(entry: Entry, outline: LaunchOutline) -> Entry | None:
    """Return an action of an outline that starts the same programs with the same settings, or None."""
    if entry.kind not in STARTING_KINDS or entry.is_unknown_node:
        return None
    return next((other for other in outline.entries if replace(entry, span=other.span) == other), None)


def find_files_with_moved_action(
    entry: Entry, versions: Versions, path: str, other: LaunchOutline, *, is_removed: bool
) -> Iterator[str]:
    """Yield the changed launch files to or from which an action moved.

    Args:
        entry: the action.
        versions: both versions.
        path: the path of the launch file, in the version that has the action.
        other: the outline of the other version of the launch file, where the action did not move if an equal one is.
        is_removed: True if the new version of the file lacks the action, False if the old one does.
    """
    if entry.kind not in ("node", "include") or find_equal_action(entry, other) is not None:
        return
    key = _make_move_key(entry)
    for file in versions.changed_files[:_MAX_SEARCHED_FILES]:
        if path in (file.old_path, file.new_path) or not is_launch_file(file.path):
            continue
        old = _read_move_keys(versions.old.file(file.old_path), versions.old.root) if file.old_path else frozenset()
        new = _read_move_keys(versions.new.file(file.new_path), versions.new.root) if file.new_path else frozenset()
        moved_path = file.new_path if is_removed else file.old_path
        if moved_path and ((key in new) > (key in old) if is_removed else (key in old) > (key in new)):
            yield moved_path


def compare_moved_transform(entry: Entry, versions: Versions, old_path: str) -> Phrase | None:
    """Return the change to the transform of a publisher that moved from another launch file.

    The result is None if the arguments are equal or unknown, or the action does not publish a static transform.
    """
    old = next(iter(_find_old_actions(entry, versions, old_path)), None)
    arguments = [None if other is None else other.settings.get("arguments") for other in (old, entry)]
    if old is None or arguments[0] == arguments[1]:
        return None
    return compare_transforms(old.name, entry.name, arguments[0], arguments[1])


def find_moved_settings(
    entry: Entry, versions: Versions, old_path: str, *, is_included: bool = False
) -> tuple[Entry, list[str]] | None:
    """Return what differs in an action that moved from another launch file, or None if nothing does.

    Args:
        entry: the action in the new version.
        versions: both versions.
        old_path: the path of the other launch file in the old version.
        is_included: whether the old version of the file included the other one, maybe with values for its arguments,
            so that settings that depend on arguments are not compared.

    Returns:
        The action with only the settings that are new or have another value, and the names of the settings that it
        lost.
    """
    old = _find_old_actions(entry, versions, old_path)
    if not old or any(other.settings == entry.settings for other in old):
        return None
    changed = {name: value for name, value in entry.settings.items() if old[0].settings.get(name) != value}
    lost = {name: value for name, value in old[0].settings.items() if name not in entry.settings}
    if is_included:
        before = {name: old[0].settings.get(name, "") for name in changed}
        changed = {name: value for name, value in changed.items() if not _ARGUMENT.search(f"{value}{before[name]}")}
        lost = {name: value for name, value in lost.items() if not _ARGUMENT.search(f"{name}{value}")}
    return (replace(entry, settings=changed), list(lost)) if changed or lost else None


def _find_old_actions(entry: Entry, versions: Versions, old_path: str) -> list[Entry]:
    """Return the actions of the old version of a launch file that an action of another file may be."""
    outline = _try_read_outline(versions.old.file(old_path), versions.old.root)
    key = _make_move_key(entry)
    return [] if outline is None else [other for other in outline.entries if _make_move_key(other) == key]


def _make_move_key(entry: Entry) -> _MoveKey:
    """Return the properties that an action keeps when it moves to another file."""
    return entry.kind, entry.name, entry.settings.get("name"), tuple(find_served_names(entry))


@cached_in_review(maxsize=256)
def _read_move_keys(file: Path, root: Path) -> frozenset[_MoveKey]:
    """Return the keys of the actions of a file.

    The result is cached because the file does not change during a review.
    """
    outline = _try_read_outline(file, root)
    return frozenset() if outline is None else frozenset(map(_make_move_key, outline.entries))


def _try_read_outline(file: Path, root: Path) -> LaunchOutline | None:
    try:
        return read_outline(file, root) if file.stat().st_size <= _MAX_BYTES else None
    except (LinkwrightError, UnreadableFileError, OSError, ValueError, RecursionError):
        return None
