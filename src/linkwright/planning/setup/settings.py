"""The settings from which the files of a configuration package are written."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

from linkwright.packages.creation.request import Maintainer
from linkwright.planning.setup.collision_pairs import CollisionPairs
from linkwright.planning.setup.gazebo import GazeboSettings
from linkwright.planning.setup.groups import RobotGroups
from linkwright.planning.setup.named_states import States
from linkwright.planning.setup.srdf import VirtualJointSettings
from linkwright.urdf import Robot


@dataclass(frozen=True, slots=True)
class DescriptionSource:
    """The file of the robot description.

    Attributes:
        package: the package that contains the file; empty if the configuration package gets a copy.
        path: the path of the file in the package.
        arguments: the values of its xacro arguments.
        text: the expanded description, for the copy.
    """

    package: str
    path: str
    arguments: Mapping[str, str]
    text: str


@dataclass(frozen=True, slots=True)
class PackageSettings:
    """The contents of a configuration package.

    Attributes:
        name: the name of the package.
        robot: the robot.
        source: the file of its description.
        groups: its groups.
        states: their named states.
        pairs: the pairs of links whose collisions are not checked.
        virtual_joint: the joint to the frame in which the robot is placed, or None.
        start_positions: the positions at which the demo starts, by joint.
        simulated_joints: the joints that get interfaces of ros2_control with simulated hardware.
        gazebo: the settings for Gazebo.
        maintainer: the maintainer of the package.
        license: the text for ``<license>``.
        distribution: the distribution of ROS 2, ``humble`` or ``jazzy``, whose format planning pipelines have.
    """

    name: str
    robot: Robot
    source: DescriptionSource
    groups: RobotGroups
    states: States
    pairs: CollisionPairs
    virtual_joint: VirtualJointSettings | None
    start_positions: Mapping[str, float]
    simulated_joints: tuple[str, ...]
    gazebo: GazeboSettings
    maintainer: Maintainer
    license: str
    distribution: str

    @property
    def file_name(self) -> str:
        """The name of the robot in names of files."""
        return file_name(self.robot.name)


def file_name(robot_name: str) -> str:
    """Return the name of a robot with characters that are usual in names of files."""
    return re.sub(r"[^A-Za-z0-9_.-]+", "_", robot_name).strip("_.") or "robot"
