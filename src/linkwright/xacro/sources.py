"""The files of descriptions, each parsed once in a process for as long as it does not change."""

from __future__ import annotations

import os

from linkwright.xmltree import Document, parse_file

_KEPT = 500
documents: dict[tuple[str, str], tuple[int, int, Document]] = {}
"""Path and current folder -> time of change, size and document."""


def read(path: str) -> Document:
    """The document of a file, which must not be changed: others read the same one.

    Raises:
        LinkwrightError: see `linkwright.xmltree.parse_file`.
    """
    key = (path, "" if os.path.isabs(path) else os.getcwd())  # noqa: PTH109, PTH117 - strings are faster and shown
    try:
        status = os.stat(path)  # noqa: PTH116
    except (OSError, ValueError):
        return parse_file(path)  # which says what is wrong
    known = documents.get(key)
    if known is not None and known[:2] == (status.st_mtime_ns, status.st_size):
        return known[2]
    document = parse_file(path)
    if len(documents) >= _KEPT:
        documents.clear()
    documents[key] = (status.st_mtime_ns, status.st_size, document)
    return document
