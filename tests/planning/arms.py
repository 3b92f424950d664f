"""A robot with six joints and a gripper, for tests of planning."""

from __future__ import annotations

from functools import cache

import numpy as np

from linkwright.descriptions.service import load
from linkwright.planning.collision_scene import AllowedCollisions
from linkwright.planning.groups import JointGroup, resolve_groups
from linkwright.planning.robot_model import RobotModel
from linkwright.planning.semantics import Semantics, read_semantics
from linkwright.planning.shapes import robot_shapes

_JOINTS = (
    ("pan", "base", "shoulder", "0 0 0.1", "0 0 1", 0.06, 0.1),
    ("lift", "shoulder", "upper_arm", "0 0 0.1", "0 1 0", 0.04, 0.3),
    ("elbow", "upper_arm", "forearm", "0 0 0.35", "0 1 0", 0.035, 0.25),
    ("roll", "forearm", "wrist", "0 0 0.3", "0 0 1", 0.03, 0.04),
    ("bend", "wrist", "palm", "0 0 0.06", "0 1 0", 0.03, 0.04),
    ("twist", "palm", "flange", "0 0 0.06", "0 0 1", 0.03, 0.03),
)


def urdf() -> str:
    """Return the URDF: links along z, joints that alternate between z and y, and a gripper with two fingers."""
    parts = ["<link name='base'><collision><geometry><box size='0.3 0.3 0.1'/></geometry></collision></link>"]
    for name, parent, child, xyz, axis, radius, length in _JOINTS:
        parts.append(
            f"<link name='{child}'><collision><origin xyz='0 0 {length / 2}'/><geometry>"
            f"<cylinder radius='{radius}' length='{length}'/></geometry></collision></link>"
            f"<joint name='{name}' type='revolute'><parent link='{parent}'/><child link='{child}'/>"
            f"<origin xyz='{xyz}'/><axis xyz='{axis}'/>"
            "<limit lower='-2.8' upper='2.8' effort='1' velocity='2'/></joint>"
        )
    parts.append(
        "<link name='tool'/><joint name='mount' type='fixed'><parent link='flange'/><child link='tool'/>"
        "<origin xyz='0 0 0.1'/></joint>"
    )
    for name, sign, mimic in (("left", 1, ""), ("right", -1, "<mimic joint='left'/>")):
        parts.append(
            f"<link name='{name}_finger'><collision><origin xyz='0 0 0.03'/><geometry><box size='0.01 0.01 0.06'/>"
            f"</geometry></collision></link><joint name='{name}' type='prismatic'><parent link='flange'/>"
            f"<child link='{name}_finger'/><origin xyz='0 {sign * 0.01} 0.04'/><axis xyz='0 {sign} 0'/>"
            f"<limit lower='0' upper='0.03' effort='1' velocity='0.1'/>{mimic}</joint>"
        )
    return f"<robot name='elbow_arm'>{''.join(parts)}</robot>"


SRDF = """<robot name='elbow_arm'>
  <virtual_joint name='fixed' type='fixed' parent_frame='world' child_link='base'/>
  <group name='arm'><chain base_link='base' tip_link='tool'/></group>
  <group name='gripper'><joint name='left'/><joint name='right'/></group>
  <group name='all'><group name='arm'/><group name='gripper'/></group>
  <group_state group='arm' name='ready'><joint name='lift' value='0.4'/><joint name='elbow' value='1.2'/></group_state>
  <group_state group='gripper' name='open'><joint name='left' value='0.03'/></group_state>
  <end_effector name='hand' parent_link='tool' group='gripper' parent_group='arm'/>
  <disable_collisions link1='base' link2='shoulder' reason='Adjacent'/>
  <disable_collisions link1='shoulder' link2='upper_arm' reason='Adjacent'/>
  <disable_collisions link1='upper_arm' link2='forearm' reason='Adjacent'/>
  <disable_collisions link1='forearm' link2='wrist' reason='Adjacent'/>
  <disable_collisions link1='wrist' link2='palm' reason='Adjacent'/>
  <disable_collisions link1='palm' link2='flange' reason='Adjacent'/>
  <disable_collisions link1='flange' link2='left_finger' reason='Adjacent'/>
  <disable_collisions link1='flange' link2='right_finger' reason='Adjacent'/>
  <disable_collisions link1='left_finger' link2='right_finger' reason='Adjacent'/>
</robot>"""

LIMITS = {name: {"has_acceleration_limits": True, "max_acceleration": 4.0} for name, *_ in _JOINTS}


class Arm:
    """The robot, read for planning."""

    def __init__(self) -> None:
        self.robot = load(urdf())
        self.semantics: Semantics = read_semantics(SRDF)
        self.model = RobotModel(self.robot)
        self.shapes, _ = robot_shapes(self.robot, None)  # type: ignore[arg-type]  # it has no meshes
        groups = resolve_groups(self.robot, self.semantics, self.model.joint_names, LIMITS)
        self.group: JointGroup = groups["arm"]
        self.groups = groups
        self.indexes = np.array([self.model.index(name) for name in self.group.joint_names])

    def allowed(self) -> AllowedCollisions:
        """Return the pairs that may collide."""
        return AllowedCollisions(dict.fromkeys(self.semantics.disabled_collisions, True))

    def positions(self, **joints: float) -> np.ndarray:
        """Return the positions of all joints; the rest of them is 0."""
        positions = np.zeros(len(self.model.joint_names))
        for name, position in joints.items():
            positions[self.model.index(name)] = position
        return positions


@cache
def arm() -> Arm:
    """Return the robot, which is read once."""
    return Arm()
