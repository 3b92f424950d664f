"""The points of a sensor_msgs/msg/LaserScan, as laser_geometry projects them."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.viewer.clouds.points import Points


class ScanProjector:
    """Projects scans; the directions of the rays are kept as long as scans of the same shape come."""

    def __init__(self) -> None:
        self._shape: tuple[float, float, int] = (0.0, 0.0, 0)
        self._directions: NDArray[np.float32] = np.empty((0, 2), np.float32)

    def points(self, scan: Any) -> Points:
        """The points of the rays that hit something, in the frame of the scanner.

        A ray counts whose range is at least `range_min` and less than `range_max`; rays without an echo are infinite or
        NaN. The channels are ``intensity`` (where the scan has one for each ray), ``range`` and ``index``.
        """
        ranges = np.frombuffer(scan.ranges, np.float32)
        with np.errstate(invalid="ignore"):
            hits = np.flatnonzero((ranges >= scan.range_min) & (ranges < scan.range_max))
        distances = ranges[hits]
        positions = np.zeros((len(hits), 3), np.float32)
        directions = self._rays(scan.angle_min, scan.angle_increment, len(ranges))
        np.multiply(directions[hits], distances[:, np.newaxis], out=positions[:, :2])
        channels: dict[str, NDArray[Any]] = {}
        intensities = np.frombuffer(scan.intensities, np.float32)
        if len(intensities) == len(ranges):
            channels["intensity"] = intensities[hits]
        channels["range"] = distances
        channels["index"] = hits.astype(np.int32)
        finite = np.isfinite(positions.sum())
        if finite:
            return Points(positions, channels)
        valid = np.isfinite(positions).all(axis=1)
        return Points(positions[valid], {name: values[valid] for name, values in channels.items()})

    def _rays(self, first: float, step: float, count: int) -> NDArray[np.float32]:
        """Cosine and sine of each ray's angle."""
        shape = (first, step, count)
        if shape != self._shape:
            with np.errstate(all="ignore"):
                angles = first + step * np.arange(count, dtype=np.float64)
                self._directions = np.stack([np.cos(angles), np.sin(angles)], axis=1).astype(np.float32)
            self._shape = shape
        return self._directions
