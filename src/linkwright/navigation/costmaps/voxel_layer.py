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
from linkwright.navigation.costmaps.obstacle_layer import Cells, Heights, ObstacleLayer, ray_ends
from linkwright.navigation.grids.grid import Grid
from linkwright.navigation.grids.rays import cells_on_lines

MOST_LEVELS: Final = 16
_ALL: Final = (1 << MOST_LEVELS) - 1
_BITS: Final = np.array([number.bit_count() for number in range(1 << MOST_LEVELS)], np.uint8)
"""The number of set bits of each 16-bit number."""

Levels = NDArray[np.uint16]
"""A bit for each level."""


@dataclass(frozen=True, kw_only=True)
class Voxels:
    """The height levels in a column of cells.

    Attributes:
        origin_z: the bottom of the lowest level, in metres.
        z_resolution: the height of a level, in metres.
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
        heights: Heights,
        voxels: Voxels,
        *,
        combination_method: int = 1,
        footprint_clearing: bool = True,
    ) -> None:
        super().__init__(buffers, heights, combination_method=combination_method, footprint_clearing=footprint_clearing)
        self._voxels = voxels
        self._unknown_threshold = voxels.unknown_threshold + MOST_LEVELS - voxels.z_voxels
        self._occupied: Levels = np.zeros((0, 0), np.uint16)
        self._unknown: Levels = np.zeros((0, 0), np.uint16)

    def match(self, grid: Grid, default: int) -> None:
        """Move the voxels to a new grid, with unknown ones where the old grid had no cells."""
        self._occupied = shift_cells(self._occupied, self.seen, grid, 0)
        self._unknown = shift_cells(self._unknown, self.seen, grid, _ALL)
        super().match(grid, default)

    def reset(self) -> None:
        """Set all voxels to unknown; the layer is not current until its next update."""
        super().reset()
        self._occupied[:] = 0
        self._unknown[:] = _ALL

    def clear(self, window: Window, *, outside: bool) -> None:
        """Set the voxels in a window, or all voxels outside it, to unknown."""
        gone = np.zeros(self._unknown.shape, np.bool_)
        gone[window.cells] = True
        gone ^= outside
        self._occupied[gone], self._unknown[gone] = 0, _ALL
        super().clear(window, outside=outside)

    def clear_rays(self, observation: Observation, grid: Grid) -> Window:
        """Free the voxels on the rays to the points, and return the window around their cells."""
        start, ends, heights = ray_ends(observation, grid)
        cells, ray = cells_on_lines(start, ends)
        steps = np.bincount(ray, minlength=len(ends))
        first = np.concatenate(([0], np.cumsum(steps)[:-1])) if len(ends) else steps
        share = (np.arange(len(ray)) - first[ray]) / np.maximum(steps[ray] - 1, 1)
        height = observation.origin[2] + share * (heights[ray] - observation.origin[2])
        least = observation.source.raytrace_min_range / grid.resolution
        levels, counts = self._levels(height)
        counts &= grid.has(cells) & (((cells - start) ** 2).sum(axis=1) >= least**2)
        cells, bits = cells[counts], np.left_shift(1, levels[counts]).astype(np.uint16)
        np.bitwise_and.at(self._occupied, (cells[:, 0], cells[:, 1]), ~bits)
        np.bitwise_and.at(self._unknown, (cells[:, 0], cells[:, 1]), ~bits)
        self._judge(cells)
        return Window.around(cells, grid)

    def mark_points(self, observation: Observation, grid: Grid) -> Window:
        """Mark the voxels that contain points, and return the window around their cells."""
        points = self.obstacles(observation)
        cells = grid.cells_of(points[:, :2])
        levels, counts = self._levels(points[:, 2])
        counts &= grid.has(cells)
        cells, bits = cells[counts], np.left_shift(1, levels[counts]).astype(np.uint16)
        np.bitwise_or.at(self._occupied, (cells[:, 0], cells[:, 1]), bits)
        np.bitwise_and.at(self._unknown, (cells[:, 0], cells[:, 1]), ~bits)
        self._judge(cells)
        return Window.around(cells, grid)

    def _levels(self, heights: NDArray[np.float64]) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
        """Return the level of each height, and a mask of the heights that are within the levels."""
        levels = np.floor((heights - self._voxels.origin_z) / self._voxels.z_resolution).astype(np.int64)
        there = (levels >= 0) & (levels < self._voxels.z_voxels)
        return np.where(there, levels, 0), there

    def _judge(self, cells: Cells) -> None:
        """Compute the costs of cells from the numbers of their occupied and unknown voxels."""
        rows, columns = cells[:, 0], cells[:, 1]
        occupied, unknown = _BITS[self._occupied[rows, columns]], _BITS[self._unknown[rows, columns]]
        known = np.where(unknown > self._unknown_threshold, UNKNOWN, FREE)
        self.seen.cells[rows, columns] = np.where(occupied > self._voxels.mark_threshold, LETHAL, known)
