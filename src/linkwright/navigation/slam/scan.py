"""Laser scans for the mapper, converted to points around the robot."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.slam.poses import FloatArray

_CELL_M = 0.05
"""The side of the cells in which points of a cloud are thinned."""


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
    free_length: float | None = None,
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
        free_length: how far a ray beyond the maximum is free, in meters; None for the maximum.
    """
    with np.errstate(invalid="ignore"):
        is_measured = np.isfinite(ranges) & (ranges > max(limits[0], cut_off[0], 0.0)) & (ranges < limits[1])
    distances = np.asarray(ranges[is_measured], dtype=np.float64)
    ray_angles = angles[is_measured]
    is_hit = distances < cut_off[1]
    clipped = np.where(is_hit, distances, cut_off[1] if free_length is None else free_length)
    rotation, position = laser
    laser_points = np.stack((clipped * np.cos(ray_angles), clipped * np.sin(ray_angles)), axis=-1)
    points: FloatArray = laser_points @ rotation[:2, :2].T + position[:2]
    return PlanarScan(points[is_hit], points[~is_hit], np.asarray(position[:2], dtype=np.float64), stamp_ns)


def planar_scan_from_points(
    points: FloatArray,
    position: FloatArray,
    heights: tuple[float, float],
    cut_off: tuple[float, float],
    free_length: float,
    stamp_ns: int,
) -> PlanarScan:
    """Convert the points of a 3D sensor to a planar scan with at most one point per cell.

    Args:
        points: the points in the frame of the base, of shape (n, 3), in meters.
        position: the position of the sensor in that frame, of shape (3,).
        heights: the minimum and maximum z of the points that are used.
        cut_off: the minimum and maximum distance from the sensor of the points that are used.
        free_length: how far the ray to a point beyond the maximum distance is free.
        stamp_ns: the time of the measurement, in nanoseconds.
    """
    points = points[np.isfinite(points).all(axis=1) & (points[:, 2] >= heights[0]) & (points[:, 2] <= heights[1])]
    origin: FloatArray = np.asarray(position[:2], dtype=np.float64)
    offsets = points[:, :2] - origin
    distances = np.linalg.norm(points - position, axis=1)
    is_near, is_far = (distances >= cut_off[0]) & (distances <= cut_off[1]), distances > cut_off[1]
    lengths = np.maximum(np.hypot(offsets[:, 0], offsets[:, 1]), 1e-9)
    free_ends = origin + offsets * (free_length / lengths)[:, None]
    return PlanarScan(_thin(points[is_near, :2]), _thin(free_ends[is_far]), origin, stamp_ns)


def _thin(points: FloatArray) -> FloatArray:
    """Return the first point in each cell."""
    cells = np.floor(points / _CELL_M).astype(np.int64)
    _, first = np.unique(cells, axis=0, return_index=True)
    thinned: FloatArray = points[np.sort(first)]
    return thinned
