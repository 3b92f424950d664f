"""Summarize an added launch file in one line."""

from __future__ import annotations

from linkwright.diagnostics import Phrase, joined_first, phrase
from linkwright.review.changes import MAX_NAMES
from linkwright.review.launches.outlines import READING, SERVER_PARAMETER, Entry
from linkwright.review.launches.reading import read_outline
from linkwright.review.launches.titles import settings_text, title
from linkwright.review.versions import Version

_KINDS = (
    "node", "process", "include", "parameters", "parameter", SERVER_PARAMETER, "remapping", "environment", READING,
    "argument",
)  # fmt: skip
_MAX_SETTINGS = 8
"""The maximum number of settings of each action in the line."""


def launch_contents(version: Version, path: str) -> Phrase | None:
    """Return the nodes, processes, includes, parameters and arguments of a launch file, or None if there are none.

    Args:
        version: the version that contains the file.
        path: the path of the file, relative to the root.

    Raises:
        LinkwrightError, UnreadableFileError, OSError, ValueError: the file cannot be read.
    """
    entries = read_outline(version.file(path), version.root).entries
    entries = [entry for entry in entries if entry.kind in _KINDS and not (entry.kind == READING and entry.settings)]
    shown = sorted(entries, key=lambda entry: _KINDS.index(entry.kind))
    titles = list(dict.fromkeys(map(_title_with_settings, shown)))
    return joined_first(titles, MAX_NAMES) if titles else None


def _title_with_settings(entry: Entry) -> Phrase:
    """Return the title of an action with its settings, such as the default of an argument."""
    items = settings_text(entry, _MAX_SETTINGS)
    if entry.kind == READING:
        return phrase("{entry} (required)", entry=title(entry))
    if entry.kind == "argument" and not {"default", "value"} & entry.settings.keys():
        if items is None:
            return phrase("{entry} (required)", entry=title(entry))
        return phrase("{entry} ({items}, required)", entry=title(entry), items=items)
    return title(entry) if items is None else phrase("{entry} ({items})", entry=title(entry), items=items)
