"""Launch files that still pass an argument which a description has lost."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences, subject

ARGUMENT = '<xacro:arg name="prefix" default=""/>'
ROBOT = f"""<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
{ARGUMENT}
<link name="$(arg prefix)base"/>
</robot>
"""
LAUNCH = """from launch import LaunchDescription
from launch.substitutions import Command
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    robot = Command(['xacro ', FindPackageShare('arm_description'), '/urdf/arm.urdf.xacro', ' ', 'prefix:=', 'left_'])
    return LaunchDescription([
        Node(package='robot_state_publisher', executable='robot_state_publisher',
             parameters=[{'robot_description': robot}]),
    ])
"""
ROBOT_PATH, LAUNCH_PATH = "arm_description/urdf/arm.urdf.xacro", "arm_description/launch/arm.launch.py"
LINE = f"passes 'prefix' to '{ROBOT_PATH}', which no longer has the argument"


@pytest.fixture
def find_lines(repository, compare):
    """Review two versions of a description, and return the lines about the launch file."""

    def run(old: str, new: str, path: str = LAUNCH_PATH) -> list[str]:
        repository.commit({"arm_description/package.xml": PACKAGE_XML, ROBOT_PATH: old, path: LAUNCH})
        repository.write({ROBOT_PATH: new})
        result = compare(repository)
        paths = [found.path for found in result.subjects]
        return sentences(subject(result, path)) if path in paths else []

    return run


def test_launch_file_that_passes_a_removed_argument_is_named(find_lines):
    assert find_lines(ROBOT, ROBOT.replace(ARGUMENT, "").replace("$(arg prefix)", "")) == [LINE]


def test_argument_that_an_included_file_declares_is_not_lost(repository, find_lines):
    included = f'<robot xmlns:xacro="http://www.ros.org/wiki/xacro">{ARGUMENT}</robot>'
    repository.write({"arm_description/urdf/arguments.xacro": included})
    include = '<xacro:include filename="arguments.xacro"/>'
    assert find_lines(ROBOT, ROBOT.replace(ARGUMENT, include)) == []


def test_argument_without_effect_and_launch_file_of_a_test_break_nobody(find_lines):
    unused = ROBOT.replace("$(arg prefix)", "")
    assert find_lines(unused, unused.replace(ARGUMENT, "")) == []
    new = ROBOT.replace(ARGUMENT, "").replace("$(arg prefix)", "")
    assert find_lines(ROBOT, new, "arm_description/test/arm.launch.py") == []


ROS1_LAUNCH = """<launch>
  <arg name="model" default="arm.urdf.xacro"/>
  <arg name="gpu" default="false"/>
  <param name="robot_description" command="$(find xacro)/xacro '$(find arm_description)/urdf/$(arg model)' {}"/>
</launch>
"""
ROS1_PATH = "arm_description/launch/arm.launch"
NEW_LINE = f"passes 'gpu' to '{ROBOT_PATH}', which has no such argument"


@pytest.mark.parametrize(
    ("robot", "expected"),
    [
        (ROBOT, NEW_LINE),
        (ROBOT.replace('prefix" default', 'use_gpu" default'), f"{NEW_LINE}, but 'use_gpu'"),
        (ROBOT.replace(ARGUMENT, f'{ARGUMENT}<xacro:arg name="gpu" default="true"/>'), None),
        (ROBOT.replace("base", "$(arg gpu)"), None),
        (ROBOT.replace(ARGUMENT, f'<xacro:include filename="$(find gears)/urdf/gears.xacro"/>{ARGUMENT}'), None),
    ],
)
@pytest.mark.parametrize("path", [ROS1_PATH, LAUNCH_PATH])
def test_argument_that_a_description_does_not_have(repository, compare, robot, expected, path):
    """A file of a package that is not there may declare it."""
    old, new = ROS1_LAUNCH.format("prefix:=left_"), ROS1_LAUNCH.format("prefix:=left_ gpu:=$(arg gpu)")
    old = old.replace('  <arg name="gpu" default="false"/>\n', "")
    if path == LAUNCH_PATH:
        old, new = LAUNCH, LAUNCH.replace("'left_'", "'left_', ' gpu:=true'")
    repository.commit({"arm_description/package.xml": PACKAGE_XML, ROBOT_PATH: robot, path: old})
    repository.write({path: new})
    assert [line for line in sentences(subject(compare(repository), path)) if "passes" in line] == (
        [] if expected is None else [expected]
    )


def test_argument_that_was_passed_before_is_not_told(repository, compare):
    text = ROS1_LAUNCH.format("gpu:=$(arg gpu)")
    repository.commit({"arm_description/package.xml": PACKAGE_XML, ROBOT_PATH: ROBOT, ROS1_PATH: text})
    repository.write({ROS1_PATH: text.replace('"false"', '"true"')})
    assert not [line for line in sentences(subject(compare(repository), ROS1_PATH)) if "passes" in line]
