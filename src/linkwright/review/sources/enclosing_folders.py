"""Find the folders of a repository around one of its files."""

from __future__ import annotations

from pathlib import Path

from linkwright.files.scratch_folders import is_scratch_folder


def list_enclosing_folders(folder: Path, maximum: int) -> list[Path]:
    """Return a folder and those around it, the nearest one first, up to the root of the repository.

    The root contains ``.git``, or is in the temporary folder of an exported version. Files outside of it differ between
    the computers and between the versions of a review.

    Args:
        folder: a folder of the repository.
        maximum: the maximum number of folders.
    """
    folders: list[Path] = []
    for candidate in (folder, *folder.parents)[:maximum]:
        if is_scratch_folder(candidate):
            break
        folders.append(candidate)
        if (candidate / ".git").exists():
            break
    return folders
