"""Laser scans, and the base class of their filters.

A filter is a dataclass; its fields are the parameters, and fields without a default are required. Filters of other
packages are found by entry points of ``linkwright.laser_filters``; their names are the ``type`` in parameter files.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import rotation_matrix
from linkwright.geometry.single import Transform

Floats = NDArray[np.float32]
Mask = NDArray[np.bool_]

Lookup = Callable[[str, str, int], "Transform | None"]
"""A function that returns the pose of the second frame in the first at a time in nanoseconds, or None."""


@dataclass(slots=True, eq=False)
class Scan:
    """A laser scan, with arrays that filters may change.

    Attributes:
        ranges: shape (n,), meters; missing measurements are NaN, infinite, or outside the limits.
        intensities: shape (n,), or (0,) if there are none.
        angle_min: the angle of the first range, rad.
        angle_max: the angle of the last range, rad.
        angle_increment: the angle between successive ranges, rad.
        range_min: the minimum valid range, meters.
        range_max: the maximum valid range, meters.
        time_increment: the time between successive ranges, seconds.
        stamp_ns: the time of the first range, nanoseconds.
        frame: the frame of the scan; x points forward, z upward.
    """

    ranges: Floats
    intensities: Floats
    angle_min: float
    angle_max: float
    angle_increment: float
    range_min: float
    range_max: float
    time_increment: float
    stamp_ns: int
    frame: str

    @property
    def angles(self) -> NDArray[np.float64]:
        """The angles of the rays, shape ``(n,)``, rad."""
        return np.asarray(self.angle_min + np.arange(len(self.ranges)) * self.angle_increment, dtype=np.float64)

    @property
    def measured_mask(self) -> Mask:
        """Whether each range is within the limits, shape ``(n,)``."""
        return (self.ranges >= self.range_min) & (self.ranges <= self.range_max)

    def points(self, frame: str, lookup: Lookup) -> NDArray[np.float64] | None:
        """Return the end points of the rays in a frame, shape ``(n, 3)``, meters.

        The result is None if there is no transform to the frame. The points of ranges that were not measured are
        meaningless.
        """
        ranges = np.where(self.measured_mask, self.ranges, 0.0)
        angles = self.angles
        rays = [ranges * np.cos(angles), ranges * np.sin(angles), np.zeros(len(ranges))]
        points: NDArray[np.float64] = np.stack(rays, axis=-1).astype(np.float64)
        if frame == self.frame:
            return points
        pose = lookup(frame, self.frame, self.stamp_ns)
        if pose is None:
            return None
        transformed: NDArray[np.float64] = points @ rotation_matrix(pose[3:]).T + np.array(pose[:3], dtype=np.float64)
        return transformed


class ScanFilter(ABC):
    """The base class of scan filters."""

    @abstractmethod
    def apply(self, scan: Scan, lookup: Lookup) -> Scan | None:
        """Return the filtered scan, possibly the same object, or None to drop the scan."""


def replace_ranges(scan: Scan, mask: Mask, value: float = float("nan")) -> Scan:
    """Replace the ranges that a mask of shape ``(n,)`` selects, and return the scan."""
    scan.ranges[mask] = value
    return scan
