"""Rays through cells: which cells many lines go through, and how far many rays get."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.grids.grid import Grid

Cells = NDArray[np.int64]


def cells_on_lines(starts: NDArray[np.integer[Any]], ends: NDArray[np.integer[Any]]) -> tuple[Cells, Cells]:
    """The cells on straight lines between cells, as Bresenham's algorithm draws them, for all lines at once.

    Args:
        starts: rows and columns, of shape (lines, 2), or (2,) where all lines start at one cell.
        ends: of shape (lines, 2).

    Returns:
        Rows and columns of shape (n, 2), line after line from start to end, neither left out; and of shape (n,) the
        number of the line that each belongs to.
    """
    ends = np.asarray(ends, np.int64).reshape(-1, 2)
    starts = np.broadcast_to(np.asarray(starts, np.int64), ends.shape)
    delta = ends - starts
    steps: Cells = np.abs(delta).max(axis=1)
    line: Cells = np.repeat(np.arange(len(ends)), steps + 1)
    first: Cells = np.concatenate(([0], np.cumsum(steps + 1)[:-1])) if len(ends) else steps
    step: Cells = np.arange(len(line)) - first[line]
    # Rounded in whole numbers, so that a line is the same on every machine.
    length: Cells = np.maximum(steps[line], 1)[:, None]
    cells: Cells = starts[line] + (2 * step[:, None] * delta[line] + length) // (2 * length)
    return cells, line


def ranges(distances: Grid, points: NDArray[np.float64], angles: NDArray[np.float64], limit: float) -> Any:
    """How far rays get before they meet an occupied cell.

    Each goes on by the distance to the nearest occupied cell, which a distance field tells, until that is no way.

    Args:
        distances: metres to the nearest occupied cell (see `distance_field`), 0 in those that are occupied.
        points: where the rays begin, x and y in the frame of the grid, in metres, of shape (..., 2).
        angles: of the rays about z in that frame, in radians, of shape (...).
        limit: where rays end that meet nothing or leave the grid, in metres.

    Returns:
        Metres, of shape (...), exact to about half a cell.
    """
    shape = np.broadcast_shapes(points.shape[:-1], angles.shape)
    origins = np.broadcast_to(points, (*shape, 2)).reshape(-1, 2)
    turned = np.broadcast_to(angles, shape).reshape(-1)
    along = np.stack((np.cos(turned), np.sin(turned)), axis=-1)
    travelled = np.zeros(len(origins))
    under_way: Cells = np.arange(len(origins))
    # No farther than the rim of the cell that the distance is to, and never less than half a cell, or nothing moves.
    rim, least = distances.resolution * 0.75, distances.resolution * 0.5
    while under_way.size:
        at = origins[under_way] + travelled[under_way, None] * along[under_way]
        cells = distances.cells_of(at)
        inside = distances.has(cells)
        travelled[under_way[~inside]] = limit
        under_way, cells = under_way[inside], cells[inside]
        free = distances.cells[cells[:, 0], cells[:, 1]]
        going = free > 0
        under_way = under_way[going]
        travelled[under_way] += np.maximum(free[going] - rim, least)
        under_way = under_way[travelled[under_way] < limit]
    return np.minimum(travelled, limit).reshape(shape)
