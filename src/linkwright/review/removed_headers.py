"""Leave the removal of a header to the line about its classes and functions."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace
from pathlib import PurePosixPath

from linkwright.review.changes import Change, Effect, Subject, SubjectKind
from linkwright.review.files.build.installed_files import make_uninstalled_change
from linkwright.review.sources.names import HEADER_SUFFIXES, NameKind

_DECLARED = (NameKind.CLASS.plural, NameKind.FUNCTION.plural, NameKind.MEMBER.plural)


def drop_told_headers(subjects: Sequence[Subject]) -> list[Subject]:
    """Return the subjects without lines of build files about removed headers that have breaking lines of their own."""
    told = {subject.path for subject in subjects if _is_removed_header(subject)}
    if not told:
        return list(subjects)
    return [
        replace(subject, changes=[each for change in subject.changes for each in _reduce(change, subject, told)])
        if subject.kind is SubjectKind.BUILD
        else subject
        for subject in subjects
    ]


def _is_removed_header(subject: Subject) -> bool:
    """Return whether a subject is a removed header with a breaking line about what it declared."""
    is_header = subject.kind is SubjectKind.SOURCE and subject.path.endswith(HEADER_SUFFIXES)
    return (
        is_header
        and subject.new_path is None
        and any(
            change.effect is Effect.BREAKING and change.sentence.arguments.get("kind") in _DECLARED
            for change in subject.changes
        )
    )


def _reduce(change: Change, build: Subject, told: Collection[str]) -> list[Change]:
    """Return a change of a build file without the removed headers; empty if it has no others."""
    folder = PurePosixPath(build.path).parent
    left = [name for name in change.uninstalled if not any(_installs(name, path, folder) for path in told)]
    if len(left) == len(change.uninstalled):
        return [change]
    return [make_uninstalled_change(left, change.reason)] if left else []


def _installs(target: str, path: str, folder: PurePosixPath) -> bool:
    """Return whether an installed file may be a header of the package in a folder, by the name of the file."""
    is_own = PurePosixPath(path).is_relative_to(folder)
    return is_own and PurePosixPath(target).name == PurePosixPath(path).name and not target.endswith("/")
