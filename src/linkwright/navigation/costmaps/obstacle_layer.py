"""A costmap layer that marks the cells of sensor points and clears the rays to them.

Source: nav2_costmap_2d ``ObstacleLayer``.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.costmaps.costmap import FREE, LETHAL, UNKNOWN
from linkwright.navigation.costmaps.layer import (
    PersistentLayer,
    UpdateContext,
    Window,
    footprint_window,
    free_footprint,
)
from linkwright.navigation.costmaps.observations import Observation, ObservationBuffer
from linkwright.navigation.grids.grid import Grid
from linkwright.navigation.grids.rays import cells_on_lines

OVERWRITE, MAXIMUM, MAXIMUM_OF_KNOWN = 0, 1, 2
"""The ways to combine a layer's costs with the costs below: replace them, take the maximum, or take the maximum
of known cells only.
"""

Cells = NDArray[np.int64]


@dataclass(frozen=True, kw_only=True)
class HeightRange:
    """The height range of obstacles, in meters."""

    min_obstacle_height: float = 0.0
    max_obstacle_height: float = 2.0


class ObstacleLayer(PersistentLayer):
    """A layer that marks the cells of sensor points, and clears the rays to the points.

    Args:
        buffers: the observations, with one buffer for each sensor.
        heights: the height range of obstacles.
        combination_method: `OVERWRITE`, `MAXIMUM` or `MAXIMUM_OF_KNOWN`.
        footprint_clearing: whether to clear the cells under the robot.
    """

    def __init__(
        self,
        buffers: list[ObservationBuffer],
        heights: HeightRange,
        *,
        combination_method: int = MAXIMUM,
        footprint_clearing: bool = True,
    ) -> None:
        super().__init__()
        self.buffers = buffers
        self.heights = heights
        self.combination_method = combination_method
        self._footprint_clearing = footprint_clearing
        self._was_reset = False

    def reset(self) -> None:
        """Clear all cells.

        The layer is not current until its next update.
        """
        super().reset()
        self._was_reset = True

    def is_current(self, time_ns: int) -> bool:
        """Return whether the layer was updated since its reset and no sensor is overdue."""
        return not self._was_reset and all(buffer.is_current(time_ns) for buffer in self.buffers)

    def update_window(self, window: Window, context: UpdateContext, grid: Grid) -> Window:
        """Apply the valid observations, and return the window that must be rewritten."""
        self._was_reset = False
        window = window.union(self.pop_extra_window())
        observed = [
            (observation, buffer.source)
            for buffer in self.buffers
            for observation in buffer.select_valid(context.time_ns)
        ]
        for observation, source in observed:
            if source.clearing:
                window = window.union(self.clear_rays(observation, grid))
        for observation, source in observed:
            if source.marking:
                window = window.union(self.mark_points(observation, grid))
        if self._footprint_clearing:
            window = window.union(footprint_window(context, grid))
        return window

    def write_costs(self, grid: Grid, window: Window, context: UpdateContext) -> None:
        """Combine the layer's cells with the costs of the layers below.

        If footprint clearing is enabled, free the cells under the robot first.
        """
        if self._footprint_clearing:
            free_footprint(self.layer_grid.cells, context, self.layer_grid, window)
        own_costs, lower_costs = self.layer_grid.cells[window.cells], grid.cells[window.cells]
        is_written = own_costs != UNKNOWN
        if self.combination_method == MAXIMUM:
            is_written &= (lower_costs == UNKNOWN) | (lower_costs < own_costs)
        elif self.combination_method == MAXIMUM_OF_KNOWN:
            is_written &= (lower_costs != UNKNOWN) & (lower_costs < own_costs)
        lower_costs[is_written] = own_costs[is_written]

    def clear_rays(self, observation: Observation, grid: Grid) -> Window:
        """Free the cells on the rays to the points, and return the window around these cells."""
        start, ends, _ = find_ray_ends(observation, grid)
        cells, _ = cells_on_lines(start, ends)
        cells = cells[grid.contains(cells) & _find_cells_beyond_min_range(cells, start, observation, grid)]
        self.layer_grid.cells[cells[:, 0], cells[:, 1]] = FREE
        return Window.around(cells, grid)

    def mark_points(self, observation: Observation, grid: Grid) -> Window:
        """Mark the cells that contain obstacle points, and return the window around these cells."""
        cells = grid.cells_of(self.select_obstacles(observation)[:, :2])
        cells = cells[grid.contains(cells)]
        self.layer_grid.cells[cells[:, 0], cells[:, 1]] = LETHAL
        return Window.around(cells, grid)

    def select_obstacles(self, observation: Observation) -> NDArray[np.float64]:
        """Return the points within the range and the height limits for obstacles, of shape (n, 3)."""
        points = observation.select_obstacles()
        heights = points[:, 2]
        obstacle_points: NDArray[np.float64] = points[
            (heights >= self.heights.min_obstacle_height) & (heights <= self.heights.max_obstacle_height)
        ]
        return obstacle_points


def find_ray_ends(observation: Observation, grid: Grid) -> tuple[Cells, Cells, NDArray[np.float64]]:
    """Return the sensor's cell and the end cells of its clearing rays.

    Returns:
        The cell of the sensor, of shape (2,); the cells in which rays end, clipped to the maximum range and without
        duplicates, of shape (n, 2); and the height at which each ray ends, in meters, of shape (n,).
    """
    origin, points = observation.origin, observation.points
    offsets = points - origin
    lengths = np.hypot(offsets[:, 0], offsets[:, 1])
    fractions = np.minimum(1.0, observation.source.raytrace_max_range / np.maximum(lengths, np.finfo(float).tiny))
    ends = origin + fractions[:, None] * offsets
    start = grid.cells_of(origin[None, :2])[0]
    cells = grid.cells_of(ends[:, :2])
    # A point cloud has many points per cell. A table of the cells around the sensor removes duplicates without sorting.
    reach_in_cells = ceil(observation.source.raytrace_max_range / grid.resolution) + 1
    table_indices = (cells - start + reach_in_cells) @ np.array([2 * reach_in_cells + 1, 1])
    last_ray_in_cell = np.full((2 * reach_in_cells + 1) ** 2, -1)
    last_ray_in_cell[table_indices] = np.arange(len(table_indices))
    ray_indices = last_ray_in_cell[last_ray_in_cell >= 0]
    return start, cells[ray_indices], ends[ray_indices, 2]


def _find_cells_beyond_min_range(cells: Cells, start: Cells, observation: Observation, grid: Grid) -> NDArray[np.bool_]:
    """Return a mask of the cells beyond the minimum range for clearing."""
    min_range = observation.source.raytrace_min_range / grid.resolution
    offsets = cells - start
    is_beyond: NDArray[np.bool_] = (offsets**2).sum(axis=1) >= min_range**2
    return is_beyond
