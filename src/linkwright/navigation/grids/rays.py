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
    line: Cells = np.repeat(np.arange(len(ends)), steps + 1)
    first: Cells = np.concatenate(([0], np.cumsum(steps + 1)[:-1])) if len(ends) else steps
    step: Cells = np.arange(len(line)) - first[line]
    # Round with integers so that a line is the same on every machine.
    length: Cells = np.maximum(steps[line], 1)[:, None]
    cells: Cells = starts[line] + (2 * step[:, None] * delta[line] + length) // (2 * length)
    return cells, line


def ranges(distances: Grid, points: NDArray[np.float64], angles: NDArray[np.float64], limit: float) -> Any:
    """Return the distance to the first occupied cell along each ray.

    Each ray advances by the distance to the nearest occupied cell, from a distance field, until that distance is nearly
    0.

    Args:
        distances: the metres to the nearest occupied cell (see `distance_field`), 0 in occupied cells.
        points: the origins of the rays, x and y in the frame of the grid, in metres, of shape (..., 2).
        angles: the angles of the rays about z in that frame, in radians, of shape (...).
        limit: the range of rays that hit nothing or leave the grid, in metres.

    Returns:
        Ranges in metres, of shape (...), accurate to about half a cell.
    """
    shape = np.broadcast_shapes(points.shape[:-1], angles.shape)
    c, s, size = cos(distances.yaw), sin(distances.yaw), distances.resolution
    x, y, turned = points[..., 0] - distances.x, points[..., 1] - distances.y, angles - distances.yaw
    # Coordinates are in cells of the grid with a border, where rays leave the grid. Single precision suffices for half
    # a
    # cell.
    column, row = _flat((c * x + s * y) / size + 1.0, shape), _flat((c * y - s * x) / size + 1.0, shape)
    along, across = _flat(np.cos(turned), shape), _flat(np.sin(turned), shape)
    field = np.pad((distances.cells / size).astype(np.float32), 1, constant_values=_OUTSIDE)
    # Advance no farther than the border of the cell to which the distance was measured, but by at least half a cell;
    # otherwise rays could stop.
    ways = np.where(field > 0.0, np.maximum(field - np.float32(0.75), np.float32(0.5)), field).ravel()
    most = np.float32(limit / size)
    travelled: NDArray[np.float32] = np.full(row.size, most)
    so_far: NDArray[np.float32] = np.zeros(row.size, np.float32)
    under_way: Cells = np.arange(row.size)
    while under_way.size:
        cells = _index(row + across * so_far, distances.rows + 1).astype(np.int64)
        cells *= distances.columns + 2
        cells += _index(column + along * so_far, distances.columns + 1)
        way = ways.take(cells)
        met = way == 0.0
        travelled[under_way[met]] = so_far[met]
        so_far += way
        going = np.flatnonzero((way > 0.0) & (so_far < most))
        row, column, along, across = row.take(going), column.take(going), along.take(going), across.take(going)
        so_far, under_way = so_far.take(going), under_way.take(going)
    return np.minimum(travelled.astype(np.float64) * size, limit).reshape(shape)


def _flat(values: NDArray[np.float64], shape: tuple[int, ...]) -> NDArray[np.float32]:
    return np.broadcast_to(values.astype(np.float32), shape).ravel()


def _index(values: NDArray[np.float32], last: int) -> NDArray[np.int32]:
    """Return the row or column indices of coordinates in cells, clipped to the grid.

    `values` are overwritten.
    """
    np.minimum(np.maximum(values, np.float32(0.0), out=values), np.float32(last), out=values)
    return values.astype(np.int32)
