"""Outlines that highlight bodies."""

from __future__ import annotations

from math import isqrt

import numpy as np
from numpy.typing import NDArray

from linkwright.picture.bodies import Color
from linkwright.picture.vectors import Floats

_WIDTH_PIXELS = 2.2
"""The width of an outline in pixels."""
_BORDER_WIDTH_PIXELS = 1.2
"""The width of the line between two outlined bodies in pixels."""
_TINT = np.float32(0.16)
"""The strength with which the outline's color tints the visible parts of the body, as displayed."""
_HIDDEN_STRENGTH = np.float32(0.40)
"""The opacity of the line around parts that other bodies hide."""


def draw_outlines(
    light: Floats,
    alpha: Floats,
    bodies: NDArray[np.int32],
    is_visible: NDArray[np.bool_],
    color: Color,
    per_pixel: int,
) -> None:
    """Draw a line around bodies and between them, and tint the area inside.

    Where other bodies hide them, the line is faint, and nothing is tinted: they must not look like parts in front.

    Args:
        light: the light of samples multiplied by their opacity, shape (rows, width, 3), which is changed.
        alpha: the opacity of samples, shape (rows, width), which is changed.
        bodies: the number of the nearest outlined body at each sample, or -1, shape (rows, width).
        is_visible: the samples at which nothing hides the body, shape (rows, width).
        color: the color of the lines.
        per_pixel: the samples per pixel along a row.
    """
    reach = max(1, round(_WIDTH_PIXELS * per_pixel))
    window = find_window(bodies >= 0, reach)
    if window is None:
        return
    light, alpha, bodies, is_visible = light[window], alpha[window], bodies[window], is_visible[window]
    mask = bodies >= 0
    line = _dilate(mask, reach) & ~mask
    visible_line = line & _dilate(is_visible, reach)
    hidden_line = line & ~visible_line
    border = _find_borders(bodies, is_visible)
    if border.any():
        visible_line |= _dilate(border, round(_BORDER_WIDTH_PIXELS * per_pixel / 2)) & mask
    displayed = np.array(color, np.float32)
    paint = displayed * displayed
    _tint(light, alpha, is_visible, displayed)
    light[visible_line] = paint
    alpha[visible_line] = 1.0
    light[hidden_line] = light[hidden_line] * (1 - _HIDDEN_STRENGTH) + paint * _HIDDEN_STRENGTH
    alpha[hidden_line] = alpha[hidden_line] * (1 - _HIDDEN_STRENGTH) + _HIDDEN_STRENGTH


def _tint(light: Floats, alpha: Floats, mask: NDArray[np.bool_], displayed: Floats) -> None:
    """Mix a color into samples as it is displayed, so that dark and bright surfaces change alike."""
    opacity = alpha[mask]
    divisor = np.maximum(opacity, np.float32(1e-6))
    for channel, tint in zip(np.moveaxis(light, 2, 0), displayed * _TINT, strict=True):
        mixed = np.sqrt(channel[mask] / divisor) * (1 - _TINT) + tint
        channel[mask] = mixed * mixed * opacity


def _find_borders(bodies: NDArray[np.int32], is_visible: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return the samples next to a sample of another outlined body, one of them visible."""
    border = np.zeros_like(is_visible)
    for first, second in (
        ((slice(None), slice(None, -1)), (slice(None), slice(1, None))),
        ((slice(None, -1), slice(None)), (slice(1, None), slice(None))),
    ):
        is_border = (bodies[first] != bodies[second]) & (bodies[first] >= 0) & (bodies[second] >= 0)
        is_border &= is_visible[first] | is_visible[second]
        border[first] |= is_border
        border[second] |= is_border
    return border


def find_window(mask: NDArray[np.bool_], margin: int) -> tuple[slice, slice] | None:
    """Return the rows and columns that contain a mask and a margin around it; None for an empty mask."""
    rows, columns = (np.flatnonzero(mask.any(axis=axis)) for axis in (1, 0))
    if not len(rows):
        return None
    first_row, first_column = max(0, int(rows[0]) - margin), max(0, int(columns[0]) - margin)
    return slice(first_row, int(rows[-1]) + margin + 1), slice(first_column, int(columns[-1]) + margin + 1)


def _dilate(mask: NDArray[np.bool_], reach: int) -> NDArray[np.bool_]:
    """Return the samples within a distance from a mask."""
    dilated = np.zeros_like(mask)
    widened = mask.copy()
    width, rows = 0, len(mask)
    for shift in range(reach, -1, -1):
        while width < isqrt(reach * reach - shift * shift):
            width += 1
            widened[:, width:] |= mask[:, :-width]
            widened[:, :-width] |= mask[:, width:]
        if shift < rows:
            dilated[shift:] |= widened[: rows - shift]
            dilated[: rows - shift] |= widened[shift:]
    return dilated
