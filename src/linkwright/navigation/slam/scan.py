"""Laser scans for the mapper, converted to points around the robot."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.slam.poses import FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class PlanarScan:
    """A laser scan in the frame of the robot's base.

    The robot's motion during the scan is ignored.

    Attributes:
        points: the ends of rays with a hit, of shape (n, 2), in meters.
        free_ends: the ends of rays that were cut off at the maximum range, of shape (m, 2); the space up to them is
            free.
        origin: the origin of the rays, of shape (2,).
        stamp_ns: the stamp, in nanoseconds.
    """

    points: FloatArray
    free_ends: FloatArray
    origin: FloatArray
    stamp_ns: int


def planar_scan(
    ranges: NDArray[np.floating],
    angles: FloatArray,
    limits: tuple[float, float],
    cut_off: tuple[float, float],
    laser: tuple[FloatArray, FloatArray],
    stamp_ns: int,
) -> PlanarScan:
    """Convert the ranges of a laser to points.

    As in Karto, a range that is not measured (NaN, infinite, 0, outside the laser's own limits) or below the mapper's
    minimum is ignored, and a range beyond the mapper's maximum marks the ray up to the maximum as free.

    Args:
        ranges: the ranges in meters, of shape (n,).
        angles: the angles of the rays in the frame of the laser, about its z axis, of shape (n,), in radians.
        limits: the minimum and maximum range that the laser measures, in meters.
        cut_off: the mapper's minimum and maximum range, in meters.
        laser: the rotation matrix, of shape (3, 3), and position, of shape (3,), of the laser in the frame of the base;
            the laser may be mounted upside down.
        stamp_ns: the time of the measurement, in nanoseconds.
    """
    with np.errstate(invalid="ignore"):
        is_measured = np.isfinite(ranges) & (ranges > max(limits[0], cut_off[0], 0.0)) & (ranges < limits[1])
    distances = np.asarray(ranges[is_measured], dtype=np.float64)
    ray_angles = angles[is_measured]
    clipped = np.minimum(distances, cut_off[1])
    rotation, position = laser
    laser_points = np.stack((clipped * np.cos(ray_angles), clipped * np.sin(ray_angles)), axis=-1)
    points: FloatArray = laser_points @ rotation[:2, :2].T + position[:2]
    is_hit = distances < cut_off[1]
    return PlanarScan(points[is_hit], points[~is_hit], np.asarray(position[:2], dtype=np.float64), stamp_ns)
