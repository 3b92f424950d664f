"""Find programs, parameter files and descriptions that still name a removed data file."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import PurePosixPath

from linkwright.diagnostics import SourceText, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.packages.launch_files import is_launch_file_name
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.files.build.setup_files import SETUP_FILE
from linkwright.review.launch_paths import find_launch_files
from linkwright.review.texts.comments import without_comments
from linkwright.review.users.references import find_share_paths
from linkwright.review.versions import TEST_FOLDERS, Version, Versions

_READER_SUFFIXES = (".py", ".cpp", ".cc", ".cxx", ".hpp", ".h", ".yaml", ".yml")
_PROGRAM_SUFFIXES = frozenset({*_READER_SUFFIXES[:6], ".c", ".sh", ".bash"})
"""The suffixes of files that a build file or an import names."""
_DESCRIPTION_SUFFIXES = (".xacro", ".urdf", ".sdf", ".world", ".gazebo")
_SHAPE_SUFFIXES = frozenset({".stl", ".dae", ".obj", ".glb", ".gltf", ".ply", ".png", ".jpg", ".jpeg", ".tga"})
"""The suffixes of meshes and textures, which descriptions name."""
_COMMENT = re.compile(r"(^|\s)(#|//)[^\n]*")
_MIN_NAME_LENGTH = 5
_MAX_FILES = 200


def find_lost_data(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the files that still name a removed or renamed data file, each with a change.

    Launch files are left out: `find_lost_references` finds the paths in them.
    """
    lost = {
        PurePosixPath(file.old_path).name: file.old_path
        for file in changed_files[:_MAX_FILES]
        if file.old_path and file.old_path != file.new_path and _is_data(file.old_path) and not file.is_submodule
    }
    if not lost:
        return
    remaining_names = {PurePosixPath(path).name for path in versions.new.paths(tuple(lost))}
    lost = {name: path for name, path in lost.items() if name not in remaining_names}
    changed = {file.old_path: file.new_path for file in changed_files}
    for path in versions.new.paths((*_READER_SUFFIXES, *_DESCRIPTION_SUFFIXES)) if lost else ():
        parts = PurePosixPath(path).parts
        if not TEST_FOLDERS.isdisjoint(parts) or is_launch_file_name(parts[-1]):
            continue
        is_description = path.endswith(_DESCRIPTION_SUFFIXES)
        text = versions.new.text(path)
        told = _list_told_names(versions.new, path, text) if any(name in text for name in lost) else set[str]()
        text = without_comments(text, path) if is_description else text
        for name, old_path in lost.items():
            if is_description and PurePosixPath(name).suffix.lower() not in _SHAPE_SUFFIXES:
                continue
            line = 0 if name in told else _find_line(text, name)
            is_own = versions.new.package_of(path) == versions.old.package_of(old_path)
            is_launch = is_launch_file_name(name) and parts[-1] != SETUP_FILE
            if line and (is_launch or (is_own and not is_launch_file_name(name))):
                yield path, _make_change(path, name, line, is_renamed=changed.get(old_path) is not None)


def _list_told_names(version: Version, path: str, text: str) -> set[str]:
    """Return the names of the files whose paths `find_lost_references` finds in a launch file of any name."""
    if path not in find_launch_files(version):
        return set()
    return {PurePosixPath(subpath).name for _, subpath, _ in find_share_paths(SourceText(path, text), path)}


def _is_data(path: str) -> bool:
    pure_path = PurePosixPath(path)
    if is_launch_file_name(pure_path.name):
        return TEST_FOLDERS.isdisjoint(pure_path.parts)
    is_named = len(pure_path.name) >= _MIN_NAME_LENGTH and pure_path.suffix not in ("", ".md", ".txt", ".xml")
    return is_named and pure_path.suffix not in _PROGRAM_SUFFIXES and TEST_FOLDERS.isdisjoint(pure_path.parts)


def _find_line(text: str, name: str) -> int:
    """Return the first line that names a file in quotes or after a slash.

    Lines count from 1; the result is 0 if there is none.
    """
    if name not in text:
        return 0
    pattern = re.compile(rf"(?<=[/\"']){re.escape(name)}(?=[\"'\s,\])]|$)", re.MULTILINE)
    lines = (_COMMENT.sub("", line) for line in text.splitlines())
    return next((number for number, line in enumerate(lines, 1) if pattern.search(line)), 0)


def _make_change(path: str, name: str, line: int, *, is_renamed: bool) -> Change:
    text = phrase("names the file '{name}', which was removed", name=name)
    if is_renamed:
        text = phrase("names the file '{name}', which has another name now", name=name)
    return Change(text, Effect.BREAKING, phrase("the file '{name}' is not found", name=name), Location(path, line, 1))
