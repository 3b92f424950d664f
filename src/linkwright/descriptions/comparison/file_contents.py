"""The comparison of files by their contents."""

from __future__ import annotations

import filecmp
from pathlib import Path

from linkwright.files.git_repository import compute_file_hash, read_lfs_pointer


def has_same_bytes(old: Path, new: Path) -> bool:
    """Return whether two files have the same contents.

    A Git LFS pointer is equal to its file.
    """
    try:
        if old.samefile(new) or filecmp.cmp(old, new, shallow=False):
            return True
        has_pointer = any(read_lfs_pointer(file) for file in (old, new))
        return has_pointer and content_hash(old) == content_hash(new)
    except OSError:
        return True


def content_hash(file: Path) -> str:
    """Return the hash of a file's contents; for a Git LFS pointer, the hash that it contains."""
    pointer = read_lfs_pointer(file)
    return compute_file_hash(file) if pointer is None else pointer.hash


def content_size(file: Path) -> int:
    """Return the size of a file in bytes; for a Git LFS pointer, the size that it contains."""
    pointer = read_lfs_pointer(file)
    return file.stat().st_size if pointer is None else pointer.size
