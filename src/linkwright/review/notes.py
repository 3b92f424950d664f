"""Write notes about files that a review does not compare, one note for many files."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace

from linkwright.diagnostics import Phrase, counted, phrase, quoted_names
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Subject
from linkwright.review.versions import Versions

_MAX_NAMES = 5
"""The maximum number of missing packages and files that a note names."""
_PLACE = re.compile(r"^\S+?:\d+(?::\d+)?: ")
"""The file and the line at the beginning of a reason."""
_COMMIT_LENGTH = 7
"""The number of digits of a commit in notes."""
_MIN_UNEXPANDED = 3
"""The minimum number of files with the same reason that a note replaces."""


def is_unreadable_as_before(subject: Subject, changed: Collection[str | None]) -> bool:
    """Return whether a file is unchanged and unreadable in both versions.

    Args:
        subject: the file with its changes.
        changed: the paths of the changed files.
    """
    return (
        bool(subject.problems)
        and all(problem.is_of_both for problem in subject.problems)
        and not subject.changes
        and not {subject.old_path, subject.new_path} & set(changed)
    )


def make_unreadable_notes(subjects: Sequence[Subject]) -> Iterator[Phrase]:
    """Yield a note about files that neither version can read, as before."""
    if subjects:
        first = subjects[0]
        yield counted(
            "one file that the changes may affect is not compared: '{path}': {reason}",
            "{count} files that the changes may affect are not compared, such as '{path}': {reason}",
            len(subjects),
            path=first.path,
            reason=first.problems[0].text,
        )


def make_submodule_note(file: ChangedFile) -> Phrase:
    """Return the note about a changed submodule, with its commits if both are known."""
    if file.submodule_commits is None:
        return phrase("submodule '{path}' changed; its files are not compared", path=file.path)
    old, new = (commit[:_COMMIT_LENGTH] for commit in file.submodule_commits)
    return phrase(
        "submodule '{path}' changed: {old} -> {new}; its files are not compared", path=file.path, old=old, new=new
    )


def group_equal_problems(subjects: Sequence[Subject]) -> tuple[list[Subject], list[Phrase]]:
    """Return subjects without files that are unreadable for a common reason, and notes.

    There is a note about each reason. A file that is the only one with its reason remains a subject.
    """
    groups: dict[str, list[Subject]] = {}
    for subject in subjects:
        if len(subject.problems) == 1 and subject.problems[0].is_of_both and not subject.changes:
            groups.setdefault(str(subject.problems[0].text), []).append(subject)
    groups = {reason: group for reason, group in groups.items() if len(group) > 1}
    notes = [
        phrase(
            "{count} changed files are not compared, such as '{path}': {reason}",
            count=len(group),
            path=group[0].path,
            reason=group[0].problems[0].text,
        )
        for group in groups.values()
    ]
    grouped = {subject.path for group in groups.values() for subject in group}
    return [subject for subject in subjects if subject.path not in grouped], notes


def group_unexpanded(subjects: Sequence[Subject]) -> tuple[list[Subject], list[Phrase]]:
    """Return subjects without the reason why several cannot be expanded, and a note about each such reason.

    Their changes are those in the text of the files.
    """
    groups: dict[str, list[Subject]] = {}
    for subject in subjects:
        if subject.changes and len(subject.problems) == 1 and subject.problems[0].is_of_both:
            reason = _PLACE.sub("", str(subject.problems[0].text.arguments.get("reason", "")))
            groups.setdefault(reason, []).append(subject)
    groups = {reason: group for reason, group in groups.items() if reason and len(group) >= _MIN_UNEXPANDED}
    notes = [
        phrase(
            "{count} changed files are only compared as they are written, such as '{path}': {reason}",
            count=len(group),
            path=group[0].path,
            reason=reason,
        )
        for reason, group in groups.items()
    ]
    grouped = {subject.path for group in groups.values() for subject in group}
    return [replace(subject, problems=[]) if subject.path in grouped else subject for subject in subjects], notes


def make_generated_notes(versions: Versions) -> Iterator[Phrase]:
    """Yield notes about changed files in folders that colcon or catkin wrote, which are not compared."""
    files = [(f"{folder}/", file) for folder, files in sorted(versions.generated_files.items()) for file in files]
    added = [folder for folder, file in files if file.old_path is None]
    removed = [folder for folder, file in files if file.new_path is None]
    changed = [folder for folder, file in files if file.old_path is not None and file.new_path is not None]
    if added:
        yield counted(
            "one generated file of colcon or catkin added, in {names}",
            "{count} generated files of colcon or catkin added, in {names}",
            len(added),
            names=quoted_names(list(dict.fromkeys(added))),
        )
    if removed:
        yield counted(
            "one generated file of colcon or catkin removed, in {names}",
            "{count} generated files of colcon or catkin removed, in {names}",
            len(removed),
            names=quoted_names(list(dict.fromkeys(removed))),
        )
    if changed:
        yield counted(
            "one generated file of colcon or catkin changed, in {names}",
            "{count} generated files of colcon or catkin changed, in {names}",
            len(changed),
            names=quoted_names(list(dict.fromkeys(changed))),
        )


def make_checkout_notes(versions: Versions) -> Iterator[Phrase]:
    """Yield a note about symbolic links that are ignored, and notes about files that git cannot check out.

    What both versions have in common is one note.
    """
    sides = (versions.old, versions.new)
    commits = [(version.name, version.commit) for version in sides if version.commit is not None]
    generated = tuple(f"{folder}/" for folder in versions.generated_files)
    removed_links = [[link for link in commit.removed_links if not link.startswith(generated)] for _, commit in commits]
    links = max(removed_links, key=len, default=[])
    if links:
        yield counted(
            "symbolic link '{path}' points outside the repository and is ignored",
            "{count} symbolic links, such as '{path}', point outside the repository and are ignored",
            len(links),
            path=links[0],
        )
    missing = [(name, commit.missing_files) for name, commit in commits if commit.missing_files]
    if len(missing) > 1 and len({tuple(files) for _, files in missing}) == 1:
        files = missing[0][1]
        yield counted(
            "git cannot check out one file of both versions: '{path}'",
            "git cannot check out {count} files of both versions, such as '{path}'",
            len(files),
            path=files[0],
        )
        return
    for name, files in missing:
        yield counted(
            "git cannot check out one file of '{version}', such as '{path}'",
            "git cannot check out {count} files of '{version}', such as '{path}'",
            len(files),
            version=name,
            path=files[0],
        )


def make_missing_notes(subjects: Sequence[Subject]) -> Iterator[Phrase]:
    """Yield a note about omitted packages and files, which a version does not find."""
    incomplete = [subject for subject in subjects if subject.missing]
    names = sorted({name for subject in incomplete for name in subject.missing})
    if incomplete:
        yield counted(
            "'{path}' is compared without the packages and files that are not found: {names}",
            "{count} descriptions, such as '{path}', are compared without the packages and files that are not found: "
            "{names}",
            len(incomplete),
            path=incomplete[0].path,
            names=quoted_names([*names[:_MAX_NAMES], *["..."][: len(names) > _MAX_NAMES]]),
        )
