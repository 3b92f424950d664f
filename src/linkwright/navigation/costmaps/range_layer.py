"""A costmap layer that estimates occupancy from sensors with a wide cone, such as sonars.

Source: nav2_costmap_2d ``RangeSensorLayer``. Unlike in nav2, only cells within the field of view change.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from math import ceil
from typing import Final

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.costmaps.costmap import FREE, LETHAL, UNKNOWN
from linkwright.navigation.costmaps.layer import PersistentLayer, UpdateContext, Window
from linkwright.navigation.grids.grid import Grid
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_MAX_PROBABILITY: Final = 254.0
_UNKNOWN_PROBABILITY: Final = 127
"""The probability of an unknown cell, from 0 to 254."""
_HIT_PROBABILITY: Final = 233
"""The probability of the cell in which a reading ends, from 0 to 254."""
_MIN_PRIOR: Final = 0.02
"""Prior probabilities are clipped to this distance from 0 and 1, so that later readings can still change them."""
_UPDATE_FACTOR: Final = 1.2
"""The maximum distance of updated cells, as a multiple of the measured distance."""


@dataclass(frozen=True, kw_only=True)
class RangeSettings:
    """Settings of the sensor model, with nav2's names and defaults.

    Attributes:
        phi: the distance beyond which readings are uncertain, in meters.
        clear_threshold: cells with a lower probability of being occupied are free.
        mark_threshold: cells with a higher probability of being occupied are obstacles.
        clear_on_max_reading: whether a reading of the maximum range clears the cone.
        no_readings_timeout: the longest time without readings for the costmap to be current, in seconds; 0 for no
            limit.
    """

    phi: float = 1.2
    clear_threshold: float = 0.2
    mark_threshold: float = 0.8
    clear_on_max_reading: bool = False
    no_readings_timeout: float = 0.0


@dataclass(frozen=True, slots=True)
class RangeReading:
    """A reading of a range sensor.

    Attributes:
        x, y: the position of the sensor in the frame of the costmap, in meters.
        yaw: the direction of the sensor, in radians.
        distance: the measured distance, in meters.
        field_of_view: the full angle of the cone, in radians.
        is_free: whether the sensor found no obstacle up to the distance.
        time_ns: the time of the reading.
    """

    x: float
    y: float
    yaw: float
    distance: float
    field_of_view: float
    is_free: bool
    time_ns: int


class RangeLayer(PersistentLayer):
    """A layer of occupancy probabilities that readings update.

    The cells of `layer_grid` range from 0 (certainly free) to 254 (certainly occupied).
    """

    def __init__(self, settings: RangeSettings) -> None:
        super().__init__()
        self.settings = settings
        self._readings: deque[RangeReading] = deque()
        self._latest_reading_ns: int | None = None

    def add(self, reading: RangeReading) -> None:
        """Queue a reading for the next update."""
        self._readings.append(reading)
        self._latest_reading_ns = reading.time_ns

    def match_grid(self, grid: Grid, default: int) -> None:
        """Move the probabilities to the new grid.

        Cells outside the old grid get the probability of an unknown cell.
        """
        super().match_grid(grid, _UNKNOWN_PROBABILITY)

    def clear(self, window: Window, *, clear_outside: bool) -> None:
        """Set the cells in a window, or all cells outside it, to the probability of unknown cells."""
        super().clear(window, clear_outside=clear_outside)
        self.layer_grid.cells[self.layer_grid.cells == UNKNOWN] = _UNKNOWN_PROBABILITY

    def is_current(self, time_ns: int) -> bool:
        """Return whether the latest reading is recent enough.

        Without a timeout, the result is always True.
        """
        timeout = self.settings.no_readings_timeout
        return not timeout or (
            self._latest_reading_ns is not None
            and (time_ns - self._latest_reading_ns) / NANOSECONDS_PER_SECOND <= timeout
        )

    def update_window(self, window: Window, context: UpdateContext, grid: Grid) -> Window:
        """Apply the queued readings, and return the window that must be rewritten."""
        window = window.union(self.pop_extra_window())
        while self._readings:
            window = window.union(self._apply_reading(self._readings.popleft(), grid))
        return window

    def write_costs(self, grid: Grid, window: Window, context: UpdateContext) -> None:
        """Mark cells above the upper threshold, and free unknown cells below the lower threshold."""
        probabilities, lower_costs = self.layer_grid.cells[window.cells], grid.cells[window.cells]
        lower_costs[(probabilities < self.settings.clear_threshold * _MAX_PROBABILITY) & (lower_costs == UNKNOWN)] = (
            FREE
        )
        lower_costs[probabilities > self.settings.mark_threshold * _MAX_PROBABILITY] = LETHAL

    def _apply_reading(self, reading: RangeReading, grid: Grid) -> Window:
        """Update the probabilities by Bayes' rule, and return the window that changed."""
        reach_in_cells = ceil(_UPDATE_FACTOR * reading.distance / grid.resolution) + 1
        row, column = grid.cells_of(np.array((reading.x, reading.y))).tolist()
        window = Window(
            row - reach_in_cells, column - reach_in_cells, row + reach_in_cells + 1, column + reach_in_cells + 1
        ).clipped_to(grid)
        rows, columns = np.mgrid[window.top : window.bottom, window.left : window.right]
        centers = grid.centers_of(np.stack((rows, columns), axis=-1))
        x, y = centers[..., 0] - reading.x, centers[..., 1] - reading.y
        angles = np.abs((np.arctan2(y, x) - reading.yaw + np.pi) % (2.0 * np.pi) - np.pi)
        half_angle = max(reading.field_of_view / 2.0, np.finfo(float).tiny)
        distances = np.hypot(x, y)
        if not reading.is_free:
            hit_position = (
                reading.x + reading.distance * np.cos(reading.yaw),
                reading.y + reading.distance * np.sin(reading.yaw),
            )
            hit_cell = grid.cells_of(np.array(hit_position))
            if grid.contains(hit_cell):
                self.layer_grid.cells[hit_cell[0], hit_cell[1]] = _HIT_PROBABILITY
        likelihood = self._likelihood(distances, angles / half_angle, reading, grid.resolution)
        previous = self.layer_grid.cells[window.cells]
        prior = np.clip(previous / _MAX_PROBABILITY, _MIN_PRIOR, 1.0 - _MIN_PRIOR)
        occupied_weight, free_weight = likelihood * prior, (1.0 - likelihood) * (1.0 - prior)
        posterior = np.round(_MAX_PROBABILITY * occupied_weight / (occupied_weight + free_weight))
        self.layer_grid.cells[window.cells] = np.where(angles <= half_angle, posterior, previous)
        return window

    def _likelihood(
        self,
        distance: NDArray[np.float64],
        angular_offset: NDArray[np.float64],
        reading: RangeReading,
        resolution: float,
    ) -> NDArray[np.float64]:
        """Return the probability that a cell is occupied according to this reading alone.

        Args:
            distance: the distance of cells from the sensor, in meters.
            angular_offset: the angular offset of cells from the sensor's axis, scaled to 1 at the edge of the cone.
            reading: the measurement.
            resolution: the side of a cell, in meters.
        """
        if reading.is_free:
            return np.where(distance <= reading.distance, 0.0, 0.5)
        weight = (1.0 - np.tanh(2.0 * (distance - self.settings.phi))) / 2.0 * np.maximum(1.0 - angular_offset**2, 0.0)
        blur = max(resolution * reading.distance, np.finfo(float).tiny)
        distance_before_hit = reading.distance - distance
        rising_part = weight * 0.5 * ((2.0 * blur - distance_before_hit) / blur) ** 2 + (1.0 - weight) * 0.5
        peak = weight * (0.5 - 0.5 * (distance_before_hit / blur) ** 2) + 0.5
        probability = np.where(distance_before_hit > 2.0 * blur, (1.0 - weight) * 0.5, rising_part)
        probability = np.where(distance_before_hit > blur, probability, peak)
        likelihood: NDArray[np.float64] = np.where(distance_before_hit > -blur, probability, 0.5)
        return likelihood
