"""Colour images with luma and chroma (ITU-R BT.601, studio range), as video cameras send them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Pixels = NDArray[np.uint8]


def from_packed(pairs: Pixels, layout: str) -> Pixels:
    """RGB of an image whose pixels share chroma two by two.

    Args:
        pairs: shape (height, width, 2): luma and one chroma of each pixel, blue's and red's in turn.
        layout: ``uyvy`` with the chroma first, or ``yuyv``.
    """
    luma, chroma = (pairs[..., 1], pairs[..., 0]) if layout == "uyvy" else (pairs[..., 0], pairs[..., 1])
    width = luma.shape[1]
    even = chroma[:, : width - width % 2]
    blue, red = np.repeat(even[:, 0::2], 2, axis=1), np.repeat(even[:, 1::2], 2, axis=1)
    if width % 2 and width > 1:  # the last pixel of an odd row has no partner
        blue, red = (np.concatenate([part, part[:, -1:]], axis=1) for part in (blue, red))
    elif width == 1:
        blue = red = np.full_like(luma, 128)
    return _rgb(luma, blue, red)


def from_nv(luma: Pixels, chroma: Pixels, layout: str) -> Pixels:
    """RGB of an image with the chroma after the luma.

    Args:
        luma: shape (height, width).
        chroma: of ``nv21``, shape (height / 2, width), red and blue in turn for two by two pixels; of ``nv24``, shape
            (height, 2 width), blue and red in turn for each pixel.
        layout: ``nv21`` or ``nv24``.
    """
    height, width = luma.shape
    if layout == "nv24":
        return _rgb(luma, chroma[:, 0::2], chroma[:, 1::2])
    red, blue = (
        np.repeat(np.repeat(part, 2, axis=0), 2, axis=1)[:height, :width] for part in (chroma[:, 0::2], chroma[:, 1::2])
    )
    return _rgb(luma, blue, red)


def _rgb(luma: Pixels, blue: Pixels, red: Pixels) -> Pixels:
    y = (luma.astype(np.int32) - 16) * 298
    b = blue.astype(np.int32) - 128
    r = red.astype(np.int32) - 128
    parts = ((y + 409 * r + 128) >> 8, (y - 100 * b - 208 * r + 128) >> 8, (y + 516 * b + 128) >> 8)
    result = np.empty((*luma.shape, 3), np.uint8)
    for index, part in enumerate(parts):
        result[..., index] = np.clip(part, 0, 255)
    return result
