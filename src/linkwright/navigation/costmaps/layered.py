"""A costmap of several layers that is either fixed or moves with the robot.

Source: nav2_costmap_2d ``LayeredCostmap``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from linkwright.navigation.costmaps.costmap import FREE, UNKNOWN, Costmap
from linkwright.navigation.costmaps.footprints import Footprint, compute_radii, pad_footprint, place_footprint
from linkwright.navigation.costmaps.layer import Layer, UpdateContext, Window
from linkwright.navigation.grids.grid import Grid

Pose = tuple[float, float, float]
"""x, y (meters) and yaw (radians) in the frame of a costmap."""


class LayeredCostmap:
    """A costmap computed from layers.

    Args:
        grid: the size, origin and resolution; its cells are not used.
        layers: the layers from bottom to top.
        footprint: the footprint of the robot without padding; see `Footprint`.
        is_rolling: whether the costmap moves to keep the robot in its middle.
        track_unknown: whether cells without data are unknown; otherwise they are free.
        footprint_padding: the padding of the footprint, in meters.
        filters: the layers that change the costs after all others; the others do not see these changes.

    Attributes:
        costmap: the costs after the last update.
        layers: the layers from bottom to top.
        filters: the layers that change the costs after all others.
        padding: the padding that is applied when the footprint is next set, in meters.
        changed_window: the window that the last update wrote.
    """

    def __init__(
        self,
        grid: Grid,
        layers: Sequence[Layer],
        footprint: Footprint,
        *,
        is_rolling: bool = False,
        track_unknown: bool = False,
        footprint_padding: float = 0.0,
        filters: Sequence[Layer] = (),
    ) -> None:
        self.layers = list(layers)
        self.filters = list(filters)
        self._last_filters: list[Layer] = []
        self.is_rolling = is_rolling
        self._default = UNKNOWN if track_unknown else FREE
        self.padding = footprint_padding
        self.changed_window = Window()
        self._is_updated = False
        self.footprint = footprint
        self.resize(grid)

    @property
    def footprint(self) -> Footprint:
        """The padded footprint, in the frame of the robot.

        The setter expects a footprint without padding, and adds the padding.
        """
        return self._footprint

    @footprint.setter
    def footprint(self, unpadded: Footprint) -> None:
        self._footprint = pad_footprint(unpadded, self.padding)
        self.inscribed_radius, self.circumscribed_radius = compute_radii(self._footprint)

    def resize(self, grid: Grid) -> None:
        """Change the size, origin or resolution.

        If the resolution stays the same, layers keep the cells that both grids contain.
        """
        cells = np.full((grid.rows, grid.columns), self._default, np.uint8)
        self.costmap = Costmap(Grid(cells=cells, resolution=grid.resolution, x=grid.x, y=grid.y))
        self._unfiltered = replace(self.costmap.grid, cells=cells.copy()) if self.filters else self.costmap.grid
        for layer in (*self.layers, *self.filters):
            layer.match_grid(self.costmap.grid, self._default)
        self._is_updated = False

    def update(self, pose: Pose, time_ns: int) -> bool:
        """Update the costs from the enabled layers.

        Args:
            pose: the pose of the robot.
            time_ns: the time of the update.

        Returns:
            Whether any cell was written; `changed_window` is the written window.
        """
        x, y, yaw = pose
        if self.is_rolling:
            self._center_on(x, y)
        grid = self.costmap.grid
        footprint = place_footprint(self._footprint, x, y, yaw)
        context = UpdateContext(x, y, footprint, self.inscribed_radius, time_ns)
        enabled_layers = [layer for layer in self.layers if layer.enabled]
        enabled_filters = [layer for layer in self.filters if layer.enabled]
        is_whole = not self._is_updated or self.is_rolling or enabled_filters != self._last_filters
        self._last_filters = enabled_filters
        window = Window.of(grid) if is_whole else Window()
        for layer in (*enabled_layers, *enabled_filters):
            window = layer.update_window(window, context, grid)
        self.changed_window = window
        self._is_updated = True
        if window.is_empty:
            return False
        unfiltered = self._unfiltered
        unfiltered.cells[window.cells] = self._default
        for layer in enabled_layers:
            layer.write_costs(unfiltered, window, context)
        if unfiltered is not grid:
            grid.cells[window.cells] = unfiltered.cells[window.cells]
        for layer in enabled_filters:
            layer.write_costs(grid, window, context)
        return True

    def invalidate(self) -> None:
        """Make the next update write all cells."""
        self._is_updated = False

    def is_current(self, time_ns: int) -> bool:
        """Return whether the costmap was updated, with recent data in all enabled layers."""
        return self._is_updated and all(layer.is_current(time_ns) for layer in self.layers if layer.enabled)

    def clear_entirely(self) -> None:
        """Reset all layers and all cells."""
        self.costmap.grid.cells[:] = self._unfiltered.cells[:] = self._default
        for layer in (*self.layers, *self.filters):
            layer.reset()
        self._is_updated = False

    def clear_around(self, pose: Pose, distance: float, *, clear_outside: bool = False) -> None:
        """Clear the clearable layers in a square, or everywhere outside the square.

        Args:
            pose: the center of the square.
            distance: the side of the square, in meters.
            clear_outside: whether to keep the square and clear the rest.
        """
        corners = np.array([[pose[0], pose[1]]]) + distance / 2.0 * np.array([[-1.0, -1.0], [1.0, 1.0]])
        window = Window.around(self.costmap.grid.cells_of(corners), self.costmap.grid)
        for layer in self.layers:
            if layer.is_clearable:
                layer.clear(window, clear_outside=clear_outside)
        self._is_updated = False

    def _center_on(self, x: float, y: float) -> None:
        """Move the grid by an integer number of cells so that a position is in its middle."""
        grid = self.costmap.grid
        columns = int((x - grid.columns * grid.resolution / 2.0 - grid.x) / grid.resolution)
        rows = int((y - grid.rows * grid.resolution / 2.0 - grid.y) / grid.resolution)
        if rows or columns:
            self.resize(
                Grid(
                    cells=grid.cells,
                    resolution=grid.resolution,
                    x=grid.x + columns * grid.resolution,
                    y=grid.y + rows * grid.resolution,
                )
            )
