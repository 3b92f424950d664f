"""The files of descriptions, each parsed once in a process until it changes."""

from __future__ import annotations

import os

from linkwright.xacro.cache import BoundedCache
from linkwright.xmltree import Document, Overlay, parse_file

_LINKS = f"{os.sep}shares{os.sep}"
_MOST_TEXT = 24_000_000
"""How many bytes the files that are kept have together, which a thousand robots have; a parsed one takes fifteen times
as much memory."""
cache: BoundedCache[tuple[str, str], tuple[int, int, Document]] = BoundedCache(_MOST_TEXT, lambda _, file: file[1])
"""Path and current folder -> time of change, size and document."""


def read(path: str, overlay: Overlay | None = None) -> Document:
    """Return the document of a file, which is shared and must not be changed.

    Args:
        path: the file.
        overlay: the texts that replace those of files.

    Raises:
        LinkwrightError: see `linkwright.xmltree.parse_file`.
    """
    if _LINKS in path:  # a link folder of an unbuilt package
        from linkwright.packages.share_layout import source_of  # few robots need the packages room for this

        path = source_of(path)
    unsaved = None if overlay is None else overlay.document(path)
    if unsaved is not None:
        return unsaved
    key = (path, "" if os.path.isabs(path) else os.getcwd())  # noqa: PTH109, PTH117 - strings are faster and shown
    try:
        status = os.stat(path)  # noqa: PTH116
    except (OSError, ValueError):
        return parse_file(path)  # raises the error with the reason
    known = cache.values.get(key)
    if known is not None and known[:2] == (status.st_mtime_ns, status.st_size):
        return known[2]
    document = parse_file(path)
    cache.store(key, (status.st_mtime_ns, status.st_size, document))
    return document
