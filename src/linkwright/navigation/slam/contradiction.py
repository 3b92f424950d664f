"""Detection of contradicting poses of two scans: rays of one cannot pass through hits of the other."""

from __future__ import annotations

from math import pi

import numpy as np

from linkwright.navigation.slam.poses import Floats, relative_pose, transform_points
from linkwright.navigation.slam.scan import PlanarScan

_APART = 0.03
"""Rays whose directions differ by more than this are not neighbours, radians."""
_BEHIND = 0.3
"""The least distance in metres behind a point of the other scan for a contradiction."""
_FEWEST = 20


def contradiction_share(first: PlanarScan, first_pose: Floats, second: PlanarScan, second_pose: Floats) -> float:
    """Return the share of a scan's points through which the other scan's rays pass.

    The share is computed for both scans, and the larger one is returned, from 0 to 1.

    Args:
        first: a scan.
        first_pose: the robot's pose at the first scan, of shape (3,).
        second: another scan.
        second_pose: the robot's pose at the second scan, in the same frame.
    """
    return max(
        _share_passed_through(first, second, relative_pose(first_pose, second_pose)),
        _share_passed_through(second, first, relative_pose(second_pose, first_pose)),
    )


def _share_passed_through(viewer: PlanarScan, other: PlanarScan, pose: Floats) -> float:
    """Return the share of another scan's points that the viewer's rays pass through.

    `pose` is the pose of the other scan in the viewer's frame.
    """
    seen = viewer.points - viewer.origin
    points = transform_points(pose, other.points) - viewer.origin
    if len(seen) < _FEWEST or len(points) < _FEWEST:
        return 0.0
    bearings = np.arctan2(seen[:, 1], seen[:, 0])
    order = np.argsort(bearings)
    bearings, ranges = bearings[order], np.hypot(seen[:, 0], seen[:, 1])[order]
    bearings = np.concatenate(([bearings[-1] - 2 * pi], bearings, [bearings[0] + 2 * pi]))
    ranges = np.concatenate((ranges[-1:], ranges, ranges[:1]))
    wanted = np.arctan2(points[:, 1], points[:, 0])
    after = np.clip(np.searchsorted(bearings, wanted), 1, len(bearings) - 1)
    # Require both neighbouring rays to be longer: next to an edge, only one of them is longer.
    close = (bearings[after] - wanted < _APART) & (wanted - bearings[after - 1] < _APART)
    further = np.minimum(ranges[after], ranges[after - 1]) > np.hypot(points[:, 0], points[:, 1]) + _BEHIND
    return float((close & further).sum() / max(int(close.sum()), _FEWEST))
