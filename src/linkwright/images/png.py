"""A writer of PNG files, and of animations as APNG, in plain Python."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_COLOR_TYPES = {1: 0, 3: 2, 4: 6}
_COMPRESSION_LEVEL = 6
_UP_FILTER = 2
"""The filter that stores the difference from the row above."""

Pixels = NDArray[np.uint8]


def png(pixels: Pixels) -> bytes:
    """Return an image as a PNG file.

    Args:
        pixels: the pixels, shape (height, width, channels), with 1, 3 or 4 channels; the upper row first.
    """
    return b"".join(
        (
            _SIGNATURE,
            _make_header_chunk(pixels),
            _make_chunk(b"IDAT", _compress_pixels(pixels)),
            _make_chunk(b"IEND", b""),
        )
    )


def apng(frames: Sequence[Pixels], frame_seconds: float) -> bytes:
    """Return an endless animation as an APNG file.

    Viewers that do not know APNG show the first frame.

    Args:
        frames: the pixels of each frame, all of the same shape.
        frame_seconds: the time in s for which each frame is shown.
    """
    parts = [_SIGNATURE, _make_header_chunk(frames[0]), _make_chunk(b"acTL", struct.pack(">II", len(frames), 0))]
    height, width = frames[0].shape[:2]
    delay = max(1, round(frame_seconds * 1000))
    number = 0
    for index, frame in enumerate(frames):
        control = struct.pack(">IIIIIHHBB", number, width, height, 0, 0, delay, 1000, 0, 0)
        parts.append(_make_chunk(b"fcTL", control))
        number += 1
        if index == 0:
            parts.append(_make_chunk(b"IDAT", _compress_pixels(frame)))
        else:
            parts.append(_make_chunk(b"fdAT", struct.pack(">I", number) + _compress_pixels(frame)))
            number += 1
    parts.append(_make_chunk(b"IEND", b""))
    return b"".join(parts)


def _make_header_chunk(pixels: Pixels) -> bytes:
    height, width, channels = pixels.shape
    return _make_chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, _COLOR_TYPES[channels], 0, 0, 0))


def _compress_pixels(pixels: Pixels) -> bytes:
    height = len(pixels)
    rows = np.ascontiguousarray(pixels).reshape(height, -1)
    filtered = np.empty((height, rows.shape[1] + 1), np.uint8)
    filtered[:, 0] = _UP_FILTER
    filtered[0, 1:] = rows[0]
    filtered[1:, 1:] = rows[1:] - rows[:-1]  # modulo 256
    return zlib.compress(filtered.tobytes(), _COMPRESSION_LEVEL)


def _make_chunk(kind: bytes, data: bytes) -> bytes:
    return b"".join((struct.pack(">I", len(data)), kind, data, struct.pack(">I", zlib.crc32(kind + data))))
