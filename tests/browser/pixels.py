"""Colours on the screen, read from screenshots."""

from __future__ import annotations

import struct
import zlib
from typing import Any


def color_at(page: Any, x: float, y: float) -> tuple[int, int, int]:
    """The colour of the page at a place, pixels from its upper left corner."""
    image = page.screenshot(clip={"x": x, "y": y, "width": 1, "height": 1})
    data, start = b"", 8
    while start < len(image):
        (length,) = struct.unpack_from(">I", image, start)
        if image[start + 4 : start + 8] == b"IDAT":
            data += image[start + 8 : start + 8 + length]
        start += 12 + length
    _, r, g, b, *_ = zlib.decompress(data)  # one pixel: every filter leaves it as it is
    return r, g, b
