"""Find the committed files that colcon and catkin wrote, which a review does not read."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import replace
from pathlib import PurePosixPath

from linkwright.files.git_repository import ChangedFile

_BUILD_FOLDERS = frozenset({"build", "log"})
"""The names of colcon's folders in which no package is searched. Packages are searched in ``install``."""
_MARKER = "COLCON_IGNORE"
"""The file that colcon writes into these folders."""
_GENERATED_MARKERS = (
    *(frozenset({_MARKER, ".colcon_install_layout"}), frozenset({_MARKER, "_local_setup_util_sh.py"})),
    *(frozenset({_MARKER, ".built_by"}), frozenset({"CATKIN_IGNORE", ".built_by"})),
    *(frozenset({"CATKIN_IGNORE", "CMakeCache.txt"}), frozenset({".catkin", "_setup_util.py"})),
)
"""The files that only a folder written by colcon or catkin has, each set by itself."""
_LOG_FOLDER = "log"
_LOG_NAMES = frozenset({"latest", "latest_build", "events.log", "logger_all.log"})
"""The names that colcon writes into its ``log`` folder and the folders in it."""


def find_build_files(paths: Sequence[str], changed: Iterable[str]) -> Collection[str]:
    """Return the files in colcon's ``build`` and ``log`` folders.

    Files beside changed files, and in the folders above these, are left out of the result.

    Args:
        paths: the paths of all files of a commit.
        changed: the paths of the files that change.
    """
    folders = {path.rpartition("/")[0] for path in paths if path.rpartition("/")[2] == _MARKER}
    folders = {folder for folder in folders if folder.rpartition("/")[2] in _BUILD_FOLDERS}
    if not folders:
        return ()
    prefixes = tuple(f"{folder}/" for folder in folders)
    read = {str(parent) for path in changed if path.startswith(prefixes) for parent in PurePosixPath(path).parents}
    return {path for path in paths if path.startswith(prefixes) and path.rpartition("/")[0] not in read}


def find_generated_folders(paths: Iterable[str]) -> set[str]:
    """Return the folders that colcon or catkin wrote, such as ``install``, without the root.

    Args:
        paths: the paths of all files of a repository.
    """
    names: dict[str, set[str]] = {}
    for path in paths:
        folder, _, name = path.rpartition("/")
        names.setdefault(folder, set()).add(name)
    folders = {folder for folder, found in names.items() if any(markers <= found for markers in _GENERATED_MARKERS)}
    for folder, found in names.items():
        if _LOG_NAMES & found:
            parent = folder if folder.rpartition("/")[2] == _LOG_FOLDER else folder.rpartition("/")[0]
            if parent.rpartition("/")[2] == _LOG_FOLDER and _MARKER in names.get(parent, ()):
                folders.add(parent)
    return folders - {""}


def split_generated(
    files: Sequence[ChangedFile], folders: Collection[str]
) -> tuple[list[ChangedFile], dict[str, list[ChangedFile]]]:
    """Return the changed files outside generated folders, and those inside by the folder.

    A file that moved into or out of such a folder is both.
    """
    if not folders:
        return list(files), {}
    others: list[ChangedFile] = []
    generated: dict[str, list[ChangedFile]] = {}
    for file in files:
        old_folder, new_folder = (_find_folder(path, folders) for path in (file.old_path, file.new_path))
        for folder in dict.fromkeys(filter(None, (old_folder, new_folder))):
            old_path = file.old_path if old_folder == folder else None
            new_path = file.new_path if new_folder == folder else None
            generated.setdefault(folder, []).append(replace(file, old_path=old_path, new_path=new_path))
        old_path, new_path = (
            None if folder else path for folder, path in ((old_folder, file.old_path), (new_folder, file.new_path))
        )
        if old_path or new_path:
            others.append(replace(file, old_path=old_path, new_path=new_path))
    return others, generated


def _find_folder(path: str | None, folders: Collection[str]) -> str | None:
    """Return the generated folder that contains a path, or None."""
    parents = [] if path is None else [parent.as_posix() for parent in PurePosixPath(path).parents]
    return next((parent for parent in reversed(parents) if parent in folders), None)
