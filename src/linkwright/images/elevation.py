"""Elevation models: TIFF files with 64-bit floats, which Pillow does not read."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array

_WIDTH_TAG, _HEIGHT_TAG, _BITS_TAG, _COMPRESSION_TAG, _OFFSETS_TAG, _SAMPLES_TAG, _COUNTS_TAG, _FORMAT_TAG = (
    256,
    257,
    258,
    259,
    273,
    277,
    279,
    339,
)
_INTEGER_TYPES = {3: ("H", 2), 4: ("I", 4)}
"""The supported types of tag values: each with its letter in `struct` and its size in bytes."""
_FLOAT_FORMAT, _UNCOMPRESSED = 3, 1
_MAX_PIXELS = 1 << 26


def read_elevation(path: Path) -> Array:
    """Read the heights in m of a TIFF with uncompressed strips of 32-bit or 64-bit floats.

    The first row is at the top.

    Raises:
        OSError: the file cannot be read.
        ValueError: the file has another format.
    """
    data = path.read_bytes()
    order = {b"II*\0": "<", b"MM\0*": ">"}.get(data[:4])
    if order is None:
        raise ValueError("not a TIFF file")
    try:
        tags = _read_tags(data, order)
        width, height, bits = tags[_WIDTH_TAG][0], tags[_HEIGHT_TAG][0], tags[_BITS_TAG][0]
        strips = zip(tags[_OFFSETS_TAG], tags[_COUNTS_TAG], strict=True)
        raw = b"".join(data[start : start + count] for start, count in strips)
    except (KeyError, IndexError, struct.error) as error:
        raise ValueError("the file has no table of heights") from error
    layout = (tags.get(_FORMAT_TAG, [1])[0], tags.get(_COMPRESSION_TAG, [1])[0], tags.get(_SAMPLES_TAG, [1])[0])
    if layout != (_FLOAT_FORMAT, _UNCOMPRESSED, 1) or bits not in (32, 64) or not 0 < width * height <= _MAX_PIXELS:
        raise ValueError("the heights are not uncompressed floating-point numbers")
    values: Any = np.frombuffer(raw, dtype=f"{order}f{bits // 8}", count=width * height)
    return np.asarray(values, dtype=np.float64).reshape(height, width)


def _read_tags(data: bytes, order: str) -> dict[int, tuple[int, ...]]:
    """Return the values of the integer tags in the first directory, by tag."""
    (directory,) = struct.unpack_from(f"{order}I", data, 4)
    (entry_count,) = struct.unpack_from(f"{order}H", data, directory)
    tags: dict[int, tuple[int, ...]] = {}
    for entry in range(entry_count):
        offset = directory + 2 + 12 * entry
        tag, type_code, count = struct.unpack_from(f"{order}HHI", data, offset)
        if type_code not in _INTEGER_TYPES or count > len(data):
            continue
        letter, size = _INTEGER_TYPES[type_code]
        value_offset = offset + 8
        if size * count > 4:
            (value_offset,) = struct.unpack_from(f"{order}I", data, offset + 8)
        tags[tag] = struct.unpack_from(f"{order}{count}{letter}", data, value_offset)
    return tags
