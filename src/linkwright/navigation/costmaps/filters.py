"""Costmap filters, which apply a mask of the user after all layers: keepout zones and speed limits.

Source: nav2_costmap_2d ``KeepoutFilter``, ``SpeedFilter``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from linkwright.navigation.costmaps.costmap import LETHAL, UNKNOWN
from linkwright.navigation.costmaps.layer import Costs, Layer, UpdateContext, Window
from linkwright.navigation.costmaps.static_layer import Interpretation, MapPose, StaticLayer
from linkwright.navigation.grids.grid import Grid

NO_LIMIT = 0.0
"""The speed limit that means no limit."""
_UNKNOWN_VALUE = -1
_MAX_PERCENTAGE = 100.0


class _MaskInterpretation(Interpretation):
    """The conversion of a mask, whose values are proportional to costs."""

    def cost_table(self) -> Costs:
        costs = np.floor(np.clip(np.arange(256), 0, 100) * LETHAL / 100 + 0.5).astype(np.uint8)
        costs[_UNKNOWN_VALUE] = UNKNOWN
        table: Costs = costs
        return table


class KeepoutFilter(StaticLayer):
    """A filter that raises costs to those of a mask; unknown cells of the mask have no effect.

    Args:
        pose: returns the pose of the costmap's frame in the mask's frame, or None while it is unknown.
    """

    def __init__(self, pose: Callable[[], MapPose | None]) -> None:
        super().__init__(_MaskInterpretation(), pose=pose)

    def is_current(self, time_ns: int) -> bool:
        """Return True: the costmap does not wait for a mask."""
        return True

    def _merge(self, cells: Costs, costs: Costs) -> Costs:
        merged: Costs = np.where((costs != UNKNOWN) & ((costs > cells) | (cells == UNKNOWN)), costs, cells)
        return merged


@dataclass(frozen=True)
class SpeedScale:
    """The conversion of a mask's values to speed limits: ``base + multiplier * value``.

    Attributes:
        base: the limit for the value 0, which itself means no limit.
        multiplier: the limit for one unit of the mask.
        is_percentage: whether limits are in percent of the maximum speed; otherwise in m/s.
    """

    base: float
    multiplier: float
    is_percentage: bool

    def limit(self, value: int) -> float:
        """Return the limit for a value of the mask; a limit that is out of range means no limit."""
        if not value:
            return NO_LIMIT
        limit = self.base + self.multiplier * value
        is_valid = limit >= 0.0 and not (self.is_percentage and limit > _MAX_PERCENTAGE)
        return limit if is_valid else NO_LIMIT


class SpeedFilter(Layer):
    """A filter that publishes the speed limit at the robot's position, and leaves the costs unchanged.

    Args:
        pose: returns the pose of the costmap's frame in the mask's frame, or None while it is unknown.
        publish: publishes a new limit, and whether it is a percentage.

    Attributes:
        scale: the conversion of the mask's values; None before it is known.
        mask: the mask; None before the first one. Its cells are of type int8.
    """

    def __init__(self, pose: Callable[[], MapPose | None], publish: Callable[[float, bool], None]) -> None:
        self.scale: SpeedScale | None = None
        self.mask: Grid | None = None
        self._pose, self._publish = pose, publish
        self._limit = NO_LIMIT

    def update_window(self, window: Window, context: UpdateContext, grid: Grid) -> Window:
        """Publish the limit at the robot's position if it changed, and return the window."""
        value = self._value_at(context.x, context.y)
        if value is not None and value != _UNKNOWN_VALUE and self.scale is not None:
            limit = self.scale.limit(value)
            if limit != self._limit:
                self._limit = limit
                self._publish(limit, self.scale.is_percentage)
        return window

    def write_costs(self, grid: Grid, window: Window, context: UpdateContext) -> None:
        """Leave the costs unchanged."""

    def _value_at(self, x: float, y: float) -> int | None:
        """Return the mask's value at a position in the frame of the costmap, or None outside the mask."""
        pose = None if self.mask is None else self._pose()
        if self.mask is None or pose is None:
            return None
        cosine, sine = np.cos(pose[2]), np.sin(pose[2])
        point = np.array([[pose[0] + cosine * x - sine * y, pose[1] + sine * x + cosine * y]])
        index = self.mask.cells_of(point)
        return int(self.mask.cells[tuple(index[0])]) if self.mask.contains(index)[0] else None
