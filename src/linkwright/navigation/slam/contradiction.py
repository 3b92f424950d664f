"""Detecting that the poses of two scans contradict each other: rays of one cannot pass through hits of the other."""

from __future__ import annotations

from math import pi

import numpy as np

from linkwright.navigation.slam.poses import Floats, between, placed
from linkwright.navigation.slam.scan import PlanarScan

_APART = 0.03
"""Rays whose directions differ by more than this are not neighbours, radians."""
_BEHIND = 0.3
"""The least distance in metres behind a point of the other scan for a contradiction."""
_FEWEST = 20


def contradiction(first: PlanarScan, first_pose: Floats, second: PlanarScan, second_pose: Floats) -> float:
    """The part of a scan's points that the other one's rays pass through, whichever is more, from 0 to 1.

    Args:
        first: a scan.
        first_pose: of the robot then, of shape (3,).
        second: another one.
        second_pose: of the robot then, in the same frame.
    """
    return max(
        _looked_through(first, second, between(first_pose, second_pose)),
        _looked_through(second, first, between(second_pose, first_pose)),
    )


def _looked_through(viewer: PlanarScan, other: PlanarScan, pose: Floats) -> float:
    """The part of the points of `other`, at `pose` in the frame of the viewer, that the viewer's rays pass through."""
    seen = viewer.points - viewer.origin
    points = placed(pose, other.points) - viewer.origin
    if len(seen) < _FEWEST or len(points) < _FEWEST:
        return 0.0
    bearings = np.arctan2(seen[:, 1], seen[:, 0])
    order = np.argsort(bearings)
    bearings, ranges = bearings[order], np.hypot(seen[:, 0], seen[:, 1])[order]
    bearings = np.concatenate(([bearings[-1] - 2 * pi], bearings, [bearings[0] + 2 * pi]))
    ranges = np.concatenate((ranges[-1:], ranges, ranges[:1]))
    wanted = np.arctan2(points[:, 1], points[:, 0])
    after = np.clip(np.searchsorted(bearings, wanted), 1, len(bearings) - 1)
    # Both neighbours must be longer: beside an edge one of them is.
    close = (bearings[after] - wanted < _APART) & (wanted - bearings[after - 1] < _APART)
    further = np.minimum(ranges[after], ranges[after - 1]) > np.hypot(points[:, 0], points[:, 1]) + _BEHIND
    return float((close & further).sum() / max(int(close.sum()), _FEWEST))
