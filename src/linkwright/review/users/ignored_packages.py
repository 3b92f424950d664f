"""Find the packages that build tools skip now, or no longer skip, because of a file such as ``COLCON_IGNORE``."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import PurePosixPath

from linkwright.diagnostics import phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.packages.manifest import IGNORE_MARKERS, MANIFEST
from linkwright.review.changes import Change, Effect, Location, Subject
from linkwright.review.launches.programs.missing import RepositoryPackage
from linkwright.review.versions import Version, Versions


def find_ignored_packages(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the manifests of packages that both versions have and only one version builds."""
    changed = [path for file in changed_files for path in (file.old_path, file.new_path) if path]
    folders = {PurePosixPath(path).parent.as_posix() for path in changed if PurePosixPath(path).name in IGNORE_MARKERS}
    old_paths = {file.new_path: file.old_path for file in changed_files if file.new_path}
    manifests = {
        path
        for folder in folders
        if versions.new.file(folder).is_dir()
        for path in _find_manifests(versions.new, folder)
    }
    for path in sorted(manifests):
        old_path = old_paths.get(path, path)
        if old_path is None or not versions.old.file(old_path).is_file():
            continue
        before, after = _find_marker(versions.old, old_path), _find_marker(versions.new, path)
        if after is not None and before is None:
            reason = phrase("packages that depend on the package do not build or start")
            text = phrase("no longer built, because of '{file}'", file=after)
            yield path, Change(text, Effect.BREAKING, reason, Location(after, 1, 1))
        elif before is not None and after is None:
            text = phrase("built now, without '{file}'", file=before)
            yield path, Change(text, location=Location(before, 1, 1, is_old=True))


def relieve_ignored_packages(versions: Versions, subjects: Sequence[Subject]) -> list[Subject]:
    """Return the subjects, in which a lost name or file of a package of ROS 2 that was not built breaks nothing.

    A user could not install the package. catkin may build a package in spite of ``COLCON_IGNORE``.
    """
    return [
        replace(subject, changes=list(map(_relieve, subject.changes)))
        if subject.old_path is not None and _was_ignored(versions.old, subject.old_path)
        else subject
        for subject in subjects
    ]


def _relieve(change: Change) -> Change:
    is_lost = change.location is None or change.location.is_old
    return replace(change, effect=Effect.CHANGED, reason=None) if is_lost else change


def _was_ignored(version: Version, path: str) -> bool:
    """Return whether build tools skipped the package of a file, which is one of ROS 2."""
    folders = [
        folder for folder in PurePosixPath(path).parents if version.file((folder / MANIFEST).as_posix()).is_file()
    ]
    if not folders or _find_marker(version, (folders[0] / MANIFEST).as_posix()) is None:
        return False
    return not RepositoryPackage(version, folders[0].as_posix()).is_ros1


def _find_manifests(version: Version, folder: str) -> Iterator[str]:
    return (path for path in version.paths((MANIFEST,), folder) if PurePosixPath(path).name == MANIFEST)


def _find_marker(version: Version, manifest: str) -> str | None:
    """Return the path of a file that makes build tools skip a package, or None if they build it."""
    for folder in PurePosixPath(manifest).parents:
        for name in sorted(IGNORE_MARKERS):
            if version.file((folder / name).as_posix()).is_file():
                return (folder / name).as_posix()
    return None
