"""The comparison of files by their contents."""

from __future__ import annotations

import filecmp
from pathlib import Path

from linkwright.files.git_repository import compute_file_hash, read_lfs_hash, read_lfs_size


def has_same_bytes(old: Path, new: Path) -> bool:
    """Return whether two files have the same contents.

    A Git LFS pointer is equal to its file.
    """
    try:
        if old.samefile(new) or filecmp.cmp(old, new, shallow=False):
            return True
        hashes = read_lfs_hash(old), read_lfs_hash(new)
        return any(hashes) and (hashes[0] or compute_file_hash(old)) == (hashes[1] or compute_file_hash(new))
    except OSError:
        return True


def content_hash(file: Path) -> str:
    """Return the hash of a file's contents; for a Git LFS pointer, the hash that it contains."""
    return read_lfs_hash(file) or compute_file_hash(file)


def content_size(file: Path) -> int:
    """Return the size of a file in bytes; for a Git LFS pointer, the size that it contains."""
    size = read_lfs_size(file)
    return file.stat().st_size if size is None else size
