"""Marking the cells that contain points."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.grids.grid import Grid


def mark(grid: Grid, points: NDArray[np.float64], value: int) -> None:
    """Set the cells that contain points to a value; points outside of the grid are ignored.

    Args:
        grid: what is written on.
        points: of shape (..., 2), x and y in the frame of the grid, in metres.
        value: of the cells.
    """
    cells = grid.cells_of(points)
    cells = cells[grid.has(cells)]
    grid.cells[cells[:, 0], cells[:, 1]] = value
