"""Report renamed and moved folders as one change instead of one change for each file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import PurePosixPath

from linkwright.diagnostics import counted, joined_first, phrase
from linkwright.review.changes import MAX_NAMES, Change, Effect, PathChange, Subject, SubjectKind
from linkwright.review.versions import Versions

_MIN_FILES = 3
"""The minimum number of files of a folder that are merged into one line."""
_Folders = tuple[str, str]
"""The old and the new path of a folder."""


def merge_renamed_folders(versions: Versions, subjects: Sequence[Subject]) -> list[Subject]:
    """Return the subjects, with the files of a renamed folder merged into one subject.

    Args:
        versions: both versions of the repository.
        subjects: all compared files.
    """
    groups: dict[_Folders, list[Subject]] = {}
    for subject in subjects:
        folders = _find_renamed_folder(subject)
        if folders is not None:
            groups.setdefault(folders, []).append(subject)
    result = list(subjects)
    for folders, group in groups.items():
        if len(group) < _MIN_FILES:
            continue
        for subject in group:
            other_changes = [change for change in subject.changes if change.path_change is not PathChange.RENAMED]
            result[next(i for i, candidate in enumerate(result) if candidate is subject)] = replace(
                subject, changes=other_changes
            )
        result.append(_make_folder_subject(versions, folders, group))
    return sorted(result, key=lambda subject: subject.path)


def _find_renamed_folder(subject: Subject) -> _Folders | None:
    """Return the old and new paths of the outermost renamed folder of a file.

    The result is None if the name of the file also changed.
    """
    is_renamed = any(change.path_change is PathChange.RENAMED for change in subject.changes)
    if not is_renamed or subject.old_path is None or subject.new_path is None or subject.kind is SubjectKind.MESH:
        return None
    old, new = (PurePosixPath(path).parts for path in (subject.old_path, subject.new_path))
    if old[-1] != new[-1]:
        return None
    common = 0
    while common < min(len(old), len(new)) and old[-1 - common] == new[-1 - common]:
        common += 1
    return "/".join(old[: len(old) - common]), "/".join(new[: len(new) - common])


def _make_folder_subject(versions: Versions, folders: _Folders, group: Sequence[Subject]) -> Subject:
    old, new = (f"{folder or '.'}/" for folder in folders)
    is_breaking = any(
        change.effect is Effect.BREAKING
        for subject in group
        for change in subject.changes
        if change.path_change is PathChange.RENAMED
    )
    names = joined_first((subject.path.removeprefix(new) for subject in group), MAX_NAMES)
    if any(path.is_file() for path in versions.new.file(folders[0]).rglob("*")):
        text = counted(
            "{count} compared file moved from {path}: {names}",
            "{count} compared files moved from {path}: {names}",
            len(group),
            path=old,
            names=names,
        )
    else:
        text = counted(
            "folder renamed from {path} with {count} compared file: {names}",
            "folder renamed from {path} with {count} compared files: {names}",
            len(group),
            path=old,
            names=names,
        )
    reason = phrase("launch files, descriptions and users that name the files do not find them")
    if all(subject.kind is SubjectKind.INTERFACE for subject in group):
        reason = phrase("programs that use the types do not build or start")
    effect = Effect.BREAKING if is_breaking else Effect.CHANGED
    change = Change(text, effect, reason if is_breaking else None)
    return Subject(group[0].kind, new, old, new, [change])
