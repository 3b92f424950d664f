"""Find the packages that build tools skip now, or no longer skip, because of a file such as ``COLCON_IGNORE``."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import PurePosixPath

from linkwright.diagnostics import phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.packages.manifest import IGNORE_MARKERS, MANIFEST
from linkwright.review.changes import Change, Effect, Location
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


def _find_manifests(version: Version, folder: str) -> Iterator[str]:
    return (path for path in version.paths((MANIFEST,), folder) if PurePosixPath(path).name == MANIFEST)


def _find_marker(version: Version, manifest: str) -> str | None:
    """Return the path of a file that makes build tools skip a package, or None if they build it."""
    for folder in PurePosixPath(manifest).parents:
        for name in sorted(IGNORE_MARKERS):
            if version.file((folder / name).as_posix()).is_file():
                return (folder / name).as_posix()
    return None
