"""The robot, its groups and their bounds (``moveit.core.robot_model``)."""

from __future__ import annotations

import logging
import threading
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from linkwright.descriptions.service import load
from linkwright.geometry.arrays import Array
from linkwright.planning.groups import JointGroup, resolve_groups
from linkwright.planning.known_names import leave_out_unknown_names
from linkwright.planning.robot_model import RobotModel as MovedRobot
from linkwright.planning.semantics import Semantics, read_semantics
from linkwright.urdf import Robot

_log = logging.getLogger(__name__)


class VariableBounds(NamedTuple):
    """The bounds of a joint, in rad or m, and their derivatives by time in s."""

    min_position: float
    max_position: float
    position_bounded: bool
    min_velocity: float
    max_velocity: float
    velocity_bounded: bool
    min_acceleration: float
    max_acceleration: float
    acceleration_bounded: bool
    min_jerk: float = 0.0
    max_jerk: float = 0.0
    jerk_bounded: bool = False


class JointModelGroup:
    """A group of the SRDF.

    Args:
        group: the joints of the group.
        end_effector: the name of the end effector with this group; empty if there is none.
    """

    def __init__(self, group: JointGroup, end_effector: str) -> None:
        self._group = group
        self._end_effector = end_effector

    @property
    def name(self) -> str:
        """The name of the group."""
        return self._group.name

    @property
    def joint_model_names(self) -> list[str]:
        """The joints that have a position of their own."""
        return list(self._group.joint_names)

    @property
    def active_joint_model_names(self) -> list[str]:
        """The joints that have a position of their own."""
        return list(self._group.joint_names)

    @property
    def link_model_names(self) -> list[str]:
        """The links that these joints move directly."""
        return list(self._group.links)

    @property
    def eef_name(self) -> str:
        """The name of the end effector with this group; empty if there is none."""
        return self._end_effector

    @property
    def active_joint_model_bounds(self) -> list[list[VariableBounds]]:
        """The bounds of each joint, in a list for each joint."""
        group = self._group
        return [
            [
                VariableBounds(
                    float(group.lower[index]),
                    float(group.upper[index]),
                    not group.is_continuous[index],
                    -float(group.max_velocities[index]),
                    float(group.max_velocities[index]),
                    True,
                    -float(group.max_accelerations[index]),
                    float(group.max_accelerations[index]),
                    True,
                )
            ]
            for index in range(len(group.joint_names))
        ]

    def satisfies_position_bounds(self, values: Sequence[float], margin: float = 0.0) -> bool:
        """Return whether positions are within the bounds.

        Args:
            values: in rad or m, shape (joints,).
            margin: the distance from the bounds that is still accepted.
        """
        return self._group.satisfies_bounds(np.asarray(values, dtype=np.float64), margin)


class RobotModel:
    """A robot with the groups of its SRDF.

    Args:
        urdf_xml_path: the URDF file.
        srdf_xml_path: the SRDF file.

    Raises:
        LinkwrightError: the URDF has errors, or the SRDF is not XML.
    """

    def __init__(self, urdf_xml_path: str, srdf_xml_path: str) -> None:
        robot = load(Path(urdf_xml_path).read_text(encoding="utf-8"))
        semantics = read_semantics(Path(srdf_xml_path).read_text(encoding="utf-8"), srdf_xml_path)
        semantics = leave_out_unknown_names(semantics, robot)
        for problem in semantics.problems:
            _log.error(problem.message)
        self._set(robot, semantics, None)

    @classmethod
    def from_parts(cls, robot: Robot, semantics: Semantics, groups: dict[str, JointGroup]) -> RobotModel:
        """Return the model of a robot that was read already."""
        model = cls.__new__(cls)
        model._set(robot, semantics, groups)
        return model

    def _set(self, robot: Robot, semantics: Semantics, groups: dict[str, JointGroup] | None) -> None:
        self.robot, self.semantics = robot, semantics
        self.moved = MovedRobot(robot)
        """The robot in MuJoCo; a thread that moves it holds `lock`."""
        self.lock = threading.RLock()
        self.groups = resolve_groups(robot, semantics, self.moved.joint_names) if groups is None else groups

    @property
    def name(self) -> str:
        """The name of the robot."""
        return self.robot.name

    @property
    def model_frame(self) -> str:
        """The frame in which the robot's root link is placed."""
        return next(
            (
                joint.parent_frame
                for joint in self.semantics.virtual_joints
                if joint.child_link == self.robot.root and joint.type != "fixed"
            ),
            self.robot.root,
        )

    @property
    def root_joint_name(self) -> str:
        """The name of the virtual joint of the root link."""
        return next(
            (joint.name for joint in self.semantics.virtual_joints if joint.child_link == self.robot.root),
            "ASSUMED_FIXED_ROOT_JOINT",
        )

    @property
    def joint_model_group_names(self) -> list[str]:
        """The names of the groups."""
        return list(self.groups)

    @property
    def joint_model_groups(self) -> list[JointModelGroup]:
        """The groups."""
        return [self._wrap(group) for group in self.groups.values()]

    @property
    def end_effectors(self) -> list[JointModelGroup]:
        """The groups of the end effectors."""
        names = {effector.group for effector in self.semantics.end_effectors}
        return [self._wrap(group) for name, group in self.groups.items() if name in names]

    def has_joint_model_group(self, joint_model_group_name: str) -> bool:
        """Return whether there is a group of this name."""
        return joint_model_group_name in self.groups

    def get_joint_model_group(self, joint_model_group_name: str) -> JointModelGroup | None:
        """Return a group, or None if there is no group of this name."""
        group = self.groups.get(joint_model_group_name)
        return None if group is None else self._wrap(group)

    def group(self, name: str) -> JointGroup:
        """Return the joints of a group.

        Raises:
            ValueError: there is no such group.
        """
        if name not in self.groups:
            raise ValueError(f"the robot has no group '{name}'; it has {', '.join(self.groups)}")
        return self.groups[name]

    def indexes(self, group: JointGroup) -> Array:
        """Return the places of a group's joints among the positions of all joints."""
        return np.array([self.moved.index(name) for name in group.joint_names])

    def _wrap(self, group: JointGroup) -> JointModelGroup:
        effectors = (item.name for item in self.semantics.end_effectors if item.group == group.name)
        return JointModelGroup(group, next(effectors, ""))
