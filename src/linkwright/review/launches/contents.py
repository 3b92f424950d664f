"""Summarize an added launch file in one line."""

from __future__ import annotations

from linkwright.diagnostics import Phrase, joined_first, phrase
from linkwright.review.changes import MAX_NAMES
from linkwright.review.launches.outlines import READING, SERVER_PARAMETER, TEST, Entry
from linkwright.review.launches.reading import read_outline
from linkwright.review.launches.titles import format_settings, format_title
from linkwright.review.versions import Version

_SHOWN_KINDS = (
    "node", TEST, "process", "action", "include", "parameters", "parameter", SERVER_PARAMETER, "remapping",
    "environment",
    READING, "handler", "argument",
)  # fmt: skip
_MAX_SETTINGS = 8
"""The maximum number of settings of each action in the line."""


def launch_contents(version: Version, path: str) -> Phrase | None:
    """Summarize the actions of a launch file, or return None if it has none.

    The summary lists nodes, processes, includes, parameters, event handlers and arguments.

    Args:
        version: the version that contains the file.
        path: the path of the file, relative to the root.

    Raises:
        LinkwrightError, UnreadableFileError, OSError, ValueError: the file cannot be read.
    """
    entries = read_outline(version.file(path), version.root).entries
    entries = [
        entry for entry in entries if entry.kind in _SHOWN_KINDS and not (entry.kind == READING and entry.settings)
    ]
    sorted_entries = sorted(entries, key=lambda entry: _SHOWN_KINDS.index(entry.kind))
    titles = list(dict.fromkeys(map(_format_title_with_settings, sorted_entries)))
    return joined_first(titles, MAX_NAMES) if titles else None


def _format_title_with_settings(entry: Entry) -> Phrase:
    """Return the title of an action with its settings, such as the default of an argument."""
    items = format_settings(entry, _MAX_SETTINGS)
    if entry.kind == READING:
        return phrase("{entry} (required)", entry=format_title(entry))
    if entry.kind == "argument" and not {"default", "value"} & entry.settings.keys():
        if items is None:
            return phrase("{entry} (required)", entry=format_title(entry))
        return phrase("{entry} ({items}, required)", entry=format_title(entry), items=items)
    return format_title(entry) if items is None else phrase("{entry} ({items})", entry=format_title(entry), items=items)
