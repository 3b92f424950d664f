"""A costmap layer whose costs decay with the distance from obstacles.

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
        inflation_radius: the distance up to which cells have a cost, in meters.
        cost_scaling_factor: the rate of the decay, per meter.
        inflate_unknown: whether unknown cells get every cost above 0; otherwise they get only the costs at which the
            robot would touch an obstacle.
        inflate_around_unknown: whether unknown cells are inflated like obstacles.
    """

    inflation_radius: float = 0.55
    cost_scaling_factor: float = 10.0
    inflate_unknown: bool = False
    inflate_around_unknown: bool = False

    def compute_costs(self, distances: NDArray[np.float64], inscribed_radius: float) -> Costs:
        """Return the costs at distances, in meters, from the nearest obstacle.

        The costs have the shape of `distances`.
        """
        excess_distances = np.maximum(distances - inscribed_radius, 0.0)
        decayed_costs = (MAX_PASSABLE * np.exp(-self.cost_scaling_factor * excess_distances)).astype(np.uint8)
        decayed_costs = np.where(distances <= inscribed_radius, INSCRIBED, decayed_costs).astype(np.uint8)
        costs: Costs = np.where(distances > 0.0, decayed_costs, LETHAL).astype(np.uint8)
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

    def update_window(self, window: Window, context: UpdateContext, grid: Grid) -> Window:
        """Return the window changed by the layers below, padded by the inflation radius.

        After a change of the inscribed radius or of the parameters, the window is the whole grid.
        """
        if self._inscribed_radius != context.inscribed_radius:
            self._inscribed_radius = context.inscribed_radius
            return Window.of(grid)
        return window.padded(self._radius_in_cells(grid), grid)

    def write_costs(self, grid: Grid, window: Window, context: UpdateContext) -> None:
        """Write the costs caused by obstacles inside and around the window into the window."""
        radius_in_cells = self._radius_in_cells(grid)
        if not radius_in_cells:
            return
        padded_window = window.padded(radius_in_cells, grid)
        lower_costs = grid.cells[padded_window.cells]
        is_source = lower_costs == LETHAL
        if self._inflation.inflate_around_unknown:
            is_source |= lower_costs == UNKNOWN
        if not is_source.any():
            return
        all_distances = distance_field(is_source, grid.resolution)
        top, left = window.top - padded_window.top, window.left - padded_window.left
        distances = all_distances[top : top + window.bottom - window.top, left : left + window.right - window.left]
        costs = self._inflation.compute_costs(distances, context.inscribed_radius)
        costs[distances > radius_in_cells * grid.resolution] = FREE
        cells = grid.cells[window.cells]
        is_unknown = cells == UNKNOWN
        min_cost = FREE + 1 if self._inflation.inflate_unknown else INSCRIBED
        np.maximum(cells, costs, out=cells)
        is_inflated = is_unknown & (costs >= min_cost)
        cells[is_inflated] = costs[is_inflated]

    def _radius_in_cells(self, grid: Grid) -> int:
        return max(0, ceil(self._inflation.inflation_radius / grid.resolution))
