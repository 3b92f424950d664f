"""Find sources that no longer publish transforms, or newly do."""

from __future__ import annotations

import re

from linkwright.diagnostics import SourceText, Span
from linkwright.files.git_repository import ChangedFile
from linkwright.review.sources.changed_sources import ChangedSources
from linkwright.review.sources.cpp.text import blank_comments
from linkwright.review.sources.names import PYTHON_SUFFIX, NameKind
from linkwright.review.sources.reading import try_read_source
from linkwright.review.versions import Version

_SEND = re.compile(r"(?:\.|->)\s*sendTransform\s*\(")
_PYTHON_COMMENT = re.compile(r"#[^\n]*")
_TOPICS = frozenset({"tf", "tf_static"})


def find_one_sided_sender(
    own: ChangedSources, other: ChangedSources, file: ChangedFile, *, is_old: bool
) -> Span | None:
    """Return the place where one version of a source publishes a transform, or None if the other version may do so too.

    A different source that publishes transforms only in the other version may have the code there, and so may one that
    publishes the topic itself.

    Args:
        own: the changed sources of the version.
        other: the changed sources of the other version.
        file: the source.
        is_old: whether the version is the old one.
    """
    if file.old_path is None or file.new_path is None:
        return None
    path, other_path = (file.old_path, file.new_path) if is_old else (file.new_path, file.old_path)
    span = _find_sender(own.version, path)
    if span is None or _sends(other, other_path):
        return None
    senders = (sender for sender in other.paths if sender != other_path and _sends(other, sender))
    has_moved = any(_find_sender(own.version, sender) is None for sender in senders)
    return None if has_moved else span


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
