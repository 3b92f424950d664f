"""Demosaicing: colours of an image taken through a Bayer filter."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Pixels = NDArray[np.uint8]


def demosaiced(mosaic: Pixels, pattern: str) -> Pixels:
    """RGB, shape (height, width, 3), each missing colour the mean of its neighbours that have it.

    Args:
        mosaic: shape (height, width).
        pattern: the colours of the first two pixels of the first and the second row, such as ``rggb``.
    """
    height, width = mosaic.shape
    if height < 2 or width < 2:
        return np.repeat(mosaic[..., np.newaxis], 3, axis=2)
    padded = np.pad(mosaic, 1, mode="reflect").astype(np.uint16)
    around = [padded[1 + dy : 1 + dy + height, 1 + dx : 1 + dx + width] for dy in (-1, 0, 1) for dx in (-1, 0, 1)]
    _, up, _, left, _, right, _, down, _ = around
    sideways = (left + right) >> 1
    upright = (up + down) >> 1
    cross = (left + right + up + down) >> 2
    corners = (around[0] + around[2] + around[6] + around[8]) >> 2
    result = np.empty((height, width, 3), np.uint8)
    for place, colour in enumerate(pattern):
        rows, columns = slice(place // 2, None, 2), slice(place % 2, None, 2)
        own = mosaic[rows, columns]
        parts: tuple[NDArray[Any], ...]
        if colour == "g":
            red_in_row = pattern[place ^ 1] == "r"
            red, blue = (sideways, upright) if red_in_row else (upright, sideways)
            parts = (red[rows, columns], own, blue[rows, columns])
        elif colour == "r":
            parts = (own, cross[rows, columns], corners[rows, columns])
        else:
            parts = (corners[rows, columns], cross[rows, columns], own)
        for index, part in enumerate(parts):
            result[rows, columns, index] = part
    return result
