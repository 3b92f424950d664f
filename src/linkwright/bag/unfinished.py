"""MCAP files without an end: those of a recording that was killed, or that were cut off in a copy.

A file is a row of records, each with its kind and length (the MCAP specification). All that are whole are good; what
is missing is the end, without which readers refuse the file.
"""

from __future__ import annotations

import shutil
import struct
from pathlib import Path

_MAGIC = b"\x89MCAP0\r\n"
_HEAD = struct.Struct("<BQ")
_DATA_END = _HEAD.pack(0x0F, 4) + bytes(4)
_FOOTER = _HEAD.pack(0x02, 20) + bytes(20)
_SUMMARY_KINDS = frozenset({0x02, 0x08, 0x0B, 0x0D, 0x0E, 0x0F})
"""Records that only the end of a file has; a damaged end is left out and made anew, without an index."""


def is_unfinished(path: Path) -> bool:
    """Whether an MCAP file begins as one but does not end as one."""
    with path.open("rb") as file:
        if file.read(len(_MAGIC)) != _MAGIC:
            return False
        size = path.stat().st_size
        if size < 2 * len(_MAGIC):
            return True
        file.seek(-len(_MAGIC), 2)
        return file.read() != _MAGIC


def finished_copy(path: Path, folder: Path) -> Path:
    """A copy of the whole records of an unfinished file, with an end.

    Args:
        path: the file.
        folder: where to put the copy.
    """
    copy = folder / path.name
    with path.open("rb") as source, copy.open("wb") as target:
        remaining = _whole_records(path)
        while remaining:
            block = source.read(min(remaining, 1 << 20))
            target.write(block)
            remaining -= len(block)
        target.write(_DATA_END + _FOOTER + _MAGIC)
    shutil.copystat(path, copy)
    return copy


def _whole_records(path: Path) -> int:
    """How many bytes at the beginning of the file are whole records with data."""
    size = path.stat().st_size
    end = len(_MAGIC)
    with path.open("rb") as file:
        while True:
            file.seek(end)
            head = file.read(_HEAD.size)
            if len(head) < _HEAD.size:
                return end
            kind, length = _HEAD.unpack(head)
            if kind == 0 or kind in _SUMMARY_KINDS or end + _HEAD.size + length > size:
                return end
            end += _HEAD.size + length
