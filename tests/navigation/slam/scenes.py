"""Rooms of straight walls for tests: simulated laser scans, and paths through the rooms."""

from __future__ import annotations

from itertools import pairwise
from math import atan2, hypot, pi

import numpy as np

from linkwright.navigation.slam.poses import compose, relative_pose
from linkwright.navigation.slam.scan import planar_scan

IDENTITY_MOUNTING = (np.eye(3), np.zeros(3))
"""The pose of a laser at the center of the robot."""


def box_walls(x, y, width, height):
    """Return the four walls of a box around (x, y), shape (4, 2, 2)."""
    left, right, bottom, top = x - width / 2, x + width / 2, y - height / 2, y + height / 2
    corners = [(left, bottom), (right, bottom), (right, top), (left, top), (left, bottom)]
    return list(pairwise(corners))


def flat_walls(extra=()):
    """Return the walls of a flat of 12 m x 9 m, shape (n, 2, 2).

    The flat has furniture, and a corridor around its center.
    """
    boxes = [
        box_walls(0, 0, 12, 9),
        box_walls(0, 0, 5, 3.4),
        box_walls(-5, -3.8, 1.4, 0.8),
        box_walls(4.5, 3.9, 1, 0.7),
        box_walls(5.6, -1, 0.5, 1.2),
    ]
    boxes += [box_walls(-2, 4.0, 0.6, 0.6), box_walls(2.2, -4.1, 1.1, 0.4), box_walls(-5.6, 1.2, 0.5, 0.9), *extra]
    return np.array([wall for one_box in boxes for wall in one_box], dtype=float)


def measure_ranges(walls, pose, count=360, noise=0.01, rng=None, farthest=12.0):
    """Return the ranges and angles of a laser at a pose, shape (count,).

    A range is infinite if no wall is in range.
    """
    angles = np.linspace(-pi, pi, count, endpoint=False)
    x, y = np.cos(angles + pose[2])[:, None], np.sin(angles + pose[2])[:, None]
    start, directions = walls[:, 0] - pose[:2], walls[:, 1] - walls[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        cross_product = x * directions[:, 1] - y * directions[:, 0]
        distance = (start[:, 0] * directions[:, 1] - start[:, 1] * directions[:, 0]) / cross_product
        wall_fraction = (start[:, 0] * y - start[:, 1] * x) / cross_product
    ranges = np.where((distance > 0) & (wall_fraction >= 0) & (wall_fraction <= 1), distance, np.inf).min(axis=1)
    if rng is not None:
        ranges = ranges + rng.normal(0, noise, count)
    return np.where(ranges < farthest, ranges, np.inf), angles


def make_scan(walls, pose, stamp_ns=0, rng=None, count=360, farthest=12.0):
    """Return the scan at a pose of the robot."""
    ranges, angles = measure_ranges(walls, pose, count, rng=rng, farthest=farthest)
    return planar_scan(ranges, angles, (0.05, farthest), (0.0, 20.0), IDENTITY_MOUNTING, stamp_ns)


def path_along(corners, step=0.1, turn=0.1):
    """Return poses along a path through corners, shape (n, 3).

    The path has straight lines, and turns in place.
    """
    poses = []
    heading = None
    for (x, y), (next_x, next_y) in pairwise(corners):
        length, towards = hypot(next_x - x, next_y - y), atan2(next_y - y, next_x - x)
        if heading is not None:
            difference = (towards - heading + pi) % (2 * pi) - pi
            shares = np.linspace(0, 1, max(2, round(abs(difference) / turn)), endpoint=False)[1:]
            poses += [(x, y, heading + share * difference) for share in shares]
        heading = towards
        shares = np.linspace(0, 1, max(2, round(length / step)), endpoint=False)
        poses += [(x + share * (next_x - x), y + share * (next_y - y), heading) for share in shares]
    return np.array(poses)


def add_drift(poses, scale=1.02, yaw_per_meter=0.03, noise=0.0, rng=None):
    """Return the poses of drifting odometry: distances are scaled, turns have errors.

    Noise is relative to the step.
    """
    result = [poses[0]]
    for old, new in pairwise(poses):
        step = relative_pose(old, new)
        length = hypot(step[0], step[1])
        drifted_step = np.array((scale * step[0], scale * step[1], step[2] + yaw_per_meter * length))
        if rng is not None:
            drifted_step += rng.normal(0, noise, 3) * (length + abs(step[2]))
        result.append(compose(result[-1], drifted_step))
    return np.array(result)
