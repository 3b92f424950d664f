"""Find sources that no longer publish transforms, or newly do."""

from __future__ import annotations

import re

from linkwright.diagnostics import SourceText, Span
from linkwright.files.git_repository import ChangedFile
from linkwright.review.sources.changed_sources import ChangedSources
from linkwright.review.sources.cpp_text import blank_comments
from linkwright.review.sources.names import PYTHON_SUFFIX, NameKind
from linkwright.review.sources.reading import try_read_source
from linkwright.review.versions import Version

_SEND = re.compile(r"(?:\.|->)\s*sendTransform\s*\(")
_PYTHON_COMMENT = re.compile(r"#[^\n]*")
_TOPICS = frozenset({"tf", "tf_static"})


def find_lost_sender(old: ChangedSources, new: ChangedSources, file: ChangedFile) -> Span | None:
    """Return the place where the old source publishes a transform, or None if the new one still may publish it.

    A source that newly publishes transforms may have got the code, and so may one that publishes the topic itself.
    """
    if file.old_path is None or file.new_path is None:
        return None
    span = _find_sender(old.version, file.old_path)
    if span is None or _sends(new, file.new_path):
        return None
    others = (path for path in new.paths if path != file.new_path and _sends(new, path))
    has_moved = any(_find_sender(old.version, path) is None for path in others)
    return None if has_moved else span


def find_new_sender(old: ChangedSources, new: ChangedSources, file: ChangedFile) -> Span | None:
    """Return the place where the new source publishes a transform, or None if the old one may have done so.

    A source that no longer publishes transforms may have had the code.
    """
    if file.old_path is None or file.new_path is None:
        return None
    span = _find_sender(new.version, file.new_path)
    if span is None or _sends(old, file.old_path):
        return None
    others = (path for path in old.paths if path != file.old_path and _sends(old, path))
    return None if any(_find_sender(new.version, path) is None for path in others) else span


def _sends(side: ChangedSources, path: str) -> bool:
    topics = {item.name.strip("/") for item in side.get_names(path).of_kind(NameKind.PUBLISHER)}
    return bool(topics & _TOPICS) or _find_sender(side.version, path) is not None


def _find_sender(version: Version, path: str) -> Span | None:
    """Return the place of the first call that publishes a transform, or None if the source has none."""
    source = try_read_source(version.file(path))
    match = None if source is None else _SEND.search(_blank(source, path))
    return None if source is None or match is None else source.span(match.start(), match.end())


def _blank(source: SourceText, path: str) -> str:
    if not path.endswith(PYTHON_SUFFIX):
        return blank_comments(source.text)
    return _PYTHON_COMMENT.sub(lambda match: " " * len(match[0]), source.text)
