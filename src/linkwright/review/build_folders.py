"""Find the committed files that colcon wrote and a review does not read."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from pathlib import PurePosixPath

_BUILD_FOLDERS = frozenset({"build", "log"})
"""The names of colcon's folders in which no package is searched. Packages are searched in ``install``."""
_MARKER = "COLCON_IGNORE"
"""The file that colcon writes into these folders."""


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
