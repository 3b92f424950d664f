"""A costmap layer that removes obstacles of too few cells.

Source: nav2_costmap_2d ``DenoiseLayer``.
"""

from __future__ import annotations

import numpy as np

from linkwright.navigation.costmaps.costmap import FREE, LETHAL
from linkwright.navigation.costmaps.layer import Layer, UpdateContext, Window
from linkwright.navigation.grids.grid import Grid
from linkwright.navigation.grids.library import load_scipy

_ALL_NEIGHBORS = 8


class DenoiseLayer(Layer):
    """A layer that frees small groups of lethal cells.

    Args:
        minimal_group_size: the minimum number of cells of a group that is kept.
        group_connectivity_type: 8 if cells that touch only at a corner are connected, and 4 otherwise.
    """

    def __init__(self, minimal_group_size: int = 2, group_connectivity_type: int = _ALL_NEIGHBORS) -> None:
        self._min_group_size = minimal_group_size
        self._connectivity = np.ones((3, 3), np.bool_)
        if group_connectivity_type != _ALL_NEIGHBORS:
            self._connectivity[[0, 0, 2, 2], [0, 2, 0, 2]] = False

    def update_window(self, window: Window, context: UpdateContext, grid: Grid) -> Window:
        """Return the window changed by the layers below, padded by the minimum group size."""
        return window.padded(self._min_group_size, grid)

    def write_costs(self, grid: Grid, window: Window, context: UpdateContext) -> None:
        """Free small groups of lethal cells.

        Cells around the window are counted too, so that a group that crosses the edge has its full size.
        """
        if self._min_group_size <= 1:
            return
        padded_window = window.padded(self._min_group_size, grid)
        groups, _ = load_scipy("ndimage").label(grid.cells[padded_window.cells] == LETHAL, self._connectivity)
        sizes = np.bincount(groups.ravel())
        in_small_group = (sizes < self._min_group_size)[groups] & (groups > 0)
        in_window = in_small_group[
            window.top - padded_window.top : window.bottom - padded_window.top,
            window.left - padded_window.left : window.right - padded_window.left,
        ]
        grid.cells[window.cells][in_window] = FREE
