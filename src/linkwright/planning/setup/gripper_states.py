"""Finds the positions in which a gripper is open and closed, by the distance between its fingers."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import combinations

import numpy as np

from linkwright.geometry.arrays import Array, matrix_from_pose
from linkwright.geometry.shapes import Box, Capsule, Cylinder, Sphere
from linkwright.planning.robot_model import PlacedShape, RobotModel, Shapes
from linkwright.planning.setup.bodies import find_bodies
from linkwright.planning.setup.groups import PlanningGroup
from linkwright.planning.setup.position_sampler import PositionSampler
from linkwright.urdf import Robot

_MAX_GRIPPER_JOINTS = 2
"""With more joints, the open state is the one in which the joints are at 0, as hands with many fingers are open."""


def open_and_close(
    robot: Robot, shapes: Shapes, group: PlanningGroup, sampler: PositionSampler, positions: Array
) -> tuple[Array, Array]:
    """Return the positions of all joints with an open and a closed gripper.

    Each joint of the closed gripper is at the limit at which the fingers are nearer to each other.
    """
    spread = _finger_spread(robot, shapes, group)
    opened, closed = positions.copy(), positions.copy()
    for joint in group.active_joints:
        index = sampler.joint_names.index(joint)
        limits = sampler.limits[index]
        if limits.is_continuous:
            continue
        ends = []
        for end in (limits.lower, limits.upper):
            moved = positions.copy()
            moved[index] = end
            ends.append((spread(moved), end))
        near, far = (min(ends), max(ends)) if ends[0][0] != ends[1][0] else (ends[0], ends[1])
        closed[index] = near[1]
        if len(group.active_joints) <= _MAX_GRIPPER_JOINTS:
            opened[index] = far[1]
    return opened, closed


def _finger_spread(robot: Robot, shapes: Shapes, group: PlanningGroup) -> Callable[[Array], float]:
    """Return a function for the mean distance in m between the fingers of a gripper.

    A finger is the last body of a branch; its position is the center of its shapes. A single finger is measured from
    the link to which the gripper is attached.
    """
    model = RobotModel(robot)
    moved = [body for body in find_bodies(robot) if body.joint_name in group.joints]
    parents = {robot.joints[body.joint_name].parent for body in moved}
    tips = [body.links[0] for body in moved if not parents.intersection(body.links)]
    if len(tips) == 1:
        tips.append(_fixed_finger(robot, shapes, group))
    centers = {link: _center(shapes.get(link, ())) for link in tips}

    def spread(positions: Array) -> float:
        model.move(positions)
        points = []
        for link in tips:
            rotation = model.data.xmat[model.body(link)].reshape(3, 3)
            points.append(model.data.xpos[model.body(link)] + rotation @ centers[link])
        distances = [float(np.linalg.norm(one - other)) for one, other in combinations(points, 2)]
        return round(sum(distances) / len(distances), 9)

    return spread


def _fixed_finger(robot: Robot, shapes: Shapes, group: PlanningGroup) -> str:
    """Return the link opposite to the only finger of a gripper: the one to which the finger is attached."""
    joint = robot.joints[group.joints[0]]
    return joint.parent if shapes.get(joint.parent) else group.parent_link


def _center(placed_shapes: Iterable[PlacedShape]) -> Array:
    """Return the mean center of shapes in the frame of their link, in m, shape (3,)."""
    centers = []
    for shape, pose, _ in placed_shapes:
        is_simple = isinstance(shape, (Box, Sphere, Cylinder, Capsule))
        offset = np.zeros(3) if is_simple else np.asarray(shape).mean(axis=0)
        centers.append(matrix_from_pose(pose)[:3] @ np.append(offset, 1.0))
    return np.mean(centers, axis=0) if centers else np.zeros(3)
