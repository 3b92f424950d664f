"""Report a removed package with all its files as one change."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import chain
from pathlib import PurePosixPath

from linkwright.diagnostics import Phrase, counted, joined, joined_first, phrase, quoted
from linkwright.diagnostics.phrase import listed_items
from linkwright.files.git_repository import ChangedFile
from linkwright.packages.manifest import MANIFEST, ROSBUILD_MANIFEST, package_name
from linkwright.review.changes import Change, Effect, Subject, SubjectKind
from linkwright.review.files.build.facts import FactKind
from linkwright.review.installed_paths import read_package_facts
from linkwright.review.sources.names import NameKind
from linkwright.review.users.left_packages import list_package_users
from linkwright.review.versions import Versions

_MANIFESTS = (MANIFEST, ROSBUILD_MANIFEST)
_REMOVED_TEMPLATE = "package removed"
_MAX_NAMES = 8
"""The maximum number of names of each kind in the line about a removed package."""
_FACT_KINDS = (FactKind.EXECUTABLE, FactKind.LIBRARY, FactKind.COMPONENT)
_FILE_KINDS = {
    SubjectKind.LAUNCH_FILE: phrase("launch files"),
    SubjectKind.INTERFACE: phrase("interfaces"),
    SubjectKind.DESCRIPTION: phrase("descriptions"),
    SubjectKind.PART: phrase("parts of descriptions"),
    SubjectKind.WORLD: phrase("worlds and models"),
    SubjectKind.SEMANTICS: phrase("semantic descriptions"),
    SubjectKind.PARAMETERS: phrase("parameter files"),
    SubjectKind.BEHAVIOR_TREE: phrase("behavior trees"),
    SubjectKind.MAP: phrase("maps"),
    SubjectKind.MESH: phrase("meshes"),
}
"""The titles of the kinds of files that other packages use."""
_NAME_KINDS = (
    *(NameKind.PUBLISHER, NameKind.SUBSCRIPTION, NameKind.SERVICE, NameKind.ACTION),
    *(NameKind.PLUGIN, NameKind.SIMULATION_PLUGIN, NameKind.LIBRARY_PLUGIN, NameKind.TREE_NODE),
)
"""The kinds of names of sources that other packages use without the files of the package."""


def find_removed_packages(subjects: Sequence[Subject]) -> list[str]:
    """Return the folders of the removed packages."""
    return [
        PurePosixPath(subject.path).parent.as_posix().removeprefix(".")
        for subject in subjects
        if subject.kind is SubjectKind.MANIFEST and any(map(_is_removal, subject.changes))
    ]


def is_removed_with_package(versions: Versions, folders: Sequence[str], file: ChangedFile | Subject) -> bool:
    """Return whether a file was removed with its package, which is one of the given ones."""
    return (
        bool(folders)
        and file.new_path is None
        and file.old_path is not None
        and versions.old.package_of(file.old_path, _MANIFESTS) in folders
    )


def merge_removed_packages(versions: Versions, subjects: Sequence[Subject]) -> list[Subject]:
    """Return the subjects, with the files of a removed package in the line about the package.

    Images of removed robots stay in subjects of their own.
    """
    folders = find_removed_packages(subjects)
    removed: dict[str, list[Subject]] = {folder: [] for folder in folders}
    result = []
    for subject in subjects:
        if not is_removed_with_package(versions, folders, subject) or any(map(_is_removal, subject.changes)):
            result.append(subject)
            continue
        removed[versions.old.package_of(subject.path, _MANIFESTS) or ""].append(subject)
        if subject.images or subject.scene or subject.problems:
            changes = [replace(change, effect=Effect.CHANGED, reason=None) for change in subject.changes]
            result.append(replace(subject, changes=changes))
    return [_add_contents(versions, subject, removed) for subject in result]


def _is_removal(change: Change) -> bool:
    return change.sentence.template == _REMOVED_TEMPLATE


def _add_contents(versions: Versions, subject: Subject, removed: dict[str, list[Subject]]) -> Subject:
    """Return a subject whose line about the removal of a package names what the package offered."""
    folder = PurePosixPath(subject.path).parent.as_posix().removeprefix(".")
    if folder not in removed or not any(map(_is_removal, subject.changes)):
        return subject
    files = [file for file in versions.changed_files if is_removed_with_package(versions, [folder], file)]
    items = list(_list_contents(versions, folder, removed[folder]))
    text = phrase("package removed")
    if len(files) > 1:
        text = counted("package removed with {count} file", "package removed with {count} files", len(files))
    if items:
        text = phrase("{change}: {items}", change=text, items=joined(items, "; "))
    reasons = [change.reason for part in removed[folder] for change in part.changes]
    name = package_name(versions.old.file(folder)) or PurePosixPath(subject.path).parent.name
    users = list(_describe_users(versions, name))
    users += [reason for reason in dict.fromkeys(reasons) if reason is not None and "file" in reason.arguments]
    return replace(subject, changes=[_replace_removal(change, text, users) for change in subject.changes])


def _describe_users(versions: Versions, name: str) -> Iterator[Phrase]:
    """Yield the sentence about the files of the new version that still use a removed package, if there are any."""
    paths = [] if name in versions.new.shares else list_package_users(versions.new, name)
    if paths:
        yield phrase("still used by {files}", files=joined_first(map(quoted, paths), _MAX_NAMES))


def _replace_removal(change: Change, text: Phrase, users: Sequence[Phrase]) -> Change:
    if not _is_removal(change):
        return change
    reason = joined([change.reason, *users], "; ") if users and change.reason is not None else change.reason
    return replace(change, sentence=text, reason=reason)


def _list_contents(versions: Versions, folder: str, removed: Sequence[Subject]) -> Iterator[Phrase]:
    """Yield what a removed package offered: programs, files and names of its sources, by kind."""
    facts = read_package_facts(versions.old, folder)
    for kind in _FACT_KINDS:
        names = dict.fromkeys(fact.name for fact in (facts.facts if facts is not None else ()) if fact.kind is kind)
        if names:
            yield _format_names(kind.title, map(quoted, names))
    for file_kind, title in _FILE_KINDS.items():
        paths = [PurePosixPath(subject.path) for subject in removed if subject.kind is file_kind]
        if paths and file_kind is SubjectKind.MESH:
            yield counted("{count} mesh", "{count} meshes", len(paths))
        elif paths:
            yield _format_names(title, (quoted(path.relative_to(folder).as_posix()) for path in paths))
    changes = [change for subject in removed for change in subject.changes if change.effect is Effect.BREAKING]
    for name_kind in _NAME_KINDS:
        lists = (
            listed_items(change.sentence.arguments.get("names"))
            for change in changes
            if change.sentence.arguments.get("kind") == name_kind.plural
        )
        texts = dict.fromkeys(chain.from_iterable(lists))
        if texts:
            yield _format_names(name_kind.plural, texts)


def _format_names(title: Phrase, names: Iterator[str] | dict[str, None]) -> Phrase:
    return phrase("{kind} {names}", kind=title, names=joined_first(names, _MAX_NAMES))
