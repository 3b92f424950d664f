"""Group meshes that are added, removed or renamed together."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Sequence
from dataclasses import replace
from pathlib import PurePosixPath

from linkwright.diagnostics import Phrase, counted, joined_first
from linkwright.review.changes import MAX_NAMES, Change, Subject, SubjectKind


def group_meshes(subjects: Sequence[Subject]) -> list[Subject]:
    """Return the subjects, with related meshes of a folder as one subject.

    Meshes are related if they are added, removed or renamed together.
    """
    groups: dict[Hashable, list[Subject]] = {}
    for number, subject in enumerate(subjects):
        groups.setdefault(_make_group_key(subject) or number, []).append(subject)
    return [group[0] if len(group) == 1 else _join_subjects(group) for group in groups.values()]


def _make_group_key(subject: Subject) -> Hashable | None:
    """Return the key by which subjects are grouped, or None for a subject that is not grouped."""
    if subject.kind is not SubjectKind.MESH or len(subject.changes) != 1 or subject.figures or subject.problems:
        return None
    paths = subject.old_path, subject.new_path
    if paths[0] == paths[1]:
        return None
    return (*(None if path is None else PurePosixPath(path).parent for path in paths), subject.changes[0].effect)


def _join_subjects(subjects: Sequence[Subject]) -> Subject:
    first = subjects[0]
    change: Change = first.changes[0]
    folder = f"{PurePosixPath(first.path).parent}/"
    return replace(first, path=folder, changes=[replace(change, sentence=_describe_group(subjects))])


def _describe_group(subjects: Sequence[Subject]) -> Phrase:
    count, names = len(subjects), joined_first((PurePosixPath(subject.path).name for subject in subjects), MAX_NAMES)
    first = subjects[0]
    if first.old_path is None:
        return counted("{count} mesh added: {names}", "{count} meshes added: {names}", count, names=names)
    if first.new_path is None:
        return counted("{count} mesh removed: {names}", "{count} meshes removed: {names}", count, names=names)
    old_folder = PurePosixPath(first.old_path).parent
    if old_folder != PurePosixPath(first.path).parent:
        return counted(
            "{count} mesh moved from {folder}: {names}",
            "{count} meshes moved from {folder}: {names}",
            count,
            folder=f"{old_folder}/",
            names=names,
        )
    renames = joined_first(_format_renames(subjects), MAX_NAMES)
    return counted("{count} mesh renamed: {names}", "{count} meshes renamed: {names}", count, names=renames)


def _format_renames(subjects: Sequence[Subject]) -> Iterator[str]:
    for subject in subjects:
        yield f"{PurePosixPath(subject.old_path or '').name} -> {PurePosixPath(subject.path).name}"
