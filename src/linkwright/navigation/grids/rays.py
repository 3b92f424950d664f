"""Ray casting in grids: the cells that lines cross, and the ranges of rays."""

from __future__ import annotations

from math import cos, sin
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.grids.grid import Grid

Cells = NDArray[np.int64]

_OUTSIDE: Final = -1.0
"""The value of the border around a distance field."""


def cells_on_lines(starts: NDArray[np.integer[Any]], ends: NDArray[np.integer[Any]]) -> tuple[Cells, Cells]:
    """Return the cells on straight lines between cells, by Bresenham's algorithm.

    Args:
        starts: rows and columns, of shape (lines, 2), or (2,) if all lines start at one cell.
        ends: rows and columns, of shape (lines, 2).

    Returns:
        Rows and columns of shape (n, 2), line by line, including both ends; and the index of the line that each cell
        belongs to, of shape (n,).
    """
    ends = np.asarray(ends, np.int64).reshape(-1, 2)
    starts = np.broadcast_to(np.asarray(starts, np.int64), ends.shape)
    delta = ends - starts
    steps: Cells = np.abs(delta).max(axis=1)
    line_indices: Cells = np.repeat(np.arange(len(ends)), steps + 1)
    first_steps: Cells = np.concatenate(([0], np.cumsum(steps + 1)[:-1])) if len(ends) else steps
    step_indices: Cells = np.arange(len(line_indices)) - first_steps[line_indices]
    # Integer rounding gives the same line on every machine.
    length: Cells = np.maximum(steps[line_indices], 1)[:, None]
    cells: Cells = starts[line_indices] + (2 * step_indices[:, None] * delta[line_indices] + length) // (2 * length)
    return cells, line_indices


def cast_rays(distances: Grid, points: NDArray[np.float64], angles: NDArray[np.float64], limit: float) -> Any:
    """Return the distance to the first occupied cell along each ray.

    Each ray advances by the distance to the nearest occupied cell, from a distance field, until that distance is nearly
    0.

    Args:
        distances: the distance to the nearest occupied cell in meters (see `distance_field`), 0 in occupied cells.
        points: the origins of the rays, x and y in the frame of the grid, in meters, of shape (..., 2).
        angles: the angles of the rays about z in that frame, in radians, of shape (...).
        limit: the range of rays that hit no cell or leave the grid, in meters.

    Returns:
        Ranges in meters, of shape (...), accurate to about half a cell.
    """
    shape = np.broadcast_shapes(points.shape[:-1], angles.shape)
    cosine, sine, size = cos(distances.yaw), sin(distances.yaw), distances.resolution
    x, y, grid_angles = points[..., 0] - distances.x, points[..., 1] - distances.y, angles - distances.yaw
    # Coordinates are in cells of the grid with a border, where rays leave the grid. Single precision is enough for an
    # accuracy of half a cell.
    column, row = _flat((cosine * x + sine * y) / size + 1.0, shape), _flat((cosine * y - sine * x) / size + 1.0, shape)
    column_steps, row_steps = _flat(np.cos(grid_angles), shape), _flat(np.sin(grid_angles), shape)
    field = np.pad((distances.cells / size).astype(np.float32), 1, constant_values=_OUTSIDE)
    # A ray advances at most to the border of the nearest occupied cell, but by at least half a cell; otherwise it could
    # stop.
    advances = np.where(field > 0.0, np.maximum(field - np.float32(0.75), np.float32(0.5)), field).ravel()
    max_length = np.float32(limit / size)
    hit_lengths: NDArray[np.float32] = np.full(row.size, max_length)
    lengths: NDArray[np.float32] = np.zeros(row.size, np.float32)
    active_rays: Cells = np.arange(row.size)
    while active_rays.size:
        cells = _clipped_indices(row + row_steps * lengths, distances.rows + 1).astype(np.int64)
        cells *= distances.columns + 2
        cells += _clipped_indices(column + column_steps * lengths, distances.columns + 1)
        advance = advances.take(cells)
        is_hit = advance == 0.0
        hit_lengths[active_rays[is_hit]] = lengths[is_hit]
        lengths += advance
        still_active = np.flatnonzero((advance > 0.0) & (lengths < max_length))
        row, column, column_steps, row_steps = (
            row.take(still_active),
            column.take(still_active),
            column_steps.take(still_active),
            row_steps.take(still_active),
        )
        lengths, active_rays = lengths.take(still_active), active_rays.take(still_active)
    return np.minimum(hit_lengths.astype(np.float64) * size, limit).reshape(shape)


def _flat(values: NDArray[np.float64], shape: tuple[int, ...]) -> NDArray[np.float32]:
    return np.broadcast_to(values.astype(np.float32), shape).ravel()


def _clipped_indices(values: NDArray[np.float32], max_index: int) -> NDArray[np.int32]:
    """Return the row or column indices of coordinates in cells, clipped to 0 and `max_index`.

    `values` are overwritten.
    """
    np.minimum(np.maximum(values, np.float32(0.0), out=values), np.float32(max_index), out=values)
    return values.astype(np.int32)
