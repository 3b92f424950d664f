"""Elevation models: TIFF files with floating-point numbers of 64 bits, which Pillow does not read."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array

_WIDTH, _HEIGHT, _BITS, _COMPRESSION, _OFFSETS, _SAMPLES, _COUNTS, _FORMAT = 256, 257, 258, 259, 273, 277, 279, 339
_TYPES = {3: ("H", 2), 4: ("I", 4)}
"""The types of the values that count here: letters of `struct`, and bytes."""
_FLOATS, _UNCOMPRESSED = 3, 1
_MOST_PIXELS = 1 << 26


def read_elevation(path: Path) -> Array:
    """Read the heights, in m, of a TIFF with uncompressed strips of floating-point numbers.

    Rows start at the top.

    Raises:
        OSError: the file cannot be read.
        ValueError: the file has another format.
    """
    data = path.read_bytes()
    order = {b"II*\0": "<", b"MM\0*": ">"}.get(data[:4])
    if order is None:
        raise ValueError("no TIFF")
    try:
        tags = _tags(data, order)
        width, height, bits = tags[_WIDTH][0], tags[_HEIGHT][0], tags[_BITS][0]
        strips = zip(tags[_OFFSETS], tags[_COUNTS], strict=True)
        raw = b"".join(data[start : start + count] for start, count in strips)
    except (KeyError, IndexError, struct.error) as error:
        raise ValueError("no table of heights") from error
    kind = (tags.get(_FORMAT, [1])[0], tags.get(_COMPRESSION, [1])[0], tags.get(_SAMPLES, [1])[0])
    if kind != (_FLOATS, _UNCOMPRESSED, 1) or bits not in (32, 64) or not 0 < width * height <= _MOST_PIXELS:
        raise ValueError("no uncompressed numbers")
    values: Any = np.frombuffer(raw, dtype=f"{order}f{bits // 8}", count=width * height)
    return np.asarray(values, dtype=np.float64).reshape(height, width)


def _tags(data: bytes, order: str) -> dict[int, tuple[int, ...]]:
    """Return the integer values of the first directory, by tag."""
    (first,) = struct.unpack_from(f"{order}I", data, 4)
    (entries,) = struct.unpack_from(f"{order}H", data, first)
    found: dict[int, tuple[int, ...]] = {}
    for entry in range(entries):
        at = first + 2 + 12 * entry
        tag, kind, count = struct.unpack_from(f"{order}HHI", data, at)
        if kind not in _TYPES or count > len(data):
            continue
        letter, size = _TYPES[kind]
        place = at + 8
        if size * count > 4:
            (place,) = struct.unpack_from(f"{order}I", data, at + 8)
        found[tag] = struct.unpack_from(f"{order}{count}{letter}", data, place)
    return found
