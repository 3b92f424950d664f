"""Conversion of depth images and point clouds to laser scans, and of scans to point clouds."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan, ceil

import numpy as np
from numpy.typing import NDArray

from linkwright.perception.scans.scan import Floats, Scan

_ROUNDING = 1e-9
"""A tolerance of ray indices, so that rounding does not move a point to the neighbouring ray."""


@dataclass(frozen=True, slots=True)
class Rays:
    """The rays of a scan to compute: angles in rad, ranges in metres."""

    angle_min: float
    angle_max: float
    angle_increment: float
    range_min: float
    range_max: float


@dataclass(frozen=True, slots=True)
class Pinhole:
    """A camera without distortion.

    The focal length and the centre's column and row are in pixels; the focal length is the one along the columns.
    """

    focal_length: float
    centre_column: float
    centre_row: float


def scan_of_depths(
    depths: NDArray[np.float64], camera: Pinhole, height: int, range_min: float, range_max: float
) -> tuple[Floats, Rays]:
    """Return a laser scan from the rows around the centre of a depth image.

    Args:
        depths: shape (rows, columns), metres along the optical axis; NaN or infinite where there is none.
        camera: the camera of the image.
        height: the number of rows to use.
        range_min: shorter ranges are ignored.
        range_max: longer ranges are ignored.

    Returns:
        The ranges from right to left, shape (columns,), and the angles of the rays. Each range is the nearest of its
        column; if there is none, it is infinite if the image has infinite values there, else NaN.

    Raises:
        ValueError: the rows are not all in the image.

    Source: depthimage_to_laserscan.
    """
    rows, columns = depths.shape
    if height / 2 > camera.centre_row or height / 2 > rows - camera.centre_row:
        raise ValueError(f"scan_height ( {height} pixels) is too large for the image height.")
    angle_max = atan(camera.centre_column / camera.focal_length)
    angle_min = -atan((columns - 1 - camera.centre_column) / camera.focal_length)
    increment = (angle_max - angle_min) / max(columns - 1, 1)
    first = int(camera.centre_row - height / 2)
    band = depths[first : first + height]
    slopes = (np.arange(columns) - camera.centre_column) / camera.focal_length
    places = ((-np.arctan(slopes) - angle_min) / increment + _ROUNDING).astype(int).clip(0, columns - 1)
    reach = band * np.hypot(slopes, 1.0)
    with np.errstate(invalid="ignore"):
        valid = np.isfinite(reach) & (reach >= range_min) & (reach <= range_max)
    nearest = np.full(columns, np.inf)
    np.minimum.at(nearest, places, np.where(valid, reach, np.inf).min(axis=0))
    far = np.zeros(columns, dtype=bool)
    far[places] |= np.isposinf(band).any(axis=0)
    ranges = np.where(np.isfinite(nearest) | far, nearest, np.nan).astype(np.float32)
    return ranges, Rays(angle_min, angle_max, increment, range_min, range_max)


def scan_of_points(
    points: NDArray[np.float64], rays: Rays, min_height: float, max_height: float, nothing: float
) -> Floats:
    """Return a laser scan from a point cloud: the nearest point of each ray.

    Args:
        points: shape (n, 3), metres in the frame of the laser; points that are not finite are ignored.
        rays: the rays of the scan.
        min_height: lower points are ignored.
        max_height: higher points are ignored.
        nothing: the range of rays without a point.

    Returns:
        The ranges, shape (rays,).

    Source: pointcloud_to_laserscan.
    """
    count = max(0, ceil((rays.angle_max - rays.angle_min) / rays.angle_increment))
    x, y, z = points[:, 0], points[:, 1], points[:, 2]
    reach, angles = np.hypot(x, y), np.arctan2(y, x)
    kept = np.isfinite(points).all(axis=1) & (z >= min_height) & (z <= max_height)
    kept &= (reach >= rays.range_min) & (reach <= rays.range_max)
    kept &= (angles >= rays.angle_min) & (angles <= rays.angle_max)
    places = ((angles[kept] - rays.angle_min) / rays.angle_increment).astype(int)
    inside = places < count
    nearest = np.full(count, np.inf)
    np.minimum.at(nearest, places[inside], reach[kept][inside])
    return np.where(np.isfinite(nearest), nearest, nothing).astype(np.float32)


def points_of_scan(scan: Scan) -> tuple[NDArray[np.float32], NDArray[np.int32]]:
    """Return the points of a scan in its frame, and the index of the range of each.

    Returns:
        Points, shape (n, 3), in metres, and indices, shape (n,). Ranges that were not measured have no point.

    Source: laser_geometry.
    """
    places = np.flatnonzero(scan.measured).astype(np.int32)
    reach, angles = scan.ranges[places], scan.angles[places]
    points = np.stack([reach * np.cos(angles), reach * np.sin(angles), np.zeros(len(places))], axis=-1)
    return points.astype(np.float32), places
