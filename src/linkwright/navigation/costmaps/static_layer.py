"""The static layer, which writes the costs of a map's occupancy grid.

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
"""x, y (metres) and yaw (radians) of the costmap's frame in that of the map."""

_SAME_PLACE: MapPose = (0.0, 0.0, 0.0)
_ROUNDING = 1e-3
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

    def table(self) -> Costs:
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
        self._placed: MapPose | None = None
        self._news = True

    def set_map(self, occupancy: Grid) -> None:
        """Set a new map, with cells of type int8 in per cent, or -1 for unknown."""
        costs = self.interpretation.table()[occupancy.cells.astype(np.uint8)]
        self.map = Grid(cells=costs, resolution=occupancy.resolution, x=occupancy.x, y=occupancy.y, yaw=occupancy.yaw)
        self._news = True

    def update_map(self, top: int, left: int, occupancy: Costs) -> bool:
        """Update a part of the map.

        Returns False and changes nothing if the part is not within the map.
        """
        rows, columns = occupancy.shape
        known = self.map
        if known is None or min(top, left) < 0 or top + rows > known.rows or left + columns > known.columns:
            return False
        known.cells[top : top + rows, left : left + columns] = self.interpretation.table()[occupancy.astype(np.uint8)]
        self._news = True
        return True

    def match(self, grid: Grid, default: int) -> None:
        """Make the next update write all cells."""
        self._news = True

    def reset(self) -> None:
        """Make the next update write all cells; the map is kept."""
        self._news = True

    def is_current(self, time_ns: int) -> bool:
        """Return whether a map exists, and its pose is known or will be queried by the next update."""
        return self.map is not None and (self._placed is not None or self._news)

    def changed(self, window: Window, moment: UpdateContext, grid: Grid) -> Window:
        """Return the window that must be rewritten: the whole grid after a new map or transform."""
        if self.map is None:
            return window
        pose = self._pose()
        if pose != self._placed:
            self._placed, self._news = pose, True
        if self._footprint_clearing:
            window = window.joined(footprint_window(moment, grid))
        if not self._news:
            return window
        self._news = False
        return Window.of(grid)

    def write(self, grid: Grid, window: Window, moment: UpdateContext) -> None:
        """Write the map's costs into the window."""
        if self.map is None or self._placed is None:
            return
        part = grid.cells[window.cells]
        inside, costs = self._aligned_cells(grid, window) or self._sampled_cells(grid, window)
        part[inside] = np.maximum(part[inside], costs) if self._use_maximum else costs
        if self._footprint_clearing:
            free_footprint(grid.cells, moment, grid, window)

    def _aligned_cells(self, grid: Grid, window: Window) -> tuple[tuple[slice, slice], Costs] | None:
        """Return the index of the window's cells that the map covers, and the costs of these cells.

        Returns None if the grids are not aligned.
        """
        known = self.map
        assert known is not None
        if self._placed != _SAME_PLACE or known.yaw or known.resolution != grid.resolution:
            return None
        down, right = (grid.y - known.y) / grid.resolution, (grid.x - known.x) / grid.resolution
        rows, columns = round(down), round(right)
        if abs(down - rows) + abs(right - columns) > _ROUNDING:
            return None
        seen = Window(window.top + rows, window.left + columns, window.bottom + rows, window.right + columns).within(
            known
        )
        top, left = seen.top - rows - window.top, seen.left - columns - window.left
        if seen.is_empty:
            return (slice(0, 0), slice(0, 0)), known.cells[seen.cells]
        there = slice(top, top + seen.bottom - seen.top), slice(left, left + seen.right - seen.left)
        return there, known.cells[seen.cells]

    def _sampled_cells(self, grid: Grid, window: Window) -> tuple[NDArray[np.bool_], Costs]:
        """Return a mask of the window's cells that the map covers, and the costs of these cells.

        The map is sampled at the cell centres, for grids that are not aligned.
        """
        assert self.map is not None
        assert self._placed is not None
        rows, columns = np.mgrid[window.top : window.bottom, window.left : window.right]
        centres = grid.centres_of(np.stack((rows, columns), axis=-1))
        x, y, yaw = self._placed
        cosine, sine = np.cos(yaw), np.sin(yaw)
        indices = self.map.cells_of(centres @ np.array([[cosine, sine], [-sine, cosine]]) + (x, y))
        inside = self.map.has(indices)
        indices = indices[inside]
        return inside, self.map.cells[indices[:, 0], indices[:, 1]]
