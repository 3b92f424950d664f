"""Describe the changed files that a review does not compare: their states, kinds and changed lines."""

from __future__ import annotations

import posixpath
from collections.abc import Iterable, Mapping
from pathlib import PurePosixPath

from linkwright.diagnostics import Phrase, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changed_lines import compare_lines, list_commands
from linkwright.review.renames.packages import find_moved_files
from linkwright.review.versions import Version, Versions

_HEAD_BYTES = 4096
"""The number of bytes at the beginning of a file by which its kind is recognized."""
_MIN_FILES = 4
"""The minimum number of files of a folder that are summarized in one line."""


def find_file_states(versions: Versions, files: Iterable[ChangedFile]) -> dict[str, Phrase]:
    """Return the states of files, such as added or renamed, by path.

    Robots for other simulators, and changed text files, also have a state.
    """
    states: dict[str, Phrase] = {}
    files = list(files)
    moved = dict(find_moved_files(versions, files))
    for file in files:
        state = _find_path_state(file)
        if file.path in moved:
            state = phrase("moved with the package from {folder}", folder=f"{moved[file.path] or '.'}/")
        version, path = (versions.new, file.new_path) if file.new_path else (versions.old, file.old_path)
        kind = None if path is None or file.is_submodule else _find_foreign_kind(version, path)
        commands = None
        if None in (file.old_path, file.new_path) and path is not None and not file.is_submodule:
            commands = list_commands(version, path)
        if state is None:
            state = kind or compare_lines(versions, file)
        elif commands is not None and file.path not in moved:
            state = phrase("{change}: {items}", change=state, items=commands)
        elif kind is not None:
            state = phrase("{state}, {kind}", state=state, kind=kind)
        if state is not None:
            states[file.path] = state
    return states


def _find_path_state(file: ChangedFile) -> Phrase | None:
    if file.old_path is None:
        return phrase("added")
    if file.new_path is None:
        return phrase("removed")
    if file.old_path != file.new_path:
        return phrase("renamed from {path}", path=file.old_path)
    if file.is_executable is None:
        return None
    return phrase("executable now") if file.is_executable else phrase("no longer executable")


def _find_foreign_kind(version: Version, path: str) -> Phrase | None:
    """Return the kind of a robot or world of another simulator; None for other files."""
    suffix = PurePosixPath(path).suffix.lower()
    if suffix in (".usd", ".usda", ".usdc"):
        return phrase("robot or world in USD, not compared")
    if suffix in (".wbt", ".proto") and _read_beginning(version, path).startswith(b"#VRML_SIM"):
        return phrase("robot or world of Webots, not compared")
    return None


def _read_beginning(version: Version, path: str) -> bytes:
    try:
        with version.file(path).open("rb") as file:
            return file.read(_HEAD_BYTES)
    except OSError:
        return b""


def group_files(paths: Iterable[str], states: Mapping[str, Phrase]) -> list[tuple[str, int, Phrase | None]]:
    """Return files, or a folder for several files in it with the same state.

    Args:
        paths: the paths of the files.
        states: the states of files, by path.

    Returns:
        The paths of the files or folders, the number of files, and their states.
    """
    groups: dict[tuple[str, str], list[str]] = {}
    for path in paths:
        state = states.get(path)
        folder = PurePosixPath(path).parent.as_posix()
        is_simple = state is not None and not state.arguments and folder != "."
        key = folder if is_simple else path
        if state is not None and "folder" in state.arguments:
            key = ""  # all files of a package that moved
        groups.setdefault((key, str(state)), []).append(path)
    result: list[tuple[str, int, Phrase | None]] = []
    for (folder, _), group in groups.items():
        state = states.get(group[0])
        if len(group) >= _MIN_FILES:
            result.append((f"{folder or posixpath.commonpath(group) or '.'}/", len(group), state))
        else:
            result += [(path, 1, state) for path in group]
    return result
