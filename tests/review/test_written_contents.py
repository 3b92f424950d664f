"""The lines of a review about what is written in added descriptions and macros."""

from __future__ import annotations

from tests.review.conftest import sentences, subject

ROOT = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"{}>{}</robot>'
HARDWARE = """<ros2_control name="Arm" type="system">
  <hardware><plugin>arm_hardware/Arm</plugin></hardware>
  <joint name="a"><command_interface name="position"><param name="min">-1</param><param name="max">1</param>
    </command_interface><state_interface name="position"/><state_interface name="velocity"/></joint>
  <joint name="b"><command_interface name="position"><param name="min">-1</param><param name="max">1</param>
    </command_interface><state_interface name="position"/><state_interface name="velocity"/></joint>
  <joint name="c"><state_interface name="position"/></joint>
  <sensor name="imu"/>
</ros2_control>"""
DEVICES = """<webots>
  <device reference="ps0" type="DistanceSensor"><ros><topicName>/ps0</topicName></ros></device>
  <device reference="front camera" type="Camera"><ros><topicName>/camera</topicName></ros></device>
  <device reference="led"/>
  <plugin type="webots_ros2_control::Ros2Control"/>
</webots>"""
MACRO = """<xacro:macro name="gripper" params="parent">
  <link name="palm"/><link name="finger"/><link name="other"/>
  <joint name="palm_joint" type="fixed"><parent link="${parent}"/><child link="palm"/><axis xyz="0 1 0"/></joint>
  <joint name="finger_joint" type="prismatic"><parent link="palm"/><child link="finger"/>
    <axis xyz="0 1 0"/><limit lower="-0.001" upper="${width / 2}" effort="1" velocity="1"/></joint>
  <joint name="other_joint" type="revolute"><parent link="palm"/><child link="other"/>
    <mimic joint="finger_joint"/></joint>
</xacro:macro>"""


def test_an_added_part_shows_its_hardware_with_the_interfaces_of_its_joints(package, compare):
    path = "arm_description/urdf/hardware.xacro"
    package.write({path: ROOT.format("", HARDWARE)})
    contents = (
        "ros2_control Arm (plugin arm_hardware/Arm, joints a, b: commands position [-1, 1], states position, "
        "velocity, joints c: states position, sensors imu)"
    )
    assert sentences(subject(compare(package), path)) == ["description file added", f"contains {contents}"]


def test_an_added_part_shows_the_topics_of_the_devices_of_webots(package, compare):
    path = "arm_description/urdf/webots.urdf"
    package.write({path: ROOT.format(' name="robot"', DEVICES)})
    assert sentences(subject(compare(package), path)) == [
        "description file added",
        "contains webots (3 devices: /ps0, front camera (/camera), led, plugin 'webots_ros2_control::Ros2Control')",
    ]


def test_an_added_macro_shows_how_its_joints_move_and_who_else_defines_it(package, compare):
    path, other = "arm_description/urdf/gripper_v2.xacro", "arm_description/urdf/gripper_v1.xacro"
    package.commit({other: ROOT.format("", MACRO)})
    package.write({path: ROOT.format("", MACRO)})
    contents = (
        "parameters parent; makes link palm, link finger, link other, joint palm_joint, "
        "joint finger_joint (prismatic, axis 0 1 0, limits -0.001 to ${width / 2}), "
        "joint other_joint (revolute, mimics finger_joint)"
    )
    line = f"macro 'gripper' added: {contents}; also defined by {other}"
    assert sentences(subject(compare(package), path)) == ["description file added", line]


def test_a_robot_that_can_be_read_now_is_shown_without_a_package_that_is_missing(package, compare):
    path, part = "arm_description/urdf/robot.urdf.xacro", "arm_description/urdf/part.xacro"
    robot = ROOT.format(' name="robot"', '<xacro:include filename="part.xacro"/><link name="base"/>')
    gazebo = (
        '<gazebo><plugin filename="libx.so" name="x"><parameters>$(find absent)/a.yaml</parameters></plugin></gazebo>'
    )
    package.commit({path: robot})
    package.write({part: ROOT.format("", gazebo)})
    first, second = sentences(subject(compare(package), path))
    assert first.startswith("can be read now; in the old version: ")
    assert second == "robot 'robot': 1 link (base), plugins x"
