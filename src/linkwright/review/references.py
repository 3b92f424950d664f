"""Find paths in launch files to files that the new version lacks."""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Iterator, Sequence
from pathlib import Path, PurePosixPath

from linkwright.diagnostics import SourceText, Span, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.packages.manifest import SKIPPED_FOLDERS
from linkwright.packages.readers.launch_files import read_launch_file
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.versions import Versions

_LAUNCH_SUFFIXES = (".launch.py", "_launch.py", ".launch.xml", "_launch.xml", ".launch", ".launch.yaml", ".launch.yml")
_SHARED_PATH = re.compile(r"\$\(find(?:-pkg-share)?\s+([\w.-]+)\s*\)/([\w./+-]+)")
_MAX_BYTES = 1 << 20


def lost_references(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the launch files of the new version that name files that only the old version has, each with a change."""
    lost = {file.old_path for file in changed_files if file.old_path and file.old_path != file.new_path}
    names = {PurePosixPath(path).name for path in lost}
    if not names:
        return
    for path in _launch_files(versions.new.root):
        file = versions.new.file(path)
        if file.stat().st_size > _MAX_BYTES:
            continue
        text = file.read_bytes().decode("utf-8", errors="replace")
        if not any(name in text for name in names):
            continue
        for package, subpath, span in _shared_paths(SourceText(str(file), text), path):
            if _is_lost(versions, path, package, subpath, lost):
                yield path, _change(path, package, subpath, span)


def _launch_files(root: Path) -> Iterator[str]:
    for folder, folders, names in os.walk(root):
        folders[:] = sorted(name for name in folders if not name.startswith(".") and name not in SKIPPED_FOLDERS)
        for name in sorted(names):
            file = Path(folder, name)
            if name.endswith(_LAUNCH_SUFFIXES) and file.is_file() and not file.is_symlink():
                yield file.relative_to(root).as_posix()


def _shared_paths(source: SourceText, path: str) -> Iterator[tuple[str, str, Span]]:
    """Yield the paths in share folders that a launch file names: package, path in its folder, and location."""
    if path.endswith(".py"):
        for item in read_launch_file(source, path).paths:
            yield item.package, item.path, item.span
        return
    for match in _SHARED_PATH.finditer(source.text):
        yield match[1], match[2], source.span(match.start(), match.end())


def _is_lost(versions: Versions, path: str, package: str, subpath: str, lost: Collection[str]) -> bool:
    """Return whether only the old version has a file of a package, and a change removed or renamed it."""
    old_share, new_share = (
        version.share_of(package, version.file(path).parent) for version in (versions.old, versions.new)
    )
    if old_share is None or not (old_share / subpath).is_file():
        return False
    if new_share is not None and (new_share / subpath).exists():
        return False
    return versions.old.relative(old_share / subpath) in lost


def _change(path: str, package: str, subpath: str, span: Span) -> Change:
    text = phrase("names '{file}' of '{package}', which does not exist any more", file=subpath, package=package)
    reason = phrase("the launch file does not find the file")
    return Change(text, Effect.BREAKING, reason, Location(path, span.line, span.column))
