"""Draw lines over an image."""

from __future__ import annotations

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.picture.bodies import Color
from linkwright.picture.vectors import Floats

_TEXT_COLOR: Color = (0.008, 0.008, 0.008)
_HALO_COLOR: Color = (0.96, 0.96, 0.96)
"""The light of text and of the area around lines."""


def draw_lines(
    colors: Floats, alpha: Floats, lines: Array, pen: float, halo: float, color: Color = _TEXT_COLOR
) -> None:
    """Draw lines with a bright area around them.

    Args:
        colors: the light of the pixels multiplied by their opacity, shape (height, width, 3), which is changed.
        alpha: the opacity of the pixels, shape (height, width), which is changed.
        lines: the ends of the lines in pixels, shape (n, 2, 2).
        pen: half the width of the lines in pixels.
        halo: the radius of the bright area in pixels.
        color: the light of the lines.
    """
    if not len(lines):
        return
    height, width = alpha.shape
    margin = halo + 1.0
    left, top = (int(max(0.0, np.floor(lines[:, :, axis].min() - margin))) for axis in (0, 1))
    right, bottom = (
        int(min(float(limit), np.ceil(lines[:, :, axis].max() + margin))) for axis, limit in ((0, width), (1, height))
    )
    if right <= left or bottom <= top:
        return
    distances = _compute_distances(lines, left, top, right, bottom)
    window = (slice(top, bottom), slice(left, right))
    for radius, light, strength in ((halo, _HALO_COLOR, 0.8), (pen, color, 1.0)):
        coverage = (np.clip(radius + 0.5 - distances, 0.0, 1.0) * strength).astype(np.float32)
        paint = coverage[:, :, None] * np.array(light, np.float32)
        colors[window] = colors[window] * (1.0 - coverage)[:, :, None] + paint
        alpha[window] = alpha[window] * (1.0 - coverage) + coverage


def _compute_distances(lines: Array, left: int, top: int, right: int, bottom: int) -> Array:
    """Return the distance from each pixel of a window to the nearest line."""
    x, y = (np.arange(left, right) + 0.5)[None, :], (np.arange(top, bottom) + 0.5)[:, None]
    nearest = np.full((bottom - top, right - left), 1e12)
    for (x0, y0), (x1, y1) in lines.tolist():
        across, down = x1 - x0, y1 - y0
        squared_length = across * across + down * down
        ratio = ((x - x0) * across + (y - y0) * down) / squared_length if squared_length > 0 else np.zeros_like(nearest)
        ratio = np.clip(ratio, 0.0, 1.0)
        dx, dy = x - (x0 + ratio * across), y - (y0 + ratio * down)
        np.minimum(nearest, dx * dx + dy * dy, out=nearest)
    distances: Array = np.sqrt(nearest)
    return distances
