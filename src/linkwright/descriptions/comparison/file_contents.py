"""The comparison of files by their contents."""

from __future__ import annotations

import filecmp
import re
from pathlib import Path

from linkwright.files.git_repository import compute_file_hash, read_lfs_pointer

_COLLADA = ".dae"
_MAX_FORMATTED_BYTES = 20 << 20
"""The maximum size in bytes of COLLADA files whose formatting is ignored."""
_BLANKS_BESIDE_TAGS = re.compile(rb"(>) | (<)")


def has_same_contents(old: Path, new: Path) -> bool:
    """Return whether two mesh files have the same contents.

    A Git LFS pointer is equal to its file. Blanks between the elements and numbers of COLLADA make no difference.
    """
    try:
        if old.samefile(new) or filecmp.cmp(old, new, shallow=False):
            return True
        if any(read_lfs_pointer(file) for file in (old, new)):
            return content_hash(old) == content_hash(new)
        is_small = max(file.stat().st_size for file in (old, new)) <= _MAX_FORMATTED_BYTES
        return new.suffix.lower() == _COLLADA and is_small and _read_unformatted(old) == _read_unformatted(new)
    except OSError:
        return True


def _read_unformatted(file: Path) -> bytes:
    """Return the bytes of an XML file with single blanks, and none beside tags."""
    return _BLANKS_BESIDE_TAGS.sub(rb"\1\2", b" ".join(file.read_bytes().split()))


def content_hash(file: Path) -> str:
    """Return the hash of a file's contents; for a Git LFS pointer, the hash that it contains."""
    pointer = read_lfs_pointer(file)
    return compute_file_hash(file) if pointer is None else pointer.hash


def content_size(file: Path) -> int:
    """Return the size of a file in bytes; for a Git LFS pointer, the size that it contains."""
    pointer = read_lfs_pointer(file)
    return file.stat().st_size if pointer is None else pointer.size
