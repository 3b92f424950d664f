"""The inflation layer, which writes costs that decay with the distance from obstacles.

Source: nav2_costmap_2d ``InflationLayer``. A cell costs `INSCRIBED` up to the inscribed radius, then
``252 exp(-cost_scaling_factor (distance - inscribed radius))``, and nothing beyond the inflation radius.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.costmaps.costmap import FREE, INSCRIBED, LETHAL, MAX_PASSABLE, UNKNOWN
from linkwright.navigation.costmaps.layer import Costs, Layer, UpdateContext, Window
from linkwright.navigation.grids.distances import distance_field
from linkwright.navigation.grids.grid import Grid


@dataclass(frozen=True, kw_only=True)
class Inflation:
    """The parameters of the decay of costs with the distance from obstacles.

    Attributes:
        inflation_radius: the distance up to which cells have a cost, in metres.
        cost_scaling_factor: the rate of the decay, per metre.
        inflate_unknown: whether any cost is written into unknown cells; otherwise only costs at which the robot would
            touch an obstacle are.
        inflate_around_unknown: whether unknown cells are inflated like obstacles.
    """

    inflation_radius: float = 0.55
    cost_scaling_factor: float = 10.0
    inflate_unknown: bool = False
    inflate_around_unknown: bool = False

    def costs(self, distances: NDArray[np.float64], inscribed_radius: float) -> Costs:
        """Return the costs at distances (in metres) from the nearest obstacle, in an array of the same shape."""
        beyond = np.maximum(distances - inscribed_radius, 0.0)
        fading = (MAX_PASSABLE * np.exp(-self.cost_scaling_factor * beyond)).astype(np.uint8)
        fading = np.where(distances <= inscribed_radius, INSCRIBED, fading).astype(np.uint8)
        costs: Costs = np.where(distances > 0.0, fading, LETHAL).astype(np.uint8)
        return costs


class InflationLayer(Layer):
    """A layer that writes costs around the lethal cells of the layers below."""

    def __init__(self, inflation: Inflation) -> None:
        self._inflation = inflation
        self._inscribed_radius: float | None = None

    @property
    def inflation(self) -> Inflation:
        """The parameters of the decay of costs."""
        return self._inflation

    @inflation.setter
    def inflation(self, inflation: Inflation) -> None:
        self._inflation, self._inscribed_radius = inflation, None

    def changed(self, window: Window, moment: UpdateContext, grid: Grid) -> Window:
        """Return the window changed by the layers below, padded by the inflation radius.

        After a change of the inscribed radius or of the parameters, the window is the whole grid.
        """
        if self._inscribed_radius != moment.inscribed_radius:
            self._inscribed_radius = moment.inscribed_radius
            return Window.of(grid)
        return window.padded(self._reach(grid), grid)

    def write(self, grid: Grid, window: Window, moment: UpdateContext) -> None:
        """Write the costs caused by obstacles inside and around the window into the window."""
        reach = self._reach(grid)
        if not reach:
            return
        around = window.padded(reach, grid)
        below = grid.cells[around.cells]
        sources = below == LETHAL
        if self._inflation.inflate_around_unknown:
            sources |= below == UNKNOWN
        if not sources.any():
            return
        all_distances = distance_field(sources, grid.resolution)
        top, left = window.top - around.top, window.left - around.left
        distances = all_distances[top : top + window.bottom - window.top, left : left + window.right - window.left]
        costs = self._inflation.costs(distances, moment.inscribed_radius)
        costs[distances > reach * grid.resolution] = FREE
        cells = grid.cells[window.cells]
        unknown = cells == UNKNOWN
        least = FREE + 1 if self._inflation.inflate_unknown else INSCRIBED
        np.maximum(cells, costs, out=cells)
        inflated = unknown & (costs >= least)
        cells[inflated] = costs[inflated]

    def _reach(self, grid: Grid) -> int:
        return max(0, ceil(self._inflation.inflation_radius / grid.resolution))
