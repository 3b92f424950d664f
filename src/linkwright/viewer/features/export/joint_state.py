"""Joint positions from where links are."""

from __future__ import annotations

from collections.abc import Mapping
from math import atan2, isfinite, pi

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import quaternion_inverse, quaternion_multiply, rotate
from linkwright.geometry.single import quaternion_of
from linkwright.urdf import Joint, Robot

Pose = NDArray[np.float64]
"""x, y, z (metres), qx, qy, qz, qw; shape (7,)."""


def positions_now(robot: Robot, poses: Mapping[str, Pose]) -> dict[str, float]:
    """Positions (rad or m) of the revolute, continuous and prismatic joints whose links can be placed.

    Args:
        robot: the description.
        poses: link -> where it is, all in one frame.
    """
    positions = {}
    for joint in robot.joints.values():
        if joint.type not in ("revolute", "continuous", "prismatic"):
            continue
        if joint.parent in poses and joint.child in poses:
            position = _position(joint, poses[joint.parent], poses[joint.child])
            if isfinite(position):
                positions[joint.name] = position
    return positions


def _position(joint: Joint, parent: Pose, child: Pose) -> float:
    back = quaternion_inverse(parent[3:])
    axis = np.asarray(joint.axis, dtype=np.float64)
    length = float(np.linalg.norm(axis))
    if length == 0.0:
        return 0.0
    axis = axis / length
    origin = np.asarray(quaternion_of(joint.origin), dtype=np.float64)
    if joint.type == "prismatic":
        shift = rotate(back, child[:3] - parent[:3]) - np.asarray(joint.origin.xyz)
        return float(np.dot(rotate(quaternion_inverse(origin), shift), axis))
    turn = quaternion_multiply(quaternion_inverse(origin), quaternion_multiply(back, child[3:]))
    angle = 2.0 * atan2(float(np.dot(turn[:3], axis)), float(turn[3]))
    angle = (angle + pi) % (2.0 * pi) - pi
    return _within(joint, angle)


def _within(joint: Joint, angle: float) -> float:
    """The angle, or one a full turn away where that is within the limits."""
    if joint.type == "continuous" or joint.limit is None:
        return angle
    for turned in (angle, angle + 2.0 * pi, angle - 2.0 * pi):
        if joint.limit.lower - 1e-3 <= turned <= joint.limit.upper + 1e-3:
            return turned
    return angle
