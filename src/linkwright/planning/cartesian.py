"""Paths on which a link follows poses, such as a straight line."""

from __future__ import annotations

from collections.abc import Callable
from math import ceil

import numpy as np

from linkwright.geometry.arrays import Array, slerp
from linkwright.planning.inverse_kinematics import ChainSolver

_MAX_ROTATION_RAD = 0.05
"""The maximum rotation between two poses of a path."""
MAX_JOINT_STEP = 0.5
"""The maximum change of a joint between two poses of a path, in rad or m; a larger one is a jump."""


def line_poses(start: Array, end: Array, max_step: float) -> Array:
    """Return poses on the straight line between two poses, without the first one.

    The orientation turns at a constant rate.

    Args:
        start: the first pose, shape (7,).
        end: the last pose, shape (7,).
        max_step: the maximum distance between two poses in m.

    Returns:
        Poses of shape (n, 7).
    """
    distance = float(np.linalg.norm(end[:3] - start[:3]))
    angle = 2.0 * float(np.arccos(min(1.0, abs(float(start[3:] @ end[3:])))))
    count = max(1, ceil(distance / max_step), ceil(angle / _MAX_ROTATION_RAD))
    shares = np.arange(1, count + 1) / count
    poses = np.empty((count, 7))
    poses[:, :3] = start[:3] + shares[:, None] * (end[:3] - start[:3])
    poses[:, 3:] = slerp(start[3:], end[3:], shares)
    return poses


def follow_poses(
    solver: ChainSolver,
    start: Array,
    poses: Array,
    indexes: Array,
    is_valid: Callable[[Array], bool] | None = None,
    max_joint_step: float = MAX_JOINT_STEP,
) -> tuple[Array, float]:
    """Return the joint positions at which a link passes through poses one after the other.

    The path ends before the first pose that cannot be reached without a jump of a joint, or that is not valid.

    Args:
        solver: the solver of the link.
        start: the positions of all joints at the start of the path.
        poses: the poses of the link in the frame of the root link, shape (n, 7).
        indexes: the indexes of the joints that must not jump.
        is_valid: returns whether the positions of all joints are acceptable.
        max_joint_step: the change of a joint in rad or m that counts as a jump.

    Returns:
        The positions of all joints, starting with the start, shape (m, all joints), and the followed fraction of the
        poses.
    """
    path = [start]
    for number, pose in enumerate(poses):
        positions = solver.solve_from(pose, path[-1])
        if (
            positions is None
            or float(np.abs(positions[indexes] - path[-1][indexes]).max()) > max_joint_step
            or (is_valid is not None and not is_valid(positions))
        ):
            return np.array(path), number / len(poses)
        path.append(positions)
    return np.array(path), 1.0
