"""Thin dark lines along the borders and creases of the visible surface."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from linkwright.picture.smoothing import CREASE_COSINE
from linkwright.picture.vectors import Floats

_MIN_SLOPE_JUMP = 0.006
"""The change of the distance's slope, relative to the scene's depth, that marks a surface in front of another."""
_OUTER_DARKNESS, _INNER_DARKNESS = 0.88, 0.55
"""The darkness of lines at the ends of surfaces and at creases, from 0 to 1."""
_DENSE_SHARE = 0.30
"""The share of samples on lines above which lines fade, because details are smaller than the lines."""
_DENSITY_REACH_PIXELS = 2
"""The number of pixels around a pixel in which lines are counted."""


def compute_edge_strength(distances: Floats, normals: Floats, bodies: NDArray[np.int32], per_pixel: int) -> Floats:
    """Return the darkness of lines at each sample, from 0 to 1.

    Args:
        distances: the distance at each sample, shape (rows, width); 2 where nothing is seen.
        normals: the unit normals of the surface, shape (3, rows, width).
        bodies: the number of the body at each sample, -1 where nothing is seen.
        per_pixel: the samples per pixel along a row; `rows` and `width` are multiples of it.
    """
    is_seen = bodies >= 0
    is_outer = np.zeros(bodies.shape, dtype=bool)
    is_inner = np.zeros(bodies.shape, dtype=bool)
    for axis in (0, 1):
        first, second = _pair_slices(axis)
        is_other_body = bodies[first] != bodies[second]
        is_outer[first] |= is_other_body
        is_outer[second] |= is_other_body
        normal_cosines = normals[0][first] * normals[0][second]
        normal_cosines += normals[1][first] * normals[1][second]
        normal_cosines += normals[2][first] * normals[2][second]
        is_crease = normal_cosines < CREASE_COSINE
        is_inner[first] |= is_crease
        is_inner[second] |= is_crease
        steps = distances[second] - distances[first]
        previous, following = _pair_slices(axis)
        middle = (slice(1, -1), slice(None)) if axis == 0 else (slice(None), slice(1, -1))
        is_outer[middle] |= np.abs(steps[following] - steps[previous]) > _MIN_SLOPE_JUMP
    is_outer |= _find_neighbors(is_outer)
    is_outer &= is_seen
    is_inner &= is_seen & ~is_outer
    strength = np.where(
        is_outer, np.float32(_OUTER_DARKNESS), np.where(is_inner, np.float32(_INNER_DARKNESS), np.float32(0.0))
    )
    fading = _compute_fading(is_outer | is_inner, is_seen, per_pixel)
    strength *= np.repeat(np.repeat(fading, per_pixel, axis=0), per_pixel, axis=1)
    return strength


def _find_neighbors(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return the samples next to the samples in a mask."""
    neighbors = np.zeros_like(mask)
    for axis in (0, 1):
        first, second = _pair_slices(axis)
        neighbors[first] |= mask[second]
        neighbors[second] |= mask[first]
    return neighbors


def _pair_slices(axis: int) -> tuple[tuple[slice, slice], tuple[slice, slice]]:
    """Return slices along an axis: all samples except the last, and all except the first."""
    if axis == 0:
        return (slice(None, -1), slice(None)), (slice(1, None), slice(None))
    return (slice(None), slice(None, -1)), (slice(None), slice(1, None))


def _compute_fading(is_line: NDArray[np.bool_], is_seen: NDArray[np.bool_], per_pixel: int) -> Floats:
    """Return a factor for each pixel, below 1 where lines are too dense to be distinguished."""
    line_count, visible_count = (
        sum_over_boxes(sum_by_pixel(mask, per_pixel), _DENSITY_REACH_PIXELS) for mask in (is_line, is_seen)
    )
    density = line_count.astype(np.float32) / np.maximum(visible_count, 1).astype(np.float32)
    excess = np.maximum(density / np.float32(_DENSE_SHARE), np.float32(1.0))
    factor: Floats = np.float32(1.0) / (excess * excess)
    return factor


def sum_by_pixel(mask: NDArray[np.bool_], per_pixel: int) -> NDArray[np.int64]:
    """Return the number of samples of each pixel in a mask."""
    rows, width = mask.shape
    counts = np.zeros((rows // per_pixel, width // per_pixel), np.int64)
    for row in range(per_pixel):
        for column in range(per_pixel):
            counts += mask[row::per_pixel, column::per_pixel]
    return counts


def sum_over_boxes(values: NDArray[np.int64], reach: int) -> NDArray[np.int64]:
    """Return the sums of integers over the square around each pixel, clipped at the border."""
    for axis in (0, 1):
        totals = np.cumsum(values, axis=axis)
        count = values.shape[axis]
        positions = np.arange(count)
        upper = totals.take(np.minimum(positions + reach, count - 1), axis=axis)
        lower_positions = positions - reach - 1
        lower = totals.take(np.maximum(lower_positions, 0), axis=axis)
        has_lower = (lower_positions >= 0)[:, None] if axis == 0 else (lower_positions >= 0)[None, :]
        values = upper - np.where(has_lower, lower, 0)
    return values
