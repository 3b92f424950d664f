"""Detect contradictory poses of two scans.

Poses are contradictory if rays of one scan pass through points of the other.
"""

from __future__ import annotations

from math import pi

import numpy as np

from linkwright.navigation.slam.poses import FloatArray, relative_pose, transform_points
from linkwright.navigation.slam.scan import PlanarScan

_MAX_RAY_ANGLE_RAD = 0.03
"""The maximum angle between a point and its neighboring rays, in radians."""
_MIN_DEPTH_M = 0.3
"""The minimum distance by which a ray must pass a point of the other scan for a contradiction, in meters."""
_MIN_POINTS = 20


def compute_contradiction_share(
    first: PlanarScan, first_pose: FloatArray, second: PlanarScan, second_pose: FloatArray
) -> float:
    """Return the share of a scan's points through which the other scan's rays pass.

    The share is computed for both scans, and the larger one is returned, from 0 to 1.

    Args:
        first: a scan.
        first_pose: the robot's pose at the first scan, of shape (3,).
        second: another scan.
        second_pose: the robot's pose at the second scan, in the same frame.
    """
    return max(
        _compute_share_passed_through(first, second, relative_pose(first_pose, second_pose)),
        _compute_share_passed_through(second, first, relative_pose(second_pose, first_pose)),
    )


def _compute_share_passed_through(viewer: PlanarScan, other: PlanarScan, pose: FloatArray) -> float:
    """Return the share of another scan's points that the viewer's rays pass through.

    `pose` is the pose of the other scan in the viewer's frame.
    """
    ray_ends = viewer.points - viewer.origin
    points = transform_points(pose, other.points) - viewer.origin
    if len(ray_ends) < _MIN_POINTS or len(points) < _MIN_POINTS:
        return 0.0
    bearings = np.arctan2(ray_ends[:, 1], ray_ends[:, 0])
    order = np.argsort(bearings)
    bearings, ranges = bearings[order], np.hypot(ray_ends[:, 0], ray_ends[:, 1])[order]
    bearings = np.concatenate(([bearings[-1] - 2 * pi], bearings, [bearings[0] + 2 * pi]))
    ranges = np.concatenate((ranges[-1:], ranges, ranges[:1]))
    point_bearings = np.arctan2(points[:, 1], points[:, 0])
    next_rays = np.clip(np.searchsorted(bearings, point_bearings), 1, len(bearings) - 1)
    # Both neighboring rays must be longer, because next to an edge one of them may be longer without a contradiction.
    has_neighbors = (bearings[next_rays] - point_bearings < _MAX_RAY_ANGLE_RAD) & (
        point_bearings - bearings[next_rays - 1] < _MAX_RAY_ANGLE_RAD
    )
    is_passed = (
        np.minimum(ranges[next_rays], ranges[next_rays - 1]) > np.hypot(points[:, 0], points[:, 1]) + _MIN_DEPTH_M
    )
    return float((has_neighbors & is_passed).sum() / max(int(has_neighbors.sum()), _MIN_POINTS))
