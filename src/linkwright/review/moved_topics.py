"""Recognize topics of a source that a plugin of a description of the same package newly offers."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

from linkwright.review.changes import Change, Effect, Subject, SubjectKind
from linkwright.review.sources.names import NameKind

_TOPICS = re.compile(r"\btopics (?P<names>'[^']+'(?:, '[^']+')*)")
"""The topics in the line about a plugin."""
_QUOTED = re.compile(r"'([^']+)'")
_KINDS = (NameKind.PUBLISHER, NameKind.SUBSCRIPTION)


def merge_moved_topics(subjects: Sequence[Subject], find_package: Callable[[str], str | None]) -> list[Subject]:
    """Return the subjects, in which lost topics that an added plugin has are not breaking.

    Args:
        subjects: the compared files.
        find_package: a function that returns the folder of the package of a file.
    """
    offered: dict[str | None, set[str]] = {}
    for subject in subjects:
        if subject.kind in (SubjectKind.DESCRIPTION, SubjectKind.WORLD):
            names = {name for change in subject.changes for name in _list_topics(str(change.sentence))}
            offered.setdefault(find_package(subject.path), set()).update(names)
    return [_mark(subject, offered.get(find_package(subject.path), set())) for subject in subjects]


def _list_topics(sentence: str) -> Iterator[str]:
    """Yield the topics of plugins in a line about an addition."""
    if " added: " in sentence and "plugin" in sentence:
        for match in _TOPICS.finditer(sentence):
            yield from (name.strip("/") for name in _QUOTED.findall(match["names"]))


def _mark(subject: Subject, offered: set[str]) -> Subject:
    """Return the subject of a source whose lost topics are not breaking if others offer all of them."""
    if subject.kind is not SubjectKind.SOURCE or not offered:
        return subject
    changes = [
        replace(change, effect=Effect.CHANGED, reason=None) if _is_moved(change, offered) else change
        for change in subject.changes
    ]
    return replace(subject, changes=changes)


def _is_moved(change: Change, offered: set[str]) -> bool:
    names = {name.strip("/") for name in _QUOTED.findall(str(change.sentence))}
    is_lost = change.core.template.endswith("removed: {names}") and change.effect is Effect.BREAKING
    return is_lost and change.core.arguments.get("kind") in [kind.plural for kind in _KINDS] and names <= offered
