"""Beams of a laser scan, in the frame of the robot."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import rotation_matrix
from linkwright.geometry.single import Transform

Points = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Beams:
    """Selected beams of a scan, projected to the plane.

    Attributes:
        origin: x and y of the laser in the frame of the robot, in metres.
        ends: the end points of the beams, x and y in that frame, of shape (n, 2); a beam without a return ends at
            `range_max`.
        ranges: the lengths of the beams, of shape (n,), in metres.
        range_max: the maximum length of a beam, in metres.
    """

    origin: tuple[float, float]
    ends: Points
    ranges: NDArray[np.float64]
    range_max: float

    @property
    def hits(self) -> NDArray[np.bool_]:
        """A mask of the beams that hit something, of shape (n,)."""
        met: NDArray[np.bool_] = self.ranges < self.range_max
        return met

    @property
    def angles(self) -> NDArray[np.float64]:
        """The directions of the beams in the frame of the robot, of shape (n,), in radians."""
        way = self.ends - np.array(self.origin)
        angles: NDArray[np.float64] = np.arctan2(way[:, 1], way[:, 0])
        return angles


def beams_of_scan(
    scan: Any, laser_in_robot: Transform, most: int, least_range: float = -1.0, range_max: float = -1.0
) -> Beams:
    """Return evenly spaced beams of a sensor_msgs/LaserScan, without beams whose range is NaN.

    Args:
        scan: the message.
        laser_in_robot: the pose of the laser in the frame of the robot; the laser may be upside down or tilted.
        most: the maximum number of beams.
        least_range: beams up to this length count as having no return, in metres; negative for the scan's own limit.
        range_max: longer ranges count as this range, in metres; negative for the scan's own limit.
    """
    ranges = np.asarray(scan.ranges, np.float64)
    step = max(1, (len(ranges) - 1) // max(1, most - 1)) if most > 1 else max(1, len(ranges))
    chosen = np.arange(0, len(ranges), step)
    ranges = ranges[chosen]
    angles = scan.angle_min + chosen * scan.angle_increment
    longest = min(scan.range_max, range_max) if range_max > 0.0 else float(scan.range_max)
    shortest = max(scan.range_min, least_range) if least_range > 0.0 else float(scan.range_min)
    known = ~np.isnan(ranges)
    ranges, angles = ranges[known], angles[known]
    ranges = np.where((ranges <= shortest) | (ranges > longest), longest, ranges)
    flat = np.stack((ranges * np.cos(angles), ranges * np.sin(angles), np.zeros_like(ranges)), axis=-1)
    ends = flat @ np.asarray(rotation_matrix(laser_in_robot[3:])).T + np.array(laser_in_robot[:3])
    return Beams((laser_in_robot[0], laser_in_robot[1]), ends[:, :2], ranges, longest)
