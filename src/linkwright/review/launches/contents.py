"""The contents of an added launch file in one line."""

from __future__ import annotations

from linkwright.diagnostics import Phrase, joined_first
from linkwright.review.launches.reading import read_outline
from linkwright.review.launches.titles import title
from linkwright.review.versions import Version

_KINDS = ("node", "process", "include", "argument")
_MAX_TITLES = 10


def launch_contents(version: Version, path: str) -> Phrase | None:
    """Return the nodes, processes, includes and arguments of a launch file, or None if there are none.

    Args:
        version: the version that has the file.
        path: the path of the file, relative to the root.

    Raises:
        LinkwrightError: the file cannot be read; also as `UnreadableFileError`, `OSError` and `ValueError`.
    """
    entries = read_outline(version.file(path), version.root).entries
    shown = sorted((entry for entry in entries if entry.kind in _KINDS), key=lambda entry: _KINDS.index(entry.kind))
    titles = list(dict.fromkeys(map(title, shown)))
    return joined_first(titles, _MAX_TITLES) if titles else None
