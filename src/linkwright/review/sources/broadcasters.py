"""Find sources that newly broadcast the transform of a frame."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from pathlib import Path

from linkwright.diagnostics import LinkwrightError
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.sources.names import CPP_SUFFIXES, PYTHON_SUFFIX, NameKind
from linkwright.review.sources.reading import read_source_names
from linkwright.review.versions import Versions

_BROADCASTER = "TransformBroadcaster"
_SWITCH = re.compile(r"[\"'/]\w*(?:publish|broadcast|enable|send|use)\w*_(?:tf|transform)\w*[\"']", re.IGNORECASE)
"""A parameter that may turn the transform off."""


def find_new_broadcasters(versions: Versions, frames: Collection[str]) -> Iterator[str]:
    """Yield the paths of the changed sources that newly broadcast a transform between frames.

    A source with a parameter that may turn the transform off is left out.

    Args:
        versions: both versions of the repository.
        frames: the parent and the child frame, without leading slashes.
    """
    for file in versions.changed_files:
        path = file.new_path
        if path is None or file.is_submodule or not path.endswith((*CPP_SUFFIXES, PYTHON_SUFFIX)):
            continue
        text = versions.new.text(path)
        if _BROADCASTER not in text or not all(frame in text for frame in frames) or _SWITCH.search(text) is not None:
            continue
        old = set() if file.old_path is None else _read_frames(versions.old.file(file.old_path))
        if _read_frames(versions.new.file(path)).issuperset(frames) and not old.issuperset(frames):
            yield path


def _read_frames(file: Path) -> set[str]:
    """Return the frames of the transforms and messages of a source; empty if it broadcasts none or is unreadable."""
    try:
        if _BROADCASTER not in file.read_text("utf-8", errors="replace"):
            return set()
        names = read_source_names(file).names
    except (LinkwrightError, UnreadableFileError, OSError, ValueError, RecursionError):
        return set()
    kinds = (NameKind.FRAME, NameKind.MESSAGE_FRAME)
    return {item.name.strip("/") for item in names if item.kind in kinds}
