"""Recognize topics of a source that a plugin of a description or world of the same package newly offers."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import replace

from linkwright.review.changes import Effect, Subject


def merge_moved_topics(subjects: Sequence[Subject], find_package: Callable[[str], str | None]) -> list[Subject]:
    """Return the subjects, in which lost topics that an added plugin has are not breaking.

    Args:
        subjects: the compared files.
        find_package: a function that returns the folder of the package of a file.
    """
    offered: dict[str | None, set[str]] = {}
    for subject in subjects:
        if subject.added_topics:
            names = {name.strip("/") for name in subject.added_topics}
            offered.setdefault(find_package(subject.path), set()).update(names)
    return [_mark(subject, offered.get(find_package(subject.path), set())) for subject in subjects]


def _mark(subject: Subject, offered: Collection[str]) -> Subject:
    """Return the subject, in which lost topics are not breaking if others offer all of them."""
    if not offered or not any(change.lost_topics for change in subject.changes):
        return subject
    changes = [
        replace(change, effect=Effect.CHANGED, reason=None)
        if change.lost_topics and all(name.strip("/") in offered for name in change.lost_topics)
        else change
        for change in subject.changes
    ]
    return replace(subject, changes=changes)
