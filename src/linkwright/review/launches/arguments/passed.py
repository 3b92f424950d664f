"""Find launch files that pass an argument which the included file does not declare, or no longer."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import PurePosixPath

from linkwright.diagnostics import Phrase, counted, joined, phrase, quoted_names
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import MAX_NAMES, Change, Effect, Location
from linkwright.review.launch_paths import find_launch_files, is_launch_file
from linkwright.review.launches.argument_uses import read_code
from linkwright.review.launches.arguments.chosen_files import find_chosen_files
from linkwright.review.launches.included import IncludedActions
from linkwright.review.launches.outlines import (
    CONDITION,
    ENVIRONMENT,
    NAMESPACE_OF_INCLUDED,
    PASSES_ALL_ARGUMENTS,
    Entry,
    without_condition,
)
from linkwright.review.launches.programs.sources import try_read_outline
from linkwright.review.versions import TEST_FOLDERS, Version, Versions


def find_passed_arguments(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the launch files that pass an argument which a changed file no longer declares, each with a change.

    In ROS 2, an included file may use any argument of its caller. An argument counts if the included files of the
    repository do not use it, and the old version did not pass it to other files.
    """
    lost = {
        file.new_path: names
        for file in changed_files
        if file.old_path and file.new_path and is_launch_file(file.path)
        if (names := _find_lost_arguments(versions, file.old_path, file.new_path))
    }
    for path in find_launch_files(versions.new) if lost else ():
        text = versions.new.text(path)
        if not TEST_FOLDERS.isdisjoint(PurePosixPath(path).parts):
            continue
        if any(PurePosixPath(file).name in text and any(name in text for name in lost[file]) for file in lost):
            yield from ((path, change) for change in _check_caller(versions.new, path, lost))


def _find_lost_arguments(versions: Versions, old_path: str, new_path: str) -> dict[str, Phrase]:
    """Return the arguments that only the old version of a launch file declares, with the effect on callers."""
    old, new = try_read_outline(versions.old, old_path), try_read_outline(versions.new, new_path)
    if old is None or new is None or old.is_ros1 != new.is_ros1:
        return {}
    remaining = {entry.name for entry in new.entries if entry.has_value}
    names = {entry.name for entry in old.entries if entry.kind == "argument"} - remaining
    if new.is_ros1:
        return {name: phrase("the include fails") for name in sorted(names)}
    if new.has_unknown_actions or any(entry.kind == "action" for entry in new.entries):
        return {}
    text = read_code(versions.new.file(new_path))
    actions = IncludedActions(versions.new, new_path, new)
    old_actions = IncludedActions(versions.old, old_path, old)
    used = {name for name in names if names_outside_of_keys(text, name)}
    used |= {name for name in names if actions.passes_on(name) or old_actions.passes_to_unknown_file(name)}
    return {name: phrase("the value has no effect") for name in sorted(names - used)}


def names_outside_of_keys(text: str, name: str) -> bool:
    """Return whether a text contains a name, except as a key such as ``'NAME': ...`` of an argument that it passes."""
    return re.search(rf"(?<![\w.-]){re.escape(name)}(?![\w.-]|[\"']\s*:)", text) is not None


def _check_caller(version: Version, path: str, lost: dict[str, dict[str, Phrase]]) -> Iterator[Change]:
    for entry, included_path, passed in find_passed(version, path):
        names = lost.get(included_path, {})
        for name in (name for name in names if name in passed):
            values = {"name": name, "file": included_path}
            text = phrase("passes '{name}' to '{file}', which no longer has the argument", **values)
            yield Change(text, Effect.BREAKING, names[name], Location(path, entry.span.line, entry.span.column))


def find_refused_arguments(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the changed launch files of ROS 1 that newly pass an argument which the included file never declared."""
    old_paths = {file.new_path: file.old_path for file in changed_files if file.old_path and file.new_path}
    for file in changed_files:
        if not (file.old_path and file.new_path and is_launch_file(file.new_path)):
            continue
        known = set(_find_refused(versions.old, file.old_path))
        for (included_path, name), entry in _find_refused(versions.new, file.new_path).items():
            old_included_path = old_paths.get(included_path, included_path)
            old = try_read_outline(versions.old, old_included_path)
            was_declared = old is not None and any(other.has_value and other.name == name for other in old.entries)
            if (old_included_path, name) in known or was_declared:
                continue
            text = phrase("passes '{name}' to '{file}', which has no such argument", name=name, file=included_path)
            location = Location(file.new_path, entry.span.line, entry.span.column)
            yield file.new_path, Change(text, Effect.BREAKING, phrase("the include fails"), location)
        yield from _check_chosen_files(versions, file.old_path, file.new_path)


def _check_chosen_files(versions: Versions, old_path: str, new_path: str) -> Iterator[tuple[str, Change]]:
    """Yield the includes of ROS 1 that fail with other values of the argument that chooses the file.

    A file counts if the old version had it and did not refuse the include, and if another value chooses a file that
    declares all passed arguments.
    """
    old = _find_chosen_refusals(versions.old, old_path)
    old_refused = {path for _, files in old for path, names in files.values() if names}
    for entry, files in _find_chosen_refusals(versions.new, new_path):
        refused = {
            word: names
            for word, (path, names) in files.items()
            if names and path not in old_refused and versions.old.file(path).is_file()
        }
        if not refused or all(names for _, names in files.values()):
            continue
        lacking = sorted(set().union(*refused.values()))
        text = counted(
            "passes {names} to files that do not declare it",
            "passes {names} to files that do not declare them",
            len(lacking),
            names=quoted_names(lacking),
        )
        values = joined(list(refused)[:MAX_NAMES], last=" or ")
        reason = phrase("the include fails with {values}", values=values)
        yield new_path, Change(text, Effect.BREAKING, reason, Location(new_path, entry.span.line, entry.span.column))


def _find_chosen_refusals(version: Version, path: str) -> list[tuple[Entry, dict[str, tuple[str, set[str]]]]]:
    """Return the includes of ROS 1 with the files that one argument can choose, and the arguments that each refuses."""
    outline = try_read_outline(version, path)
    found = []
    for entry in [] if outline is None or not outline.is_ros1 else outline.entries:
        chosen = find_chosen_files(version, entry.name) if entry.kind == "include" else {}
        passed = _list_passed(entry)
        files: dict[str, tuple[str, set[str]]] = {}
        for word, file in chosen.items():
            included = try_read_outline(version, file)
            if included is not None:
                files[word] = file, passed - {other.name for other in included.entries if other.has_value}
        found.append((entry, files))
    return found


def _list_passed(entry: Entry) -> set[str]:
    """Return the names of the arguments that an include passes."""
    names = {without_condition(name) for name in entry.settings if not name.startswith(ENVIRONMENT)}
    return names - {CONDITION, NAMESPACE_OF_INCLUDED, PASSES_ALL_ARGUMENTS}


def _find_refused(version: Version, path: str) -> dict[tuple[str, str], Entry]:
    """Return the includes that fail in ROS 1, by the path of the included file and the argument that it refuses."""
    refused: dict[tuple[str, str], Entry] = {}
    for entry, included_path, passed in find_passed(version, path, is_ros1=True):
        included = try_read_outline(version, included_path)
        if included is not None and included.is_ros1:
            declared = {other.name for other in included.entries if other.has_value}
            refused |= {(included_path, name): entry for name in sorted(passed - declared)}
    return refused


def find_passed(version: Version, path: str, *, is_ros1: bool = False) -> Iterator[tuple[Entry, str, set[str]]]:
    """Yield the includes of a file with the path of the included file and the names of the passed arguments.

    Args:
        version: the version of the repository.
        path: the path of the file.
        is_ros1: whether to leave out files of ROS 2.
    """
    outline = try_read_outline(version, path)
    if outline is None or (is_ros1 and not outline.is_ros1):
        return
    actions = IncludedActions(version, path, outline)
    for entry in (entry for entry in outline.entries if entry.kind == "include"):
        file = actions.find_included_file(replace(entry, name=outline.resolve(entry.name)), version.file(path))
        included_path = None if file is None else version.relative(file)
        if included_path is not None:
            yield entry, included_path, _list_passed(entry)
