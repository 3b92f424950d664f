"""The denoise layer, which removes obstacles of too few cells.

Source: nav2_costmap_2d ``DenoiseLayer``.
"""

from __future__ import annotations

import numpy as np

from linkwright.navigation.costmaps.costmap import FREE, LETHAL
from linkwright.navigation.costmaps.layer import Layer, UpdateContext, Window
from linkwright.navigation.grids.grid import Grid
from linkwright.navigation.grids.library import load_scipy

_ALL_NEIGHBOURS = 8


class DenoiseLayer(Layer):
    """A layer that frees groups of lethal cells that are too small.

    Args:
        minimal_group_size: the minimum number of cells of a group that is kept.
        group_connectivity_type: 8 if cells that touch only at a corner are connected, else 4.
    """

    def __init__(self, minimal_group_size: int = 2, group_connectivity_type: int = _ALL_NEIGHBOURS) -> None:
        self._least = minimal_group_size
        self._together = np.ones((3, 3), np.bool_)
        if group_connectivity_type != _ALL_NEIGHBOURS:
            self._together[[0, 0, 2, 2], [0, 2, 0, 2]] = False

    def changed(self, window: Window, moment: UpdateContext, grid: Grid) -> Window:
        """Return the window changed by the layers below, padded by the minimum group size."""
        return window.padded(self._least, grid)

    def write(self, grid: Grid, window: Window, moment: UpdateContext) -> None:
        """Free small groups of lethal cells.

        Cells around the window are counted too, so that a group that crosses the edge is not taken for a small one.
        """
        if self._least <= 1:
            return
        around = window.padded(self._least, grid)
        groups, _ = load_scipy("ndimage").label(grid.cells[around.cells] == LETHAL, self._together)
        sizes = np.bincount(groups.ravel())
        small = (sizes < self._least)[groups] & (groups > 0)
        inner = small[
            window.top - around.top : window.bottom - around.top, window.left - around.left : window.right - around.left
        ]
        grid.cells[window.cells][inner] = FREE
