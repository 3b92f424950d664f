"""Find launch files that still pass an argument which the included file no longer declares."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import PurePosixPath

from linkwright.diagnostics import LinkwrightError, Phrase, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.launch_paths import find_launch_files, is_launch_file
from linkwright.review.launches.argument_uses import read_code
from linkwright.review.launches.included import IncludedActions
from linkwright.review.launches.outlines import CONDITION, LaunchOutline, without_condition
from linkwright.review.launches.reading import read_outline
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
    old, new = _try_read(versions.old, old_path), _try_read(versions.new, new_path)
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
    used = {name for name in names if _names_outside_of_keys(text, name)}
    used |= {name for name in names if actions.passes_on(name) or old_actions.passes_to_unknown_file(name)}
    return {name: phrase("the value has no effect") for name in sorted(names - used)}


def _names_outside_of_keys(text: str, name: str) -> bool:
    """Return whether a text contains a name, except as a key such as ``'NAME': ...`` of an argument that it passes."""
    return re.search(rf"(?<![\w.-]){re.escape(name)}(?![\w.-]|[\"']\s*:)", text) is not None


def _check_caller(version: Version, path: str, lost: dict[str, dict[str, Phrase]]) -> Iterator[Change]:
    outline = _try_read(version, path)
    actions = None if outline is None else IncludedActions(version, path, outline)
    for entry in outline.entries if outline is not None else ():
        if actions is None or outline is None or entry.kind != "include":
            continue
        file = actions.find_included_file(replace(entry, name=outline.resolve(entry.name)), version.file(path))
        included_path = None if file is None else version.relative(file)
        names = lost.get(included_path or "", {})
        passed = {without_condition(name) for name in entry.settings} - {CONDITION}
        for name in (name for name in names if name in passed):
            values = {"name": name, "file": included_path}
            text = phrase("passes '{name}' to '{file}', which no longer has the argument", **values)
            yield Change(text, Effect.BREAKING, names[name], Location(path, entry.span.line, entry.span.column))


def _try_read(version: Version, path: str) -> LaunchOutline | None:
    try:
        return read_outline(version.file(path), version.root)
    except (LinkwrightError, UnreadableFileError, OSError, ValueError, RecursionError):
        return None
