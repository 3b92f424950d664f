"""Lidars whose rays follow a recorded pattern that does not repeat from scan to scan, such as those of Livox."""

from __future__ import annotations

from functools import cached_property
from pathlib import Path

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.sdf.sensors import Lidar
from linkwright.simulation.sensors.lidar import LidarSensor
from linkwright.simulation.sensors.mount import Mount


class PatternLidarSensor(LidarSensor):
    """A lidar that measures along consecutive directions of a pattern, and starts over at its end.

    Args:
        mount: the mount of the sensor.
        lidar: the range and the noise of the lidar.
        pattern: the directions in the lidar's frame, shape (n, 3).
        samples: the number of directions that a scan advances.
        downsample: the number of directions for each ray.
        generator: the source of the noise.
    """

    def __init__(
        self,
        mount: Mount,
        lidar: Lidar,
        pattern: Array,
        *,
        samples: int,
        downsample: int,
        generator: np.random.Generator,
    ) -> None:
        super().__init__(mount, lidar, sees_visuals=False, generator=generator)
        self._pattern = pattern
        self._samples = samples
        self._offsets = np.arange(0, samples, downsample)
        self._start = 0

    @property
    def shape(self) -> tuple[int, int]:
        """One row with all rays of a scan."""
        return 1, len(self._offsets)

    @cached_property
    def directions(self) -> Array:
        """The unit vectors of the rays of the current scan in the lidar's frame, shape (rays, 3)."""
        rays: Array = self._pattern[(self._start + self._offsets) % len(self._pattern)]
        return rays

    def advance(self) -> None:
        """Continue with the directions of the next scan."""
        self._start = (self._start + self._samples) % len(self._pattern)
        del self.directions


def read_pattern(path: Path) -> Array:
    """Return the directions in a CSV file, as unit vectors, shape (n, 3).

    Each line has a time, an azimuth and a zenith angle in degrees; lines without three numbers are skipped.

    Raises:
        OSError: the file cannot be read.
        ValueError: no line has three numbers.
    """
    rows = []
    for line in path.read_text(encoding="utf-8", errors="replace").splitlines():
        try:
            _, azimuth, zenith = (float(word) for word in line.split(","))
        except ValueError:
            continue
        rows.append((azimuth, zenith))
    if not rows:
        raise ValueError
    azimuth, zenith = np.radians(np.array(rows)).T
    return np.column_stack((np.sin(zenith) * np.cos(azimuth), np.sin(zenith) * np.sin(azimuth), np.cos(zenith)))
