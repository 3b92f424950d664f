"""A costmap: a grid of costs that can be queried for points and footprints.

Source: nav2_costmap_2d (the values of costs) and its ``FootprintCollisionChecker``.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.costmaps.footprints import Footprint, make_outline
from linkwright.navigation.grids.grid import Grid

FREE: Final = 0
MAX_PASSABLE: Final = 252
"""The maximum cost of a cell in which the center of the robot may be."""
INSCRIBED: Final = 253
"""An obstacle is nearer than the inscribed radius of the footprint, so a robot centered here touches it."""
LETHAL: Final = 254
"""The cell contains an obstacle."""
UNKNOWN: Final = 255
"""The cell has not been observed."""

_OUTLINE_POINTS_PER_CELL = 2.0
"""The number of checked points per cell of the outline of a footprint."""


class Costmap:
    """A grid of costs that is axis-aligned in its frame.

    Args:
        grid: the cells of type uint8, from `FREE` to `UNKNOWN`.

    Raises:
        ValueError: the cells have another type, or the grid is rotated.

    Attributes:
        grid: the cells, which the owner of the costmap may change.
    """

    def __init__(self, grid: Grid) -> None:
        if grid.cells.dtype != np.uint8 or grid.yaw:
            raise ValueError(f"a costmap needs uint8 cells and yaw 0, not {grid.cells.dtype} and yaw {grid.yaw:g}")
        self.grid = grid

    def copy(self) -> Costmap:
        """Return a copy with its own cells."""
        grid = self.grid
        return Costmap(Grid(cells=grid.cells.copy(), resolution=grid.resolution, x=grid.x, y=grid.y))

    def cost_at(self, points: NDArray[np.float64], outside_cost: int = UNKNOWN) -> NDArray[np.uint8]:
        """Return the costs of the cells that contain points.

        Args:
            points: x and y in the frame of the costmap, in meters, of shape (..., 2).
            outside_cost: the cost of points that are not in the grid.

        Returns:
            Costs, of shape (...).
        """
        indices = self.grid.cells_of(np.asarray(points, np.float64))
        is_inside = self.grid.contains(indices)
        indices = np.where(is_inside[..., None], indices, 0)
        costs: NDArray[np.uint8] = np.where(
            is_inside, self.grid.cells[indices[..., 0], indices[..., 1]], np.uint8(outside_cost)
        )
        return costs

    def compute_footprint_cost(
        self, poses: NDArray[np.float64] | tuple[float, float, float], footprint: Footprint
    ) -> Any:
        """Return the highest cost under the outline of a footprint, for one pose or many.

        Args:
            poses: x, y (meters) and yaw (radians) in the frame of the costmap, of shape (..., 3).
            footprint: the corners in the frame of the robot, in meters, of shape (corners, 2).

        Returns:
            Costs of shape (...); `LETHAL` if part of the outline is outside the grid and no part is in an unknown cell.
        """
        poses = np.asarray(poses, np.float64)
        outline_points = make_outline(footprint, self.grid.resolution / _OUTLINE_POINTS_PER_CELL)
        cosine, sine = np.cos(poses[..., 2, None]), np.sin(poses[..., 2, None])
        x = poses[..., 0, None] + cosine * outline_points[:, 0] - sine * outline_points[:, 1]
        y = poses[..., 1, None] + sine * outline_points[:, 0] + cosine * outline_points[:, 1]
        return self.cost_at(np.stack((x, y), axis=-1), outside_cost=LETHAL).max(axis=-1)
