"""The first use of things that most checks need, made once in the server from which checks are forked.

Readers of descriptions, classes of messages and catalogs of translations are made when they are first used. Made here,
they are shared by all checks.
"""

from __future__ import annotations

from pathlib import Path

from linkwright.diagnostics.translation.translate import LANGUAGES, load_catalog
from linkwright.files.scratch_folders import ScratchFolder
from linkwright.testing import SteppedSimulation

_ROBOT = """<?xml version="1.0"?>
<robot name="robot" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="height" value="0.2"/>
  <xacro:macro name="weight" params="mass">
    <inertial>
      <origin xyz="0 0 0" rpy="0 0 0"/>
      <mass value="${mass}"/>
      <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/>
    </inertial>
  </xacro:macro>
  <material name="gray"><color rgba="0.5 0.5 0.5 1"/></material>
  <link name="base_link">
    <visual>
      <origin xyz="0 0 0" rpy="0 0 0"/>
      <geometry><cylinder radius="0.2" length="${height / 2}"/></geometry>
      <material name="gray"/>
    </visual>
    <collision><geometry><box size="0.2 0.2 ${height / 2}"/></geometry></collision>
    <xacro:weight mass="1"/>
  </link>
  <joint name="wheel_joint" type="continuous">
    <parent link="base_link"/>
    <child link="wheel"/>
    <origin xyz="0 0 0" rpy="0 0 0"/>
    <axis xyz="0 1 0"/>
    <limit lower="0" upper="0" effort="1" velocity="1"/>
  </joint>
  <link name="wheel">
    <collision><geometry><sphere radius="0.1"/></geometry></collision>
    <xacro:weight mass="0.1"/>
  </link>
  <gazebo reference="wheel"><mu1>1</mu1></gazebo>
  <gazebo>
    <plugin filename="gz-sim-joint-state-publisher-system" name="gz::sim::systems::JointStatePublisher"/>
  </gazebo>
</robot>
"""


def prepare() -> None:
    """Read a description, simulate it for a moment, and load the catalogs."""
    for language in LANGUAGES:
        load_catalog(language)
    with ScratchFolder("preparation") as folder:
        robot = Path(folder) / "robot.urdf.xacro"
        robot.write_text(_ROBOT, encoding="utf-8")
        with SteppedSimulation("empty", robot, robot_state_publisher=True) as test:
            test.drive(0.0)
            test.advance(0.1)
