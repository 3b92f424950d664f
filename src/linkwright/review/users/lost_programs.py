"""Find programs that are no longer executable but are still installed or started."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import PurePosixPath

from linkwright.diagnostics import phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.launches.programs.script_options import LAUNCH_SUFFIXES
from linkwright.review.versions import Version, Versions

_USER_SUFFIXES = (*LAUNCH_SUFFIXES, "CMakeLists.txt")
"""The ends of the names of files that install or start programs."""
_COMMENT = re.compile(r"#[^\n]*")


def _is_made_executable(version: Version, path: str) -> bool:
    """Return whether the package of a script installs it with the permission, whatever its source has."""
    name = re.escape(PurePosixPath(path).name)
    build_file = (PurePosixPath(version.package_of(path) or "") / "CMakeLists.txt").as_posix()
    text = _COMMENT.sub("", version.text(build_file))
    commands = r"(?:\binstall\s*\(\s*PROGRAMS|\bcatkin_install_python\s*\()"
    return re.search(rf"{commands}[^)]*[\s/]{name}[\s)]", text) is not None


_PROGRAM_SUFFIXES = ("", ".py", ".sh", ".bash", ".pl", ".rb")


def find_lost_programs(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the programs that are no longer executable, each with a change.

    Only a program that a build file or launch file of the repository names counts.
    """
    lost = [file for file in changed_files if file.is_executable is False and _is_program(versions, file.path)]
    users = [(path, versions.new.text(path)) for path in (versions.new.paths(_USER_SUFFIXES) if lost else ())]
    for file in lost:
        name = re.compile(rf"(?<![\w.-]){re.escape(PurePosixPath(file.path).name)}(?![\w.-])")
        user = next((path for path, text in users if name.search(text)), None)
        if user is not None:
            reason = phrase("'{path}' installs or starts it, and it may not start without this permission", path=user)
            if _is_made_executable(versions.new, file.path):
                reason = phrase("it starts once it is installed, but not from a devel space or with --symlink-install")
            yield file.path, Change(phrase("no longer executable"), Effect.BREAKING, reason, Location(file.path, 1, 1))


def _is_program(versions: Versions, path: str) -> bool:
    """Return whether a file can be a program. Data files are often executable by mistake."""
    return PurePosixPath(path).suffix in _PROGRAM_SUFFIXES or versions.new.text(path).startswith("#!")
