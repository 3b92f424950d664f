"""Pointers of Git LFS: the small text files that represent large files until these are fetched."""

from __future__ import annotations

from linkwright.diagnostics.phrase import phrase
from linkwright.loading.lean_typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

_BEGINS = b"version https://git-lfs.github.com/spec/"
IS_POINTER = phrase("it is only a pointer of Git LFS")
FETCH = phrase("run `git lfs pull` in its repository")


def is_pointer(data: bytes) -> bool:
    """Return whether the bytes of a file, or the first of them, are such a pointer."""
    return data.startswith(_BEGINS)


def is_pointer_file(path: Path) -> bool:
    """Return whether a file is one; False where it cannot be read."""
    try:
        with path.open("rb") as file:
            return is_pointer(file.read(len(_BEGINS)))
    except OSError:
        return False
