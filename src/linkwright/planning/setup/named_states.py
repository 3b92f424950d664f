"""Chooses named states for groups: ``home`` for arms, ``open`` and ``close`` for grippers."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.planning.collision_scene import CollisionScene
from linkwright.planning.robot_model import Shapes
from linkwright.planning.setup.collision_pairs import CollisionPairs
from linkwright.planning.setup.gripper_states import open_and_close
from linkwright.planning.setup.groups import PlanningGroup, RobotGroups
from linkwright.planning.setup.position_sampler import PositionSampler
from linkwright.urdf import Robot

States = dict[str, dict[str, dict[str, float]]]
"""The joint positions in rad or m, by group, name of the state, and joint."""

HOME, OPEN, CLOSE = "home", "open", "close"
_ATTEMPTS = 1000
_SEED = 0
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
            opened, closed = open_and_close(robot, shapes, group, sampler, positions)
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


def _round_inside(value: float, sampler: PositionSampler, index: int) -> float:
    """Return a value with few decimals, if the rounded value is within the limits."""
    limits = sampler.limits[index]
    rounded = round(value, _DECIMALS) + 0.0
    return rounded if limits.lower <= rounded <= limits.upper else value
