"""The pixels that the pens of turtles have drawn."""

from __future__ import annotations

from collections import deque
from math import ceil, floor
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Color = tuple[int, int, int]
"""Red, green and blue, 0 to 255."""

SIZE_PX = 500
PX_PER_UNIT = 45
EXTENT = (SIZE_PX - 1) / PX_PER_UNIT
"""The width and the height of the world, 11.09 units."""

_EMPTY = (255, 255, 255, 0)
_RECENT_CHANGES = 512


class Area(NamedTuple):
    """A rectangle of pixels; right and bottom are exclusive."""

    left: int
    top: int
    right: int
    bottom: int


_EVERYTHING = Area(0, 0, SIZE_PX, SIZE_PX)


class Canvas:
    """An image of the world with the lines of all pens, transparent where nothing is drawn.

    Positions are in units, x to the right and y up, from the lower left corner.

    Attributes:
        pixels: red, green, blue and opacity of each pixel, shape (500, 500, 4); the upper row first.
        version: a number that increases with each change.
    """

    def __init__(self) -> None:
        self.pixels: NDArray[np.uint8] = np.empty((SIZE_PX, SIZE_PX, 4), np.uint8)
        self.version = 0
        self._changes: deque[Area] = deque(maxlen=_RECENT_CHANGES)
        self.clear()

    def clear(self) -> None:
        """Remove all lines."""
        self.pixels[:] = _EMPTY
        self._record_change(_EVERYTHING)

    def find_changed_area(self, version: int) -> Area:
        """Return the area that has changed since an earlier version; everything if that is long ago."""
        count = self.version - version
        if count > len(self._changes):
            return _EVERYTHING
        lefts, tops, rights, bottoms = zip(*list(self._changes)[-count:], strict=True)
        return Area(min(lefts), min(tops), max(rights), max(bottoms))

    def _record_change(self, area: Area) -> None:
        self._changes.append(area)
        self.version += 1

    def color_at(self, x: float, y: float) -> Color:
        """Return the color at a position, white where nothing is drawn."""
        column, row = (min(max(round(value), 0), SIZE_PX - 1) for value in _to_pixels(x, y))
        red, green, blue = self.pixels[row, column, :3].tolist()
        return red, green, blue

    def draw_line(self, start: tuple[float, float], end: tuple[float, float], color: Color, width_px: int) -> None:
        """Draw a line with round ends between two positions."""
        (x1, y1), (x2, y2) = _to_pixels(*start), _to_pixels(*end)
        radius = width_px / 2.0
        left, top = (max(0, floor(min(pair) - radius)) for pair in ((x1, x2), (y1, y2)))
        right, bottom = (min(SIZE_PX, ceil(max(pair) + radius) + 1) for pair in ((x1, x2), (y1, y2)))
        if left >= right or top >= bottom:
            return
        rows, columns = np.mgrid[top:bottom, left:right]
        along_x, along_y = x2 - x1, y2 - y1
        length_squared = along_x**2 + along_y**2
        fractions = 0.0
        if length_squared > 0.0:
            fractions = np.clip(((columns - x1) * along_x + (rows - y1) * along_y) / length_squared, 0.0, 1.0)
        distances = np.hypot(columns - x1 - fractions * along_x, rows - y1 - fractions * along_y)
        self.pixels[top:bottom, left:right][distances <= max(radius, 0.5)] = (*color, 255)
        self._record_change(Area(left, top, right, bottom))


def _to_pixels(x: float, y: float) -> tuple[float, float]:
    return x * PX_PER_UNIT, (EXTENT - y) * PX_PER_UNIT
