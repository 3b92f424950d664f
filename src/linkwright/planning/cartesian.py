"""Paths on which a link follows poses, such as a straight line."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import ceil

import numpy as np

from linkwright.geometry.arrays import Array, slerp
from linkwright.planning.inverse_kinematics import ChainSolver

_MAX_ROTATION_RAD = 0.05
"""The maximum rotation between two poses of a path."""
MAX_JOINT_STEP = 0.5
"""The maximum change of a joint between two poses of a path, in rad or m; a larger one is a jump."""

_MAX_RADIUS_DIFFERENCE_M = 0.01
"""The maximum difference of the distances of start and end from the center, as in Pilz' planner."""
_MIN_AREA_M2 = 1e-5
"""The area of the start, end and auxiliary point up to which they are on a line, as in Pilz' planner."""


class ArcError(ValueError):
    """Raised if there is no arc through the given points; the message gives the reason."""


@dataclass(frozen=True, slots=True, eq=False)
class ArcPoint:
    """The point that defines an arc, beside its start and its end.

    Attributes:
        position: in the frame of the root link in m, shape (3,).
        is_center: whether it is the center of the shorter arc, and not a point on the arc.
    """

    position: Array
    is_center: bool


def arc_poses(start: Array, end: Array, point: ArcPoint, max_step: float) -> Array:
    """Return poses on the arc between two poses, without the first one.

    The orientation turns at a constant rate.

    Args:
        start: the first pose, shape (7,).
        end: the last pose, shape (7,).
        point: the center of the arc, or a point on it.
        max_step: the maximum distance between two poses in m.

    Returns:
        Poses of shape (n, 7).

    Raises:
        ArcError: the points are on a line, or the center has different distances from start and end.
    """
    to_point, to_end = point.position - start[:3], end[:3] - start[:3]
    normal: Array = np.asarray(np.cross(to_point, to_end), dtype=np.float64)
    if np.linalg.norm(normal) < _MIN_AREA_M2:
        raise ArcError("the start, the goal and the auxiliary point of the circle are on a line")
    center = point.position if point.is_center else start[:3] + _circumcenter(to_point, to_end, normal)
    radius, end_radius = (float(np.linalg.norm(pose[:3] - center)) for pose in (start, end))
    if abs(radius - end_radius) > _MAX_RADIUS_DIFFERENCE_M:
        raise ArcError("the distances of the center from the start and from the goal are different")
    first = (start[:3] - center) / radius
    axis = np.cross(first, end[:3] - center) if point.is_center else normal
    second = np.cross(axis / np.linalg.norm(axis), first)
    angle = float(np.arctan2((end[:3] - center) @ second, (end[:3] - center) @ first)) % (2.0 * np.pi)
    poses = line_poses(start, end, np.inf)
    count = max(len(poses), ceil(angle * radius / max_step), ceil(angle / _MAX_ROTATION_RAD))
    shares = np.arange(1, count + 1) / count
    angles, radii = angle * shares, radius + (end_radius - radius) * shares
    positions = center + radii[:, None] * (np.cos(angles)[:, None] * first + np.sin(angles)[:, None] * second)
    return np.concatenate((positions, slerp(start[3:], end[3:], shares)), axis=1)


def _circumcenter(first: Array, second: Array, normal: Array) -> Array:
    """Return the center of the circle through the origin and two points.

    Args:
        first: a point, shape (3,).
        second: another point, shape (3,).
        normal: their cross product.
    """
    weighted = (first @ first) * second - (second @ second) * first
    return np.asarray(np.cross(weighted, normal) / (2.0 * (normal @ normal)), dtype=np.float64)


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
