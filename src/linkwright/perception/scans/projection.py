"""Convert depth images and point clouds to scans, and scans to points."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan, ceil

import numpy as np
from numpy.typing import NDArray

from linkwright.perception.scans.scan import Floats, Scan

_INDEX_TOLERANCE = 1e-9
"""The tolerance of ray indices, so that rounding does not move a point to the neighboring ray."""


@dataclass(frozen=True, slots=True)
class Rays:
    """The rays of a laser scan to compute: angles in rad, ranges in meters."""

    angle_min: float
    angle_max: float
    angle_increment: float
    range_min: float
    range_max: float


@dataclass(frozen=True, slots=True)
class Pinhole:
    """A camera without distortion.

    The focal length along the columns, and the column and row of the center, are in pixels.
    """

    focal_length: float
    center_column: float
    center_row: float


def scan_from_depths(
    depths: NDArray[np.float64], camera: Pinhole, height: int, range_min: float, range_max: float
) -> tuple[Floats, Rays]:
    """Return a laser scan from the rows around the center of a depth image.

    Args:
        depths: shape ``(rows, columns)``, meters along the optical axis; NaN or infinite for unknown depths.
        camera: the camera of the image.
        height: the number of rows to use.
        range_min: the minimum range that is used, meters.
        range_max: the maximum range that is used, meters.

    Returns:
        The ranges from right to left, shape ``(columns,)``, and their rays. Each range is the nearest one in its
        column. For a column without a valid range, it is infinite if one of the depths is infinite, else NaN.

    Raises:
        ValueError: some of the rows are outside the image.

    Source: depthimage_to_laserscan.
    """
    rows, columns = depths.shape
    if height / 2 > camera.center_row or height / 2 > rows - camera.center_row:
        raise ValueError(f"scan_height ( {height} pixels) is too large for the image height.")
    angle_max = atan(camera.center_column / camera.focal_length)
    angle_min = -atan((columns - 1 - camera.center_column) / camera.focal_length)
    increment = (angle_max - angle_min) / max(columns - 1, 1)
    first_row = int(camera.center_row - height / 2)
    band = depths[first_row : first_row + height]
    slopes = (np.arange(columns) - camera.center_column) / camera.focal_length
    ray_indices = ((-np.arctan(slopes) - angle_min) / increment + _INDEX_TOLERANCE).astype(int).clip(0, columns - 1)
    ranges_in_band = band * np.hypot(slopes, 1.0)
    with np.errstate(invalid="ignore"):
        is_valid = np.isfinite(ranges_in_band) & (ranges_in_band >= range_min) & (ranges_in_band <= range_max)
    nearest = np.full(columns, np.inf)
    np.minimum.at(nearest, ray_indices, np.where(is_valid, ranges_in_band, np.inf).min(axis=0))
    has_infinite = np.zeros(columns, dtype=bool)
    has_infinite[ray_indices] |= np.isposinf(band).any(axis=0)
    ranges = np.where(np.isfinite(nearest) | has_infinite, nearest, np.nan).astype(np.float32)
    return ranges, Rays(angle_min, angle_max, increment, range_min, range_max)


def scan_from_points(
    points: NDArray[np.float64], rays: Rays, min_height: float, max_height: float, empty_range: float
) -> Floats:
    """Return a laser scan from a point cloud: the nearest point of each ray.

    Args:
        points: shape ``(n, 3)``, meters in the frame of the laser; points that are not finite are ignored.
        rays: the rays of the scan.
        min_height: the minimum z of points that are used, meters.
        max_height: the maximum z of points that are used, meters.
        empty_range: the range of a ray without a point, meters or infinite.

    Returns:
        The ranges, shape ``(rays,)``, in meters.

    Source: pointcloud_to_laserscan.
    """
    count = max(0, ceil((rays.angle_max - rays.angle_min) / rays.angle_increment))
    x, y, z = points[:, 0], points[:, 1], points[:, 2]
    distances, angles = np.hypot(x, y), np.arctan2(y, x)
    is_kept = np.isfinite(points).all(axis=1) & (z >= min_height) & (z <= max_height)
    is_kept &= (distances >= rays.range_min) & (distances <= rays.range_max)
    is_kept &= (angles >= rays.angle_min) & (angles <= rays.angle_max)
    ray_indices = ((angles[is_kept] - rays.angle_min) / rays.angle_increment).astype(int)
    is_in_scan = ray_indices < count
    nearest = np.full(count, np.inf)
    np.minimum.at(nearest, ray_indices[is_in_scan], distances[is_kept][is_in_scan])
    return np.where(np.isfinite(nearest), nearest, empty_range).astype(np.float32)


def points_from_scan(scan: Scan) -> tuple[NDArray[np.float32], NDArray[np.int32]]:
    """Return the points of a scan in its own frame, and the index of the ray of each point.

    Returns:
        Points, shape ``(n, 3)``, in meters; and indices, shape ``(n,)``. Rays without a measurement have no point.

    Source: laser_geometry.
    """
    indices = np.flatnonzero(scan.measured_mask).astype(np.int32)
    ranges, angles = scan.ranges[indices], scan.angles[indices]
    points = np.stack([ranges * np.cos(angles), ranges * np.sin(angles), np.zeros(len(indices))], axis=-1)
    return points.astype(np.float32), indices
