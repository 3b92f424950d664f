"""The voxel layer: an obstacle layer that distinguishes height levels.

A ray clears only the levels that it crosses.

Source: nav2_costmap_2d ``VoxelLayer``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.costmaps.costmap import FREE, LETHAL, UNKNOWN
from linkwright.navigation.costmaps.layer import Window, shift_cells
from linkwright.navigation.costmaps.observations import Observation, ObservationBuffer
from linkwright.navigation.costmaps.obstacle_layer import Cells, HeightRange, ObstacleLayer, find_ray_ends
from linkwright.navigation.grids.grid import Grid
from linkwright.navigation.grids.rays import cells_on_lines

MAX_LEVELS: Final = 16
_ALL_LEVELS: Final = (1 << MAX_LEVELS) - 1
_BIT_COUNTS: Final = np.array([number.bit_count() for number in range(1 << MAX_LEVELS)], np.uint8)
"""The number of set bits of each 16-bit number."""

Levels = NDArray[np.uint16]
"""A 16-bit number for each cell, with one bit for each level."""


@dataclass(frozen=True, kw_only=True)
class Voxels:
    """The height levels in a column of cells.

    Attributes:
        origin_z: the bottom of the lowest level, in meters.
        z_resolution: the height of a level, in meters.
        z_voxels: the number of levels, up to 16.
        unknown_threshold: a column with more unknown levels than this is unknown.
        mark_threshold: a column with more occupied levels than this is an obstacle.
    """

    origin_z: float = 0.0
    z_resolution: float = 0.2
    z_voxels: int = 10
    unknown_threshold: int = 15
    mark_threshold: int = 0


class VoxelLayer(ObstacleLayer):
    """An `ObstacleLayer` that marks and clears voxels."""

    def __init__(
        self,
        buffers: list[ObservationBuffer],
        heights: HeightRange,
        voxels: Voxels,
        *,
        combination_method: int = 1,
        footprint_clearing: bool = True,
    ) -> None:
        super().__init__(buffers, heights, combination_method=combination_method, footprint_clearing=footprint_clearing)
        self._voxels = voxels
        self._unknown_threshold = voxels.unknown_threshold + MAX_LEVELS - voxels.z_voxels
        self._occupied: Levels = np.zeros((0, 0), np.uint16)
        self._unknown: Levels = np.zeros((0, 0), np.uint16)

    def match_grid(self, grid: Grid, default: int) -> None:
        """Move the voxels to a new grid.

        Voxels outside the old grid are unknown.
        """
        self._occupied = shift_cells(self._occupied, self.layer_grid, grid, 0)
        self._unknown = shift_cells(self._unknown, self.layer_grid, grid, _ALL_LEVELS)
        super().match_grid(grid, default)

    def reset(self) -> None:
        """Set all voxels to unknown.

        The layer is not current until its next update.
        """
        super().reset()
        self._occupied[:] = 0
        self._unknown[:] = _ALL_LEVELS

    def clear(self, window: Window, *, clear_outside: bool) -> None:
        """Set the voxels in a window, or all voxels outside it, to unknown."""
        is_cleared = np.zeros(self._unknown.shape, np.bool_)
        is_cleared[window.cells] = True
        is_cleared ^= clear_outside
        self._occupied[is_cleared], self._unknown[is_cleared] = 0, _ALL_LEVELS
        super().clear(window, clear_outside=clear_outside)

    def clear_rays(self, observation: Observation, grid: Grid) -> Window:
        """Free the voxels on the rays to the points, and return the window around their cells."""
        start, ends, heights = find_ray_ends(observation, grid)
        cells, ray_indices = cells_on_lines(start, ends)
        steps = np.bincount(ray_indices, minlength=len(ends))
        first_steps = np.concatenate(([0], np.cumsum(steps)[:-1])) if len(ends) else steps
        fractions = (np.arange(len(ray_indices)) - first_steps[ray_indices]) / np.maximum(steps[ray_indices] - 1, 1)
        cell_heights = observation.origin[2] + fractions * (heights[ray_indices] - observation.origin[2])
        min_range = observation.source.raytrace_min_range / grid.resolution
        levels, is_cleared = self._find_levels(cell_heights)
        is_cleared &= grid.contains(cells) & (((cells - start) ** 2).sum(axis=1) >= min_range**2)
        cells, bits = cells[is_cleared], np.left_shift(1, levels[is_cleared]).astype(np.uint16)
        np.bitwise_and.at(self._occupied, (cells[:, 0], cells[:, 1]), ~bits)
        np.bitwise_and.at(self._unknown, (cells[:, 0], cells[:, 1]), ~bits)
        self._update_costs(cells)
        return Window.around(cells, grid)

    def mark_points(self, observation: Observation, grid: Grid) -> Window:
        """Mark the voxels that contain points, and return the window around their cells."""
        points = self.select_obstacles(observation)
        cells = grid.cells_of(points[:, :2])
        levels, is_marked = self._find_levels(points[:, 2])
        is_marked &= grid.contains(cells)
        cells, bits = cells[is_marked], np.left_shift(1, levels[is_marked]).astype(np.uint16)
        np.bitwise_or.at(self._occupied, (cells[:, 0], cells[:, 1]), bits)
        np.bitwise_and.at(self._unknown, (cells[:, 0], cells[:, 1]), ~bits)
        self._update_costs(cells)
        return Window.around(cells, grid)

    def _find_levels(self, heights: NDArray[np.float64]) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
        """Return the level of each height, and a mask of the heights that are within the levels."""
        levels = np.floor((heights - self._voxels.origin_z) / self._voxels.z_resolution).astype(np.int64)
        is_within = (levels >= 0) & (levels < self._voxels.z_voxels)
        return np.where(is_within, levels, 0), is_within

    def _update_costs(self, cells: Cells) -> None:
        """Compute the costs of cells from the numbers of their occupied and unknown voxels."""
        rows, columns = cells[:, 0], cells[:, 1]
        occupied, unknown = _BIT_COUNTS[self._occupied[rows, columns]], _BIT_COUNTS[self._unknown[rows, columns]]
        base_costs = np.where(unknown > self._unknown_threshold, UNKNOWN, FREE)
        self.layer_grid.cells[rows, columns] = np.where(occupied > self._voxels.mark_threshold, LETHAL, base_costs)
