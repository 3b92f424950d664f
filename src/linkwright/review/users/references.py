"""Find paths to missing files and refused script options in launch files."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence
from pathlib import PurePosixPath

from linkwright.diagnostics import SourceText, Span, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.packages.readers.launch_files import read_launch_file
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.launches.script_options import find_refused_options
from linkwright.review.versions import Versions

LAUNCH_SUFFIXES = (".launch.py", "_launch.py", ".launch.xml", "_launch.xml", ".launch", ".launch.yaml", ".launch.yml")
"""The ends of the names of launch files whose paths are searched."""
_SHARE_PATH = re.compile(r"\$\(find(?:-pkg-share)?\s+([\w.-]+)\s*\)/([\w./+-]+)")


def find_lost_references(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield launch files with paths to missing files or refused options, and the changes.

    A missing file exists only in the old version. A script does not accept a refused option.
    """
    yield from find_refused_options(versions, changed_files)
    lost = {file.old_path for file in changed_files if file.old_path and file.old_path != file.new_path}
    names = {PurePosixPath(path).name for path in lost}
    if not names:
        return
    for path in versions.new.paths(LAUNCH_SUFFIXES):
        file, text = versions.new.file(path), versions.new.text(path)
        if not any(name in text for name in names):
            continue
        for package, subpath, span in _find_share_paths(SourceText(str(file), text), path):
            if _is_lost(versions, path, package, subpath, lost):
                yield path, _make_change(path, package, subpath, span)


def _find_share_paths(source: SourceText, path: str) -> Iterator[tuple[str, str, Span]]:
    """Yield the paths in share folders that a launch file names.

    Each is given as the package, the path in it, and the location in the launch file.
    """
    if path.endswith(".py"):
        for item in read_launch_file(source, path).paths:
            yield item.package, item.path, item.span
        return
    for match in _SHARE_PATH.finditer(source.text):
        yield match[1], match[2], source.span(match.start(), match.end())


def _is_lost(versions: Versions, path: str, package: str, subpath: str, lost: Collection[str]) -> bool:
    """Return whether a file of a package was removed or renamed."""
    old_share, new_share = (
        version.share_of(package, version.file(path).parent) for version in (versions.old, versions.new)
    )
    if old_share is None or not (old_share / subpath).is_file():
        return False
    if new_share is not None and (new_share / subpath).exists():
        return False
    return versions.old.relative(old_share / subpath) in lost


def _make_change(path: str, package: str, subpath: str, span: Span) -> Change:
    text = phrase("names '{file}' of '{package}', which no longer exists", file=subpath, package=package)
    reason = phrase("the launch file does not find the file")
    return Change(text, Effect.BREAKING, reason, Location(path, span.line, span.column))
