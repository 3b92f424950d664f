"""Reviews of launch files that could not start before."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

BUILD = """cmake_minimum_required(VERSION 3.8)
project(arm_description)
find_package(ament_cmake REQUIRED)
add_executable(talker src/talker.cpp)
install(TARGETS talker DESTINATION lib/${PROJECT_NAME})
install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})
ament_package()
"""
PYTHON = """from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    actions = LaunchDescription()
    actions.add_action({action})
    actions.add_action(Node(package="other", executable="driver"))
    return actions
"""
INCLUDE = (
    'IncludeLaunchDescription(PythonLaunchDescriptionSource([FindPackageShare("{package}"), "/launch/{file}"]){rest})'
)
NODE = "node 'other/driver' removed"
DRIVER = '    actions.add_action(Node(package="other", executable="driver"))\n'
PART = "arm_description/launch/part.launch.py"
LAUNCH = "arm_description/launch/arm.launch.py"
TALKER = 'Node(package="arm_description", executable="{name}")'


def include(package: str, file: str, rest: str = "") -> str:
    return INCLUDE.format(package=package, file=file, rest=rest)


@pytest.mark.parametrize(
    ("action", "reason"),
    [
        (
            include("arm_description", "slam.launch.py"),
            "the package 'arm_description' has no file 'launch/slam.launch.py'",
        ),
        (include("ros_gz_sim", "gazebo.launch.py"), "the package 'ros_gz_sim' has no file 'launch/gazebo.launch.py'"),
        (TALKER.format(name="listener"), "the package 'arm_description' has no program 'listener'"),
        ("slam", "nothing defines 'slam'"),
        (
            include("arm_description", "part.launch.py"),
            f"the package 'arm_description' has no file 'launch/slam.launch.py' (in {PART})",
        ),
    ],
)
def test_changes_of_a_file_that_never_started_break_nothing_and_the_repair_is_told(package, compare, action, reason):
    part = PYTHON.replace("{action}", include("arm_description", "slam.launch.py"))
    files = {"arm_description/CMakeLists.txt": BUILD, PART: part}
    package.commit({**files, LAUNCH: PYTHON.replace("{action}", action)})
    new = PYTHON.replace("{action}", TALKER.format(name="talker")).replace(DRIVER, "")
    package.write({LAUNCH: new})
    result = compare(package)
    assert breaking(result) == []
    told = sentences(subject(result, LAUNCH))
    assert NODE in told
    assert f"before this change, the launch file always failed: {reason}" in told


@pytest.mark.parametrize(
    "action",
    [
        include("arm_description", "part.launch.py"),
        include("ros_gz_sim", "gz_sim.launch.py"),
        include("unknown_package", "slam.launch.py"),
        include("arm_description", "slam.launch.py", ', condition=IfCondition(LaunchConfiguration("slam"))'),
        TALKER.format(name="talker"),
    ],
)
def test_a_lost_node_of_a_file_that_may_start_is_breaking(package, compare, action):
    files = {
        "arm_description/CMakeLists.txt": BUILD,
        PART: PYTHON.replace("{action}", "Node(package='a', executable='b')"),
    }
    package.commit({**files, LAUNCH: PYTHON.replace("{action}", action)})
    package.write({LAUNCH: PYTHON.replace("{action}", action).replace(DRIVER, "")})
    assert breaking(compare(package)) == [NODE]


def test_a_removed_include_of_a_file_that_never_existed_breaks_nothing(package, compare):
    action = include("arm_description", "slam.launch.py", ', condition=IfCondition(LaunchConfiguration("slam"))')
    package.commit({"arm_description/CMakeLists.txt": BUILD, LAUNCH: PYTHON.replace("{action}", action)})
    package.write({LAUNCH: PYTHON.replace("    actions.add_action({action})\n", "")})
    result = compare(package)
    assert breaking(result) == []
    assert sentences(subject(result, LAUNCH))[0].endswith("; its package does not have the file")


ROS1 = """<launch>
  <arg name="{declared}" default="false"/>
  <arg name="rate" default="10"/>
  <node pkg="arm" type="driver" name="driver"/>
  <node {condition} pkg="arm" type="viewer" name="viewer" args="$(arg verbose)"/>
</launch>
"""
ROS1_PATH = "arm_description/launch/arm.launch"


@pytest.mark.parametrize(("condition", "is_breaking"), [("", False), ('if="$(arg rate)"', True)])
def test_a_file_of_ros_1_that_always_used_an_undeclared_argument_loses_nothing(
    package, compare, condition, is_breaking
):
    package.commit({ROS1_PATH: ROS1.format(declared="vebose", condition=condition)})
    new = ROS1.format(declared="verbose", condition=condition)
    package.write({ROS1_PATH: new.replace('  <node pkg="arm" type="driver" name="driver"/>\n', "")})
    result = compare(package)
    told = sentences(subject(result, ROS1_PATH))
    assert "argument 'vebose' renamed to 'verbose'" in told
    assert ("node 'arm/driver' removed: name driver" in breaking(result)) == is_breaking
    repair = "before this change, the launch file always failed: the argument 'verbose' is not declared"
    assert (repair in told) != is_breaking


def test_an_include_of_a_missing_file_in_ros_1_is_repaired(package, compare):
    text = '<launch>\n  <include file="$(find arm_description)/launch/{}"/>\n</launch>\n'
    package.commit(
        {
            ROS1_PATH: text.format("includes/part.launch.xml"),
            "arm_description/launch/part.launch": ROS1.format(declared="verbose", condition=""),
        }
    )
    package.write({ROS1_PATH: text.format("part.launch")})
    told = sentences(subject(compare(package), ROS1_PATH))
    assert any("has no file 'launch/includes/part.launch.xml'" in line for line in told)


@pytest.mark.parametrize("old_script", [None, "arm_description/src/parts/check.py"])
@pytest.mark.parametrize("new_script", ["arm_description/src/check.py", None])
def test_a_node_of_ros_1_whose_program_exists_now_is_told(package, compare, old_script, new_script):
    manifest = PACKAGE_XML.replace("</package>", "<buildtool_depend>catkin</buildtool_depend></package>")
    text = '<launch>\n  <node pkg="arm_description" type="check.py" name="check"/>\n</launch>\n'
    build = "cmake_minimum_required(VERSION 3.8)\nproject(arm_description)\nfind_package(catkin REQUIRED)\n"
    files = {"arm_description/package.xml": manifest, ROS1_PATH: text, "arm_description/CMakeLists.txt": build}
    package.commit(files | ({old_script: "pass\n"} if old_script else {}))
    package.write({ROS1_PATH: text.replace('name="check"', 'name="check" output="screen"')})
    if new_script:
        package.write({new_script: "pass\n"})
        (package.root / new_script).chmod(0o755)
    told = sentences(subject(compare(package), ROS1_PATH))
    repair = "before this change, no executable program 'arm_description/check.py' was found to start"
    assert (repair in told) == (new_script is not None)
