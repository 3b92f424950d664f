"""Groups of joints that are planned for together.

They are the groups of an SRDF, with the limits of their joints.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import inf, pi

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import Array
from linkwright.planning.semantics import GroupDefinition, Semantics
from linkwright.urdf import Joint, Robot, parent_joints

DEFAULT_MAX_VELOCITY = DEFAULT_MAX_ACCELERATION = 1.0
"""MoveIt's limits in rad/s and rad/s2, or m/s and m/s2, for joints without limits."""


@dataclass(frozen=True, slots=True)
class JointLimits:
    """The limits of a joint in rad or m, and their derivatives by time in s.

    Attributes:
        is_continuous: whether the joint turns without end; its bounds are then -pi and pi.
    """

    lower: float
    upper: float
    is_continuous: bool = False
    max_velocity: float = DEFAULT_MAX_VELOCITY
    max_acceleration: float = DEFAULT_MAX_ACCELERATION
    max_jerk: float = inf


def joint_limits(joint: Joint, overrides: Mapping[str, object] | None = None) -> JointLimits:
    """Return the limits of a joint.

    Args:
        joint: a moving joint. The soft limits of its ``safety_controller`` apply as well.
        overrides: the joint's entry in MoveIt's ``joint_limits.yaml``, which replaces the limits of the URDF.
    """
    limit, safety = joint.limit, joint.safety
    is_continuous = joint.type == "continuous"
    lower, upper = (-pi, pi) if is_continuous or limit is None else (limit.lower, limit.upper)
    if safety is not None and not is_continuous and safety.soft_lower_limit < safety.soft_upper_limit:
        lower, upper = max(lower, safety.soft_lower_limit), min(upper, safety.soft_upper_limit)
    velocity = limit.velocity if limit is not None and limit.velocity > 0.0 else DEFAULT_MAX_VELOCITY
    acceleration = limit.acceleration if limit is not None else None
    values = overrides or {}
    if values.get("has_position_limits") and not is_continuous:
        lower, upper = _number(values, "min_position", lower), _number(values, "max_position", upper)
    if values.get("has_velocity_limits"):
        velocity = _number(values, "max_velocity", velocity)
    acceleration = acceleration or DEFAULT_MAX_ACCELERATION
    if values.get("has_acceleration_limits"):
        acceleration = _number(values, "max_acceleration", acceleration)
    jerk = _number(values, "max_jerk", inf) if values.get("has_jerk_limits") else inf
    return JointLimits(lower, upper, is_continuous, velocity, acceleration, jerk if jerk > 0.0 else inf)


def _number(values: Mapping[str, object], name: str, default: float) -> float:
    value = values.get(name)
    return float(value) if isinstance(value, (int, float)) else default


@dataclass(frozen=True, slots=True, eq=False)
class JointGroup:
    """Joints that are planned for together; mimic joints of the group follow their leaders.

    Attributes:
        joint_names: the joints with a position of their own, parents before children.
        lower: the lower bounds in rad or m, shape (joints,).
        upper: the upper bounds in rad or m, shape (joints,).
        is_continuous: which joints turn without end, shape (joints,).
        is_rotating: which joints are revolute or continuous, shape (joints,).
        max_velocities: in rad/s or m/s, shape (joints,).
        max_accelerations: in rad/s2 or m/s2, shape (joints,).
        max_jerks: in rad/s3 or m/s3, shape (joints,); infinite for joints without a limit.
        links: the links that the joints of the group move directly, in the order of the joints.
        tip: the last link of a chain, or None for a group that is not a chain.
    """

    name: str
    joint_names: tuple[str, ...]
    lower: Array
    upper: Array
    is_continuous: NDArray[np.bool_]
    is_rotating: NDArray[np.bool_]
    max_velocities: Array
    max_accelerations: Array
    max_jerks: Array
    links: tuple[str, ...]
    tip: str | None

    def sample(self, random: np.random.Generator) -> Array:
        """Return random positions within the bounds, shape (joints,)."""
        return random.uniform(self.lower, self.upper)

    def unwind(self, positions: Array, reference: Array) -> Array:
        """Return the same configuration, moved by full turns toward a reference.

        The result is as near to the reference as the bounds allow.

        Args:
            positions: in rad or m, shape (joints,).
            reference: the positions to stay near to, shape (joints,).
        """
        turns = np.round((reference - positions) / (2 * pi))
        fewest, most = np.ceil((self.lower - positions) / (2 * pi)), np.floor((self.upper - positions) / (2 * pi))
        turns = np.where(self.is_continuous, turns, np.clip(turns, np.minimum(fewest, 0.0), np.maximum(most, 0.0)))
        unwound: Array = positions + np.where(self.is_rotating, turns * 2 * pi, 0.0)
        return unwound

    def satisfies_bounds(self, positions: Array, tolerance: float = 1e-6) -> bool:
        """Return whether positions are within the bounds; continuous joints always are."""
        is_inside = (positions >= self.lower - tolerance) & (positions <= self.upper + tolerance)
        return bool(np.all(is_inside | self.is_continuous))


def resolve_groups(
    robot: Robot,
    semantics: Semantics,
    joint_order: Iterable[str],
    limits: Mapping[str, Mapping[str, object]] | None = None,
) -> dict[str, JointGroup]:
    """Return the groups of an SRDF by name, without groups that move no joint.

    Args:
        robot: the robot of the SRDF.
        semantics: the contents of the SRDF, with known names, see `leave_out_unknown_names`.
        joint_order: the joints with a position of their own, parents before children.
        limits: the entries of ``joint_limits`` in MoveIt's ``joint_limits.yaml``, by joint name.
    """
    order = {name: index for index, name in enumerate(joint_order)}
    groups: dict[str, JointGroup] = {}
    for definition in semantics.groups.values():
        joints = _find_joints(robot, semantics, definition)
        names = sorted((name for name in joints if name in order), key=order.__getitem__)
        if not names:
            continue
        all_limits = [joint_limits(robot.joints[name], (limits or {}).get(name)) for name in names]
        groups[definition.name] = JointGroup(
            definition.name,
            tuple(names),
            np.array([limit.lower for limit in all_limits]),
            np.array([limit.upper for limit in all_limits]),
            np.array([limit.is_continuous for limit in all_limits]),
            np.array([robot.joints[name].type != "prismatic" for name in names]),
            np.array([limit.max_velocity for limit in all_limits]),
            np.array([limit.max_acceleration for limit in all_limits]),
            np.array([limit.max_jerk for limit in all_limits]),
            tuple(robot.joints[name].child for name in names),
            _find_tip(robot, definition, joints),
        )
    return groups


def _find_joints(robot: Robot, semantics: Semantics, definition: GroupDefinition) -> dict[str, None]:
    """Return the names of a group's joints as the keys of a dictionary.

    Fixed joints are included, and virtual joints are not.
    """
    parents = parent_joints(robot)
    joints = {name: None for name in definition.joints if name in robot.joints}
    joints.update((parents[name].name, None) for name in definition.links if name in parents)
    for base, tip in definition.chains:
        joints.update(dict.fromkeys(_chain_joints(parents, base, tip)))
    for name in definition.subgroups:
        joints.update(_find_joints(robot, semantics, semantics.groups[name]))
    return joints


def _chain_joints(parents: Mapping[str, Joint], base: str, tip: str) -> list[str]:
    """Return the joints from the base link to the tip link."""
    names: list[str] = []
    link = tip
    while link != base and link in parents:
        names.append(parents[link].name)
        link = parents[link].parent
    return names[::-1]


def _find_tip(robot: Robot, definition: GroupDefinition, joints: Mapping[str, None]) -> str | None:
    """Return the last link of a group whose joints form one chain, or None."""
    if len(definition.chains) == 1:
        return definition.chains[0][1]
    children = {robot.joints[name].child for name in joints}
    parents = [robot.joints[name].parent for name in joints]
    tips = children.difference(parents)
    return tips.pop() if len(tips) == 1 and len(set(parents)) == len(parents) else None
