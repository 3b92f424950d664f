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
        origin: x and y of the laser in the frame of the robot, in meters.
        end_points: the end points of the beams, x and y in that frame, of shape (n, 2); a beam without a return ends at
            `range_max`.
        ranges: the lengths of the beams, of shape (n,), in meters.
        range_max: the maximum length of a beam, in meters.
    """

    origin: tuple[float, float]
    end_points: Points
    ranges: NDArray[np.float64]
    range_max: float

    @property
    def hit_mask(self) -> NDArray[np.bool_]:
        """A mask of the beams that hit an obstacle, of shape (n,)."""
        is_hit: NDArray[np.bool_] = self.ranges < self.range_max
        return is_hit

    @property
    def angles(self) -> NDArray[np.float64]:
        """The directions of the beams in the frame of the robot, of shape (n,), in radians."""
        offsets = self.end_points - np.array(self.origin)
        angles: NDArray[np.float64] = np.arctan2(offsets[:, 1], offsets[:, 0])
        return angles


def beams_from_scan(
    scan: Any, laser_in_robot: Transform, max_beams: int, min_range: float = -1.0, range_max: float = -1.0
) -> Beams:
    """Return evenly spaced beams of a sensor_msgs/LaserScan, without beams whose range is NaN.

    Args:
        scan: the message.
        laser_in_robot: the pose of the laser in the frame of the robot; the laser may be upside down or tilted.
        max_beams: the maximum number of beams.
        min_range: beams up to this length count as having no return, in meters; negative for the scan's own limit.
        range_max: longer ranges count as this range, in meters; negative for the scan's own limit.
    """
    ranges = np.asarray(scan.ranges, np.float64)
    step = max(1, (len(ranges) - 1) // max(1, max_beams - 1)) if max_beams > 1 else max(1, len(ranges))
    indices = np.arange(0, len(ranges), step)
    ranges = ranges[indices]
    angles = scan.angle_min + indices * scan.angle_increment
    max_length = min(scan.range_max, range_max) if range_max > 0.0 else float(scan.range_max)
    min_length = max(scan.range_min, min_range) if min_range > 0.0 else float(scan.range_min)
    is_number = ~np.isnan(ranges)
    ranges, angles = ranges[is_number], angles[is_number]
    ranges = np.where((ranges <= min_length) | (ranges > max_length), max_length, ranges)
    laser_points = np.stack((ranges * np.cos(angles), ranges * np.sin(angles), np.zeros_like(ranges)), axis=-1)
    ends = laser_points @ np.asarray(rotation_matrix(laser_in_robot[3:])).T + np.array(laser_in_robot[:3])
    return Beams((laser_in_robot[0], laser_in_robot[1]), ends[:, :2], ranges, max_length)
