"""Chooses named states for groups: ``home`` for arms, ``open`` and ``close`` for grippers."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import combinations

import numpy as np

from linkwright.geometry.arrays import Array, matrix_from_pose
from linkwright.geometry.shapes import Box, Capsule, Cylinder, Sphere
from linkwright.planning.collision_scene import CollisionScene
from linkwright.planning.robot_model import PlacedShape, RobotModel, Shapes
from linkwright.planning.setup.bodies import find_bodies
from linkwright.planning.setup.collision_pairs import CollisionPairs
from linkwright.planning.setup.groups import PlanningGroup, RobotGroups
from linkwright.planning.setup.position_sampler import PositionSampler
from linkwright.urdf import Robot

States = dict[str, dict[str, dict[str, float]]]
"""The joint positions in rad or m, by group, name of the state, and joint."""

HOME, OPEN, CLOSE = "home", "open", "close"
_ATTEMPTS = 1000
_SEED = 0
_MAX_GRIPPER_JOINTS = 2
"""With more joints, the open state is the one in which the joints are at 0, as hands with many fingers are open."""
_DECIMALS = 4


def choose_states(robot: Robot, shapes: Shapes, groups: RobotGroups, pairs: CollisionPairs) -> States:
    """Return the named states of all groups.

    The arms are at 0 if the limits allow it and nothing collides there, or else in the middle of their limits, or in
    random positions without a collision.
    """
    sampler = PositionSampler(robot)
    indexes = {name: index for index, name in enumerate(sampler.joint_names)}
    positions = sampler.default()
    states: States = {}

    def store(group: PlanningGroup, name: str, values: Array) -> None:
        states.setdefault(group.name, {})[name] = {
            joint: _round_inside(float(values[indexes[joint]]), sampler, indexes[joint])
            for joint in group.active_joints
        }

    for group in groups.groups:
        if group.is_end_effector:
            opened, closed = _open_and_close(robot, shapes, group, sampler, positions)
            store(group, OPEN, opened)
            store(group, CLOSE, closed)
            positions = opened
    arms = [group for group in groups.groups if not group.is_end_effector]
    moved = [indexes[joint] for group in arms for joint in group.active_joints]
    home = _find_free_positions(CollisionScene(robot, shapes, (), pairs.allowed()), sampler, positions, moved)
    for group in arms:
        store(group, HOME, home)
    return {group.name: states[group.name] for group in groups.groups if group.active_joints}


def start_positions(groups: RobotGroups, states: States, robot: Robot) -> dict[str, float]:
    """Return the positions at which a demo starts, by joint.

    Arms are at home and grippers open; other joints have MoveIt's default positions.
    """
    sampler = PositionSampler(robot)
    positions = dict(zip(sampler.joint_names, map(float, sampler.default()), strict=True))
    positions = {name: _round_inside(positions[name], sampler, sampler.joint_names.index(name)) for name in positions}
    for group_states in states.values():
        positions.update(group_states.get(HOME) or group_states.get(OPEN) or {})
    return {name: positions[name] for name in groups.controlled_joints}


def _find_free_positions(
    scene: CollisionScene, sampler: PositionSampler, positions: Array, moved: Iterable[int]
) -> Array:
    """Return positions without a collision, or the given ones if none are found.

    Args:
        scene: the robot.
        sampler: the limits of its joints.
        positions: the positions to start with.
        moved: the indexes of the joints that may be moved.
    """
    moved = list(moved)
    random = np.random.default_rng(_SEED)
    candidate, target = positions.copy(), positions.copy()
    for attempt in range(_ATTEMPTS):
        if scene.is_free(candidate):
            return candidate
        share = min(1.0, attempt / 100)  # Prefer positions near the given ones.
        target[moved] = sampler.sample(random)[moved]
        candidate = positions + share * (target - positions)
    return positions


def _open_and_close(
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
    for shape, pose in placed_shapes:
        is_simple = isinstance(shape, (Box, Sphere, Cylinder, Capsule))
        offset = np.zeros(3) if is_simple else np.asarray(shape).mean(axis=0)
        centers.append(matrix_from_pose(pose)[:3] @ np.append(offset, 1.0))
    return np.mean(centers, axis=0) if centers else np.zeros(3)


def _round_inside(value: float, sampler: PositionSampler, index: int) -> float:
    """Return a value with few decimals, if the rounded value is within the limits."""
    limits = sampler.limits[index]
    rounded = round(value, _DECIMALS) + 0.0
    return rounded if limits.lower <= rounded <= limits.upper else value
