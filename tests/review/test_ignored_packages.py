"""The lines of a review about packages that build tools skip."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

MANIFEST = "parts/arm/package.xml"
FILES = {MANIFEST: PACKAGE_XML, "leg/package.xml": PACKAGE_XML.replace("arm", "leg")}


@pytest.mark.parametrize("marker", ["parts/arm/COLCON_IGNORE", "parts/CATKIN_IGNORE", "parts/AMENT_IGNORE"])
def test_a_package_that_is_no_longer_built_is_breaking(repository, compare, marker):
    repository.commit(FILES)
    repository.write({marker: ""})
    result = compare(repository)
    assert breaking(result) == [f"no longer built, because of '{marker}'"]
    assert sentences(subject(result, MANIFEST)) == breaking(result)
    assert list(result.other_files) == []


def test_a_package_that_is_built_now_is_told(repository, compare):
    repository.commit({**FILES, "parts/COLCON_IGNORE": ""})
    repository.write({"parts/COLCON_IGNORE": None})
    result = compare(repository)
    assert sentences(subject(result, MANIFEST)) == ["built now, without 'parts/COLCON_IGNORE'"]
    assert breaking(result) == []


def test_a_second_marker_and_one_beside_an_added_package_change_nothing(repository, compare):
    repository.commit({**FILES, "parts/COLCON_IGNORE": ""})
    repository.write({"parts/arm/COLCON_IGNORE": "", "leg/toe/COLCON_IGNORE": "", "leg/toe/a.txt": ""})
    repository.write({"foot/package.xml": PACKAGE_XML.replace("arm", "foot"), "foot/COLCON_IGNORE": ""})
    assert breaking(compare(repository)) == []


LAUNCH = """from launch import LaunchDescription
from launch_ros.actions import Node
from ament_index_python.packages import get_package_share_directory
import os


def generate_launch_description():
    path = os.path.join(get_package_share_directory("arm_description"), "config", "arm.yaml")
    return LaunchDescription([Node(package="arm", executable="arm", parameters=[path])])
"""


@pytest.mark.parametrize(("marker", "is_breaking"), [("parts/COLCON_IGNORE", False), ("leg/COLCON_IGNORE", True)])
def test_lost_file_of_a_package_that_was_not_built_breaks_only_its_users(repository, compare, marker, is_breaking):
    path = "parts/arm/config/arm.yaml"
    repository.commit({**FILES, marker: "", path: "arm:\n  ros__parameters:\n    a: 1\n"})
    repository.commit({"parts/arm/launch/arm.launch.py": LAUNCH})
    repository.write({marker: None, path: None})
    found = breaking(compare(repository))
    assert any(line.startswith("parameter file removed") for line in found) == is_breaking
    assert "names 'config/arm.yaml' of 'arm_description', which no longer exists" in found


ROBOT = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="side" default="left"/>
  <xacro:property name="side" value="$(arg side)"/>
  <link name="base"/>
  <link name="${side}_arm"/>
  <joint name="${side}_joint" type="revolute">
    <parent link="base"/> <child link="${side}_arm"/>
    <limit lower="0" upper="${radians(180)}" effort="1" velocity="1"/>
  </joint>
</robot>
"""
WORLD = '<sdf version="1.9"><world name="w"><model name="box"><link name="a"/></model></world></sdf>'


@pytest.mark.parametrize("marker", ["CATKIN_IGNORE", "parts/COLCON_IGNORE", "parts/arm/COLCON_IGNORE"])
def test_changed_descriptions_of_packages_that_are_not_built_are_expanded(repository, compare, marker):
    robot, world = "parts/arm/urdf/arm.urdf.xacro", "parts/arm/worlds/a.world"
    repository.commit({**FILES, marker: "", robot: ROBOT, world: WORLD})
    repository.write({robot: ROBOT.replace("180", "90"), world: WORLD.replace('"a"', '"b"')})
    result = compare(repository)
    assert sentences(subject(result, robot)) == ["joint 'left_joint': limit upper 3.14159265 -> 1.57079633 rad"]
    assert breaking(result) == sentences(subject(result, robot))
    assert "world w model box link a removed" in sentences(subject(result, world))
