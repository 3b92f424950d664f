"""Sensor observations for obstacle layers, buffered as points in the frame of the costmap.

Source: nav2_costmap_2d ``ObservationBuffer``.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND


@dataclass(frozen=True, kw_only=True)
class Source:
    """Settings of a sensor, with lengths in meters and times in seconds.

    Attributes:
        marking: whether the sensor's points mark obstacles.
        clearing: whether the space between the sensor and its points is cleared.
        obstacle_max_range: points farther away do not mark obstacles.
        obstacle_min_range: points closer than this do not mark obstacles.
        raytrace_max_range: cells farther away are not cleared.
        raytrace_min_range: cells closer than this are not cleared.
        min_obstacle_height: points below this height are dropped.
        max_obstacle_height: points above this height are dropped.
        observation_persistence: how long observations stay valid; 0 to keep only the latest observation.
        expected_update_rate: the longest time between observations for the costmap to be current; 0 for no limit.
    """

    marking: bool = True
    clearing: bool = False
    obstacle_max_range: float = 2.5
    obstacle_min_range: float = 0.0
    raytrace_max_range: float = 3.0
    raytrace_min_range: float = 0.0
    min_obstacle_height: float = 0.0
    max_obstacle_height: float = 0.0
    observation_persistence: float = 0.0
    expected_update_rate: float = 0.0


@dataclass(frozen=True, eq=False, slots=True)
class Observation:
    """A set of points observed at the same time.

    Attributes:
        origin: x, y and z of the sensor in the frame of the costmap, in meters.
        points: the points, of shape (n, 3), in the same frame.
        source: the settings of the sensor.
        time_ns: the time of the observation.
    """

    origin: NDArray[np.float64]
    points: NDArray[np.float64]
    source: Source
    time_ns: int

    def select_obstacles(self) -> NDArray[np.float64]:
        """Return the points within the range for marking, of shape (n, 3)."""
        squared_distances = ((self.points - self.origin) ** 2).sum(axis=1)
        is_in_range = (squared_distances < self.source.obstacle_max_range**2) & (
            squared_distances >= self.source.obstacle_min_range**2
        )
        points_in_range: NDArray[np.float64] = self.points[is_in_range]
        return points_in_range


class ObservationBuffer:
    """The recent observations of one sensor."""

    def __init__(self, source: Source) -> None:
        self.source = source
        self._observations: deque[Observation] = deque()
        self._updated_ns: int | None = None

    def add(self, origin: NDArray[np.float64], points: NDArray[np.float64], time_ns: int) -> None:
        """Add an observation.

        Points that are not finite or outside the height limits are dropped.
        """
        heights = points[:, 2]
        is_valid = np.isfinite(points).all(axis=1)
        is_valid &= (heights >= self.source.min_obstacle_height) & (heights <= self.source.max_obstacle_height)
        if not self.source.observation_persistence:
            self._observations.clear()
        self._observations.append(Observation(origin, points[is_valid], self.source, time_ns))
        self._updated_ns = time_ns

    def select_valid(self, time_ns: int) -> list[Observation]:
        """Drop the observations that have expired at a time, and return the others."""
        if self.source.observation_persistence:
            oldest_ns = time_ns - round(self.source.observation_persistence * NANOSECONDS_PER_SECOND)
            while self._observations and self._observations[0].time_ns < oldest_ns:
                self._observations.popleft()
        return list(self._observations)

    def is_current(self, time_ns: int) -> bool:
        """Return whether the latest observation is recent enough.

        Without an expected update rate, the result is always True.
        """
        if not self.source.expected_update_rate:
            return True
        return (
            self._updated_ns is not None
            and (time_ns - self._updated_ns) / NANOSECONDS_PER_SECOND <= self.source.expected_update_rate
        )
