"""A grid of square cells with a pose in a frame."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

FREE: Final = 0
OCCUPIED: Final = 100
UNKNOWN: Final = -1
"""Values of nav_msgs/OccupancyGrid. Values from ``FREE`` to ``OCCUPIED`` are occupancies in percent."""


@dataclass(eq=False, kw_only=True)
class Grid:
    """A grid of square cells with a pose in a frame.

    Args:
        cells: the values, of shape (rows, columns): ``cells[row, column]``, rows along y. Their type and meaning depend
            on the use (int8 for nav_msgs/OccupancyGrid, uint8 for costs).
        resolution: the side of a cell, in meters.
        x: the x coordinate of the outer corner of cell (0, 0) in the frame of the grid, in meters.
        y: the y coordinate of that corner, in meters.
        yaw: the rotation of the grid about that corner, in radians.
    """

    cells: NDArray[Any]
    resolution: float
    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0

    @property
    def rows(self) -> int:
        """The number of rows."""
        return int(self.cells.shape[0])

    @property
    def columns(self) -> int:
        """The number of columns."""
        return int(self.cells.shape[1])

    def cells_of(self, points: NDArray[np.float64]) -> NDArray[np.int64]:
        """Return the rows and columns of the cells that contain points, even outside the grid.

        Args:
            points: x and y in the frame of the grid, in meters, of shape (..., 2).

        Returns:
            Rows and columns, of shape (..., 2).
        """
        x = points[..., 0] - self.x
        y = points[..., 1] - self.y
        if self.yaw:
            cosine, sine = cos(self.yaw), sin(self.yaw)
            x, y = cosine * x + sine * y, cosine * y - sine * x
        indices: NDArray[np.int64] = np.floor(np.stack((y, x), axis=-1) / self.resolution).astype(np.int64)
        return indices

    def centers_of(self, indices: NDArray[np.integer[Any]]) -> NDArray[np.float64]:
        """Return the centers of cells.

        Args:
            indices: rows and columns, of shape (..., 2).

        Returns:
            x and y in the frame of the grid, in meters, of shape (..., 2).
        """
        y = (indices[..., 0] + 0.5) * self.resolution
        x = (indices[..., 1] + 0.5) * self.resolution
        if self.yaw:
            cosine, sine = cos(self.yaw), sin(self.yaw)
            x, y = cosine * x - sine * y, sine * x + cosine * y
        points: NDArray[np.float64] = np.stack((x + self.x, y + self.y), axis=-1)
        return points

    def contains(self, indices: NDArray[np.integer[Any]]) -> NDArray[np.bool_]:
        """Return a mask of the cells that are inside the grid, of shape (...).

        `indices` are rows and columns, of shape (..., 2).
        """
        rows, columns = indices[..., 0], indices[..., 1]
        is_inside: NDArray[np.bool_] = (rows >= 0) & (rows < self.rows) & (columns >= 0) & (columns < self.columns)
        return is_inside
