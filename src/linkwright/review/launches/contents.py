"""Summarize an added or removed launch file in one line."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path

from linkwright.diagnostics import Phrase, joined_first, phrase
from linkwright.review.changes import MAX_NAMES
from linkwright.review.launches.argument_uses import read_code, uses_argument
from linkwright.review.launches.included import STARTING_KINDS
from linkwright.review.launches.outlines import (
    FAILURES,
    IGNORED_TAG,
    PASSES_ALL_ARGUMENTS,
    READING,
    SERVER_PARAMETER,
    TEST,
    Entry,
    LaunchOutline,
)
from linkwright.review.launches.reading import read_outline
from linkwright.review.launches.titles import format_settings, format_title, is_required
from linkwright.review.versions import Version

_SHOWN_KINDS = (
    "node", TEST, "process", "action", "include", "parameters", "parameter", SERVER_PARAMETER, "remapping",
    "environment",
    READING, "handler", IGNORED_TAG, "argument",
)  # fmt: skip
_MAX_SETTINGS = (8, 4, 2, 1)
"""The maximum numbers of settings of each action in the line: the first with which the line is short enough counts."""
_MAX_CHARACTERS = 900
"""The maximum length of the line. Reports cut longer ones, and with them whole actions and arguments."""


def launch_contents(version: Version, path: str) -> Phrase | None:
    """Summarize the actions of a launch file, or return None if it has none.

    The summary lists nodes, processes, includes, parameters, event handlers and arguments.

    Args:
        version: the version that contains the file.
        path: the path of the file, relative to the root.

    Raises:
        LinkwrightError, UnreadableFileError, OSError, ValueError: the file cannot be read.
    """
    outline = read_outline(version.file(path), version.root)
    unused = _find_unused_arguments(version.file(path), outline)
    entries = [
        entry
        for entry in outline.entries
        if entry.kind in _SHOWN_KINDS and not (entry.kind == READING and entry.settings)
    ]
    sorted_entries = sorted(entries, key=lambda entry: _SHOWN_KINDS.index(entry.kind))
    for limit in _MAX_SETTINGS:
        titles = list(dict.fromkeys(_format_title_with_settings(entry, unused, limit) for entry in sorted_entries))
        if sum(len(str(title)) for title in titles[: MAX_NAMES + 1]) <= _MAX_CHARACTERS:
            break
    if any(not entry.settings.keys().isdisjoint(FAILURES) for entry in entries):
        return phrase(
            "{items}; an action has wrong arguments, so that the file fails", items=joined_first(titles, MAX_NAMES)
        )
    return joined_first(titles, MAX_NAMES) if titles else None


def started_contents(version: Version, path: str) -> Phrase | None:
    """Summarize an added launch file, or list what a removed one started; None if there is nothing to list.

    Raises:
        LinkwrightError, UnreadableFileError, OSError, ValueError: the file cannot be read.
    """
    if not version.is_old:
        return launch_contents(version, path)
    outline = read_outline(version.file(path), version.root)
    started = [
        _format_title_with_settings(entry, (), _MAX_SETTINGS[0]) if entry.kind == "include" else format_title(entry)
        for entry in outline.entries
        if entry.kind in STARTING_KINDS
    ]
    return joined_first(list(dict.fromkeys(started)), MAX_NAMES) if started else None


def _find_unused_arguments(file: Path, outline: LaunchOutline) -> frozenset[str]:
    """Return the arguments that certainly have no effect.

    Included files of ROS 2 and unknown actions may use any argument.
    """
    names = [entry.name for entry in outline.entries if entry.kind == "argument" and "value" not in entry.settings]
    has_include = any(entry.kind == "include" for entry in outline.entries) and not outline.is_ros1
    if not names or has_include or outline.has_unknown_actions or PASSES_ALL_ARGUMENTS in read_code(file):
        return frozenset()
    if any(entry.kind == "action" for entry in outline.entries):
        return frozenset()
    return frozenset(name for name in names if not uses_argument(file, name, outline.entries))


def _format_title_with_settings(entry: Entry, unused: Collection[str], limit: int) -> Phrase:
    """Return the title of an action with its first settings, such as the default of an argument."""
    items = format_settings(entry, limit)
    if entry.kind == READING:
        return phrase("{entry} (required)", entry=format_title(entry))
    if is_required(entry):
        if items is None:
            return phrase("{entry} (required)", entry=format_title(entry))
        return phrase("{entry} ({items}, required)", entry=format_title(entry), items=items)
    if entry.kind == "argument" and entry.name in unused and items is not None:
        return phrase("{entry} ({items}, unused)", entry=format_title(entry), items=items)
    return format_title(entry) if items is None else phrase("{entry} ({items})", entry=format_title(entry), items=items)
