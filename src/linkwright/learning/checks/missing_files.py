"""The message for a missing file, with the files that the learner may have meant."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from linkwright.diagnostics import Phrase, nearest, phrase, quoted_names

_MAX_LISTED_FILES = 3
_SKIPPED_FOLDERS = {"build", "install", "log", "__pycache__"}


def describe_missing_file(folder: Path, name: str, workspace: Path) -> Phrase:
    """Return the message for a missing file.

    Args:
        folder: the folder that should have the file.
        name: the path in the folder.
        workspace: the workspace, which may have the file in another folder.
    """
    matches = _find_same_named_files(folder, name)
    if not matches and (matches_in_workspace := _find_same_named_files(workspace, name)):
        return phrase(
            "'{folder}' has no file '{name}'; the workspace has {others}",
            folder=folder.name,
            name=name,
            others=quoted_names(matches_in_workspace),
        )
    matches = matches or _find_similar_files(folder, name)
    if matches:
        return phrase(
            "'{folder}' has no file '{name}'; it has {others}",
            folder=folder.name,
            name=name,
            others=quoted_names(matches),
        )
    matches_in_workspace = _find_similar_files(workspace, Path(name).name)
    if matches_in_workspace:
        return phrase(
            "'{folder}' has no file '{name}'; the workspace has {others}",
            folder=folder.name,
            name=name,
            others=quoted_names(matches_in_workspace),
        )
    return phrase("'{folder}' has no file '{name}'", folder=folder.name, name=name)


def _find_same_named_files(folder: Path, name: str) -> list[str]:
    """Return the files of a folder whose names differ only in case and punctuation from a name."""
    names = [file.relative_to(folder).as_posix() for file in _walk_files(folder)]
    return [other for other in names if _normalize_name(Path(other).name) == _normalize_name(Path(name).name)][
        :_MAX_LISTED_FILES
    ]


def _find_similar_files(folder: Path, name: str) -> list[str]:
    """Return the files of a folder whose names resemble a name."""
    names = [file.relative_to(folder).as_posix() for file in _walk_files(folder)]
    stem = _get_stem(name)
    related = [other for other in names if _get_stem(other) == stem]
    suffix = Path(name).suffix
    typos = nearest(name, [other for other in names if Path(other).suffix == suffix], _MAX_LISTED_FILES)
    neighbors = [other for other in names if Path(other).parent == Path(name).parent and Path(other).suffix == suffix]
    return list(dict.fromkeys([*related, *typos, *neighbors]))[:_MAX_LISTED_FILES]


def _normalize_name(name: str) -> str:
    """Return a name in lower case, without punctuation.

    So ``Display_launch.py`` and ``display.launch.py`` compare equal.
    """
    return re.sub(r"[^a-z0-9]", "", name.casefold())


def _get_stem(name: str) -> str:
    return _normalize_name(Path(name).name.partition(".")[0])


def _walk_files(folder: Path) -> Iterator[Path]:
    for path in sorted(folder.rglob("*")):
        parts = path.relative_to(folder).parts
        if path.is_file() and not any(part in _SKIPPED_FOLDERS or part.startswith(".") for part in parts):
            yield path
