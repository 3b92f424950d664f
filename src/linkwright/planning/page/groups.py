"""The planning groups of a robot, with their named states and handles."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from random import Random

from linkwright.page.protocol.motion_planning import JointKind
from linkwright.planning.groups import JointGroup, resolve_groups
from linkwright.planning.semantics import Semantics
from linkwright.urdf import Robot

_MIN_HANDLE_JOINTS = 2
"""A group with a handle has at least this many joints."""

_TOLERANCE = 1e-4
"""The distance in rad or m by which a position may exceed a limit."""


@dataclass(frozen=True, slots=True)
class GroupJoint:
    """A joint of a planning group.

    Attributes:
        child: the link that the joint moves directly.
        lower: the lower limit in rad or m; -pi for continuous joints.
        upper: the upper limit in rad or m; pi for continuous joints.
    """

    name: str
    kind: JointKind
    child: str
    lower: float
    upper: float

    def is_within(self, position: float) -> bool:
        """Return whether a position is within the limits; continuous joints have none."""
        return self.kind == "continuous" or self.lower - _TOLERANCE <= position <= self.upper + _TOLERANCE


@dataclass(frozen=True, slots=True)
class Tip:
    """A link that is dragged with a handle, and the group whose inverse kinematics moves it."""

    link: str
    group: str


@dataclass(frozen=True, slots=True)
class PlanningGroup:
    """A group of joints that are planned for together.

    Attributes:
        states: the positions of the named states in rad or m, by state and joint.
        tips: the links with handles.
    """

    name: str
    joints: tuple[GroupJoint, ...]
    states: Mapping[str, Mapping[str, float]]
    tips: tuple[Tip, ...]

    @property
    def joint_names(self) -> frozenset[str]:
        """The names of the joints."""
        return frozenset(joint.name for joint in self.joints)

    def sample(self, random: Random) -> dict[str, float]:
        """Return random positions within the limits, in rad or m."""
        return {joint.name: random.uniform(joint.lower, joint.upper) for joint in self.joints}


def read_groups(robot: Robot, semantics: Semantics, joint_order: Sequence[str]) -> dict[str, PlanningGroup]:
    """Return the planning groups of a robot by name, without groups that move no joint.

    Args:
        robot: the robot.
        semantics: its SRDF, with known names.
        joint_order: the joints with a position of their own, parents before children.
    """
    groups = resolve_groups(robot, semantics, joint_order)
    return {
        name: PlanningGroup(
            name,
            tuple(_make_joint(robot, group, index) for index in range(len(group.joint_names))),
            {
                state: {joint: value for joint, value in positions.items() if joint in group.joint_names}
                for state, positions in semantics.states.get(name, {}).items()
            },
            tuple(_find_tips(groups, semantics, name)),
        )
        for name, group in groups.items()
    }


def _make_joint(robot: Robot, group: JointGroup, index: int) -> GroupJoint:
    joint = robot.joints[group.joint_names[index]]
    kind: JointKind = (
        "continuous" if group.is_continuous[index] else "prismatic" if joint.type == "prismatic" else "revolute"
    )
    lower, upper = float(group.lower[index]), float(group.upper[index])
    is_bounded = math.isfinite(lower) and math.isfinite(upper) and lower <= upper
    return GroupJoint(joint.name, kind, joint.child, *((lower, upper) if is_bounded else (-math.pi, math.pi)))


def _find_tips(groups: Mapping[str, JointGroup], semantics: Semantics, name: str) -> list[Tip]:
    """Return the tip of a chain, at the link of its end effector if it has one, or the tips of the subgroups."""
    group = groups[name]
    if any(effector.group == name for effector in semantics.end_effectors):
        return []
    if group.tip is not None:
        if len(group.joint_names) < _MIN_HANDLE_JOINTS:
            return []
        links = (effector.parent_link for effector in semantics.end_effectors if effector.parent_group == name)
        return [Tip(next(links, group.tip), name)]
    subgroups = semantics.groups[name].subgroups if name in semantics.groups else ()
    return [tip for subgroup in subgroups if subgroup in groups for tip in _find_tips(groups, semantics, subgroup)]
