"""Report the changed lines of scripts, device rules, container files and lists of packages."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable
from difflib import SequenceMatcher
from pathlib import PurePosixPath

from linkwright.diagnostics import Phrase, counted, joined, joined_first, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import MAX_NAMES
from linkwright.review.excerpts import differing_excerpts, shorten
from linkwright.review.versions import Versions

_SUFFIXES = frozenset({".sh", ".bash", ".zsh", ".rules", ".service", ".dockerfile"})
_FILE_NAME = re.compile(
    r"(.*\.)?(docker|container)file(\..*)?|\w*(packages?|apt|requirements?|dependencies)\w*\.txt|\.env"
)
_PACKAGE = re.compile(r"[A-Za-z0-9][\w.+:~<>=!-]*")
"""A line of a list of packages."""
_MAX_LINES = 6
"""The maximum number of changed lines that are shown, except in a list of packages."""
_MAX_LINE_LENGTH = 160
_MAX_BYTES = 1 << 18
_MIN_SIMILARITY = 0.5


def compare_lines(versions: Versions, file: ChangedFile) -> Phrase | None:
    """Return the added and removed lines of a text file, or None for other kinds of files.

    Comments and empty lines are left out. If there are many lines, only their number is given.
    """
    if file.old_path is None or file.new_path is None or file.is_submodule or not _has_lines(file.path):
        return None
    paths = versions.old.file(file.old_path), versions.new.file(file.new_path)
    try:
        if any(text.stat().st_size > _MAX_BYTES for text in paths):
            return None
        old, new = ([*_split_content_lines(text.read_text("utf-8"))] for text in paths)
    except (OSError, ValueError):
        return None
    removed, added = (list((Counter(a) - Counter(b)).elements()) for a, b in ((old, new), (new, old)))
    if not removed and not added:
        return None
    if all(map(_PACKAGE.fullmatch, (*removed, *added))):
        return _format_lines(joined_first(added, MAX_NAMES), joined_first(removed, MAX_NAMES))
    is_single_line = len(removed) == len(added) == 1
    if is_single_line and SequenceMatcher(None, removed[0], added[0], autojunk=False).ratio() >= _MIN_SIMILARITY:
        before, after = differing_excerpts(removed[0], added[0])
        return phrase("{old} -> {new}", old=before, new=after)
    if len(removed) + len(added) <= _MAX_LINES:
        return _format_lines(
            *(joined([f"`{shorten(line, _MAX_LINE_LENGTH)}`" for line in lines]) for lines in (added, removed))
        )
    counts = (counted("{count} line", "{count} lines", len(lines)) if lines else "" for lines in (added, removed))
    return _format_lines(*counts)


def _format_lines(added: Phrase | str, removed: Phrase | str) -> Phrase:
    parts = [phrase("{items} added", items=added)] if added else []
    if removed:
        parts.append(phrase("{items} removed", items=removed))
    return joined(parts, "; ")


def _has_lines(path: str) -> bool:
    name = PurePosixPath(path).name.lower()
    return PurePosixPath(name).suffix in _SUFFIXES or _FILE_NAME.fullmatch(name) is not None


def _split_content_lines(text: str) -> Iterable[str]:
    """Yield the lines of a text without comments, with continued lines as one."""
    for line in re.sub(r"\\\n\s*", "", text).splitlines():
        words = " ".join(line.split())
        if words and not words.startswith("#"):
            yield words
