"""A costmap layer with the costs of a map's occupancy grid.

Source: nav2_costmap_2d ``StaticLayer``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.costmaps.costmap import FREE, LETHAL, UNKNOWN
from linkwright.navigation.costmaps.layer import Costs, Layer, UpdateContext, Window, footprint_window, free_footprint
from linkwright.navigation.grids.grid import Grid

MapPose = tuple[float, float, float]
"""x, y (meters) and yaw (radians) of the costmap's frame in the map's frame."""

_IDENTITY: MapPose = (0.0, 0.0, 0.0)
_ALIGNMENT_TOLERANCE = 1e-3
"""The tolerance, in cells, within which two grids are aligned."""


@dataclass(frozen=True, kw_only=True)
class Interpretation:
    """The conversion of an occupancy grid's values to costs.

    Attributes:
        track_unknown_space: whether unknown cells stay unknown; otherwise they are free.
        unknown_cost_value: the value that means unknown, as an unsigned byte: -1 is 255.
        lethal_threshold: the lowest value of an obstacle.
        trinary: whether all other cells are free; otherwise their cost is proportional to the value.
    """

    track_unknown_space: bool = False
    unknown_cost_value: int = 255
    lethal_threshold: int = 100
    trinary: bool = True

    def cost_table(self) -> Costs:
        """Return the cost for each byte of an occupancy grid, of shape (256,)."""
        values = np.arange(256)
        costs = np.full(256, FREE) if self.trinary else values * LETHAL // max(1, self.lethal_threshold)
        costs[values >= self.lethal_threshold] = LETHAL
        costs[self.unknown_cost_value] = UNKNOWN if self.track_unknown_space else FREE
        table: Costs = costs.astype(np.uint8)
        return table


class StaticLayer(Layer):
    """A layer that writes the costs of a map.

    Args:
        interpretation: the conversion of the map's values.
        use_maximum: whether the layer may only raise costs.
        footprint_clearing: whether to clear the cells under the robot.
        pose: returns the pose of the costmap's frame in the map's frame, or None while it is unknown.

    Attributes:
        map: the map's costs in the frame of the map; None before the first map.
    """

    def __init__(
        self,
        interpretation: Interpretation,
        *,
        use_maximum: bool = False,
        footprint_clearing: bool = False,
        pose: Callable[[], MapPose | None] = lambda: (0.0, 0.0, 0.0),
    ) -> None:
        self.interpretation = interpretation
        self.map: Grid | None = None
        self._use_maximum = use_maximum
        self._footprint_clearing = footprint_clearing
        self._pose = pose
        self._map_pose: MapPose | None = None
        self._needs_rewrite = True

    def set_map(self, occupancy: Grid) -> None:
        """Set a new map.

        The cells of `occupancy` are of type int8: occupancies in percent, or -1 for unknown.
        """
        costs = self.interpretation.cost_table()[occupancy.cells.astype(np.uint8)]
        self.map = Grid(cells=costs, resolution=occupancy.resolution, x=occupancy.x, y=occupancy.y, yaw=occupancy.yaw)
        self._needs_rewrite = True

    def update_map(self, top: int, left: int, occupancy: Costs) -> bool:
        """Update a part of the map.

        Returns False and leaves the map unchanged if the part is not within the map.
        """
        rows, columns = occupancy.shape
        map_grid = self.map
        if map_grid is None or min(top, left) < 0 or top + rows > map_grid.rows or left + columns > map_grid.columns:
            return False
        map_grid.cells[top : top + rows, left : left + columns] = self.interpretation.cost_table()[
            occupancy.astype(np.uint8)
        ]
        self._needs_rewrite = True
        return True

    def match_grid(self, grid: Grid, default: int) -> None:
        """Make the next update write all cells."""
        self._needs_rewrite = True

    def reset(self) -> None:
        """Keep the map, and make the next update write all cells."""
        self._needs_rewrite = True

    def is_current(self, time_ns: int) -> bool:
        """Return whether there is a map whose pose is known or requested by the next update."""
        return self.map is not None and (self._map_pose is not None or self._needs_rewrite)

    def update_window(self, window: Window, context: UpdateContext, grid: Grid) -> Window:
        """Return the window that must be rewritten: the whole grid after a new map or transform."""
        if self.map is None:
            return window
        pose = self._pose()
        if pose != self._map_pose:
            self._map_pose, self._needs_rewrite = pose, True
        if self._footprint_clearing:
            window = window.union(footprint_window(context, grid))
        if not self._needs_rewrite:
            return window
        self._needs_rewrite = False
        return Window.of(grid)

    def write_costs(self, grid: Grid, window: Window, context: UpdateContext) -> None:
        """Write the map's costs into the window.

        If footprint clearing is enabled, free the cells under the robot afterwards.
        """
        if self.map is None or self._map_pose is None:
            return
        window_cells = grid.cells[window.cells]
        covered, costs = self._find_aligned_cells(grid, window) or self._sample_cells(grid, window)
        window_cells[covered] = self._merge(window_cells[covered], costs)
        if self._footprint_clearing:
            free_footprint(grid.cells, context, grid, window)

    def _merge(self, cells: Costs, costs: Costs) -> Costs:
        """Return the costs of cells after the map's costs are written into them."""
        merged: Costs = np.maximum(cells, costs) if self._use_maximum else costs
        return merged

    def _find_aligned_cells(self, grid: Grid, window: Window) -> tuple[tuple[slice, slice], Costs] | None:
        """Return the index of the window's cells that the map covers, and the costs of these cells.

        Returns None if the grids are not aligned.
        """
        map_grid = self.map
        assert map_grid is not None
        if self._map_pose != _IDENTITY or map_grid.yaw or map_grid.resolution != grid.resolution:
            return None
        row_offset, column_offset = (grid.y - map_grid.y) / grid.resolution, (grid.x - map_grid.x) / grid.resolution
        rows, columns = round(row_offset), round(column_offset)
        if abs(row_offset - rows) + abs(column_offset - columns) > _ALIGNMENT_TOLERANCE:
            return None
        map_window = Window(
            window.top + rows, window.left + columns, window.bottom + rows, window.right + columns
        ).clipped_to(map_grid)
        top, left = map_window.top - rows - window.top, map_window.left - columns - window.left
        if map_window.is_empty:
            return (slice(0, 0), slice(0, 0)), map_grid.cells[map_window.cells]
        covered = (
            slice(top, top + map_window.bottom - map_window.top),
            slice(left, left + map_window.right - map_window.left),
        )
        return covered, map_grid.cells[map_window.cells]

    def _sample_cells(self, grid: Grid, window: Window) -> tuple[NDArray[np.bool_], Costs]:
        """Return a mask of the window's cells that the map covers, and the costs of these cells.

        The map is sampled at the cell centers, for grids that are not aligned.
        """
        assert self.map is not None
        assert self._map_pose is not None
        rows, columns = np.mgrid[window.top : window.bottom, window.left : window.right]
        centers = grid.centers_of(np.stack((rows, columns), axis=-1))
        x, y, yaw = self._map_pose
        cosine, sine = np.cos(yaw), np.sin(yaw)
        indices = self.map.cells_of(centers @ np.array([[cosine, sine], [-sine, cosine]]) + (x, y))
        is_inside = self.map.contains(indices)
        indices = indices[is_inside]
        return is_inside, self.map.cells[indices[:, 0], indices[:, 1]]
