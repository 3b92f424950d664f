"""A small arm of two files, for tests of the page.

It has masses, limits, a prismatic joint and a mimic joint.
"""

from __future__ import annotations

from pathlib import Path

_ARM = """\
<?xml version="1.0"?>
<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:include filename="segment.xacro"/>
  <link name="base">
    <visual><origin xyz="0 0 0.05"/><geometry><cylinder radius="0.15" length="0.1"/></geometry></visual>
    <collision><origin xyz="0 0 0.05"/><geometry><box size="0.32 0.32 0.1"/></geometry></collision>
    <inertial>
      <origin xyz="0 0 0.05"/>
      <mass value="4"/>
      <inertia ixx="0.03" ixy="0" ixz="0" iyy="0.03" iyz="0" izz="0.045"/>
    </inertial>
  </link>
  <xacro:segment name="upper" parent="base" z="0.1" axis="0 1 0" lower="-2" upper="2" length="0.4" mass="2"/>
  <xacro:segment name="fore" parent="upper" z="0.4" axis="0 1 0" lower="-0.5" upper="2" length="0.3" mass="1"
                 scale="40"/>
  <link name="slide"><visual><geometry><box size="0.2 0.06 0.06"/></geometry></visual></link>
  <joint name="slide_joint" type="prismatic">
    <parent link="fore"/><child link="slide"/><origin xyz="0 0 0.33"/>
    <axis xyz="1 0 0"/><limit lower="-0.1" upper="0.2" velocity="0.2" effort="20"/>
  </joint>
  <link name="finger"><visual><geometry><box size="0.02 0.05 0.12"/></geometry></visual></link>
  <joint name="finger_joint" type="prismatic">
    <parent link="slide"/><child link="finger"/><origin xyz="0 0 0.09"/>
    <axis xyz="1 0 0"/><limit lower="-0.1" upper="0.1" velocity="0.2" effort="20"/>
    <mimic joint="slide_joint" multiplier="-0.5" offset="0.01"/>
  </joint>
</robot>
"""
_SEGMENT = """\
<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="segment" params="name parent z axis lower upper length mass scale:=1">
    <link name="${name}">
      <visual>
        <origin xyz="0 0 ${length/2}"/>
        <geometry><cylinder radius="0.04" length="${length}"/></geometry>
      </visual>
      <collision>
        <origin xyz="0 0 ${length/2}"/>
        <geometry><cylinder radius="0.06" length="${length}"/></geometry>
      </collision>
      <inertial>
        <origin xyz="0 0 ${length/2}"/>
        <mass value="${mass}"/>
        <inertia ixx="${scale*mass*length**2/12}" ixy="0" ixz="0"
                 iyy="${scale*mass*length**2/12}" iyz="0" izz="${mass*0.0008}"/>
      </inertial>
    </link>
    <joint name="${name}_joint" type="revolute">
      <parent link="${parent}"/>
      <child link="${name}"/>
      <origin xyz="0 0 ${z}"/>
      <axis xyz="${axis}"/>
      <limit lower="${lower}" upper="${upper}" velocity="1.5" effort="30"/>
      <dynamics damping="0.4" friction="0.1"/>
    </joint>
  </xacro:macro>
</robot>
"""
SEGMENT_LINK = (3, 18)
"""The first and last line of the macro's link in its file."""
SEGMENT_JOINT = (19, 26)
"""The first and last line of the macro's joint in its file."""


def write_arm(folder: Path) -> Path:
    """Write the arm's files, and return the main one; it includes ``segment.xacro``."""
    (folder / "segment.xacro").write_text(_SEGMENT, encoding="utf-8")
    (folder / "arm.xacro").write_text(_ARM, encoding="utf-8")
    return folder / "arm.xacro"
