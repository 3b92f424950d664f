"""Nodes of launch files that replace others, and renamed files that arguments choose, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

CATKIN_XML = "<package format='2'><name>arm</name><version>1.0.0</version><description>d</description>\
<maintainer email='a@b.c'>a</maintainer><license>MIT</license><buildtool_depend>catkin</buildtool_depend></package>"
CMAKE = """cmake_minimum_required(VERSION 3.5)
project(arm)
find_package(catkin REQUIRED)
catkin_package()
add_executable(exec_traj src/exec.cpp)
"""
LAUNCH = '<launch><node pkg="arm" type="exec_traj" name="exec_traj" output="screen"/></launch>'


def test_node_of_a_renamed_executable_is_renamed(repository, compare):
    repository.commit(
        {
            "package.xml": CATKIN_XML,
            "CMakeLists.txt": CMAKE,
            "src/exec.cpp": "int main() {}\n",
            "launch/a.launch": LAUNCH,
        }
    )
    repository.write(
        {
            "CMakeLists.txt": CMAKE.replace("exec_traj", "follow_bringup"),
            "launch/a.launch": LAUNCH.replace("exec_traj", "follow_bringup"),
        }
    )
    changes = subject(compare(repository), "launch/a.launch").changes
    assert {str(change.sentence): change.reason and str(change.reason) for change in changes} == {
        "node 'arm/exec_traj' replaced by node 'arm/follow_bringup'": None,
        "node 'arm/follow_bringup': name exec_traj -> follow_bringup": "programs that use the names of the node, its "
        "topics or its services do not find them",
    }


ARBITER = """from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        Node(package='base', executable='cmd_arb', remappings=[('cmd_out', 'cmd_vel')]),
    ])
"""


def test_node_with_the_same_topics_of_the_same_package_replaces_another(repository, compare):
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/launch/arm.launch.py": ARBITER})
    repository.write({"arm/launch/arm.launch.py": ARBITER.replace("cmd_arb", "cmd_arbitration")})
    assert sentences(subject(compare(repository), "arm/launch/arm.launch.py")) == [
        "node 'base/cmd_arb' replaced by node 'base/cmd_arbitration'"
    ]


@pytest.mark.parametrize("has_program", [True, False])
def test_removed_node_of_a_missing_program_breaks_nothing(repository, compare, has_program):
    cmake = CMAKE if has_program else CMAKE.replace("exec_traj", "drive")
    files = {"package.xml": CATKIN_XML, "CMakeLists.txt": cmake, "src/exec.cpp": "int main() {}\n"}
    repository.commit({**files, "launch/a.launch": LAUNCH})
    repository.write({"launch/a.launch": "<launch></launch>"})
    (change,) = subject(compare(repository), "launch/a.launch").changes
    assert (change.reason is not None) == has_program
    assert str(change.sentence).endswith("; its package never had the program") != has_program


CHOICE = """<launch>
  <arg name="sensors" default="old"/>
  <include file="$(find arm)/launch/$(arg sensors)_sensors.launch"/>
</launch>
"""
CALLER = '<launch><include file="$(find arm)/launch/choice.launch"><arg name="sensors" value="old"/></include></launch>'
SENSORS = '<launch><node pkg="camera" type="camera_node" name="camera"/></launch>'


def test_argument_that_chooses_a_renamed_file_stops_nothing(repository, compare):
    files = {"package.xml": CATKIN_XML, "CMakeLists.txt": CMAKE, "src/exec.cpp": "int main() {}\n"}
    launch = {"launch/choice.launch": CHOICE, "launch/old_sensors.launch": SENSORS, "launch/a.launch": CALLER}
    repository.commit({**files, **launch})
    repository.write(
        {
            "launch/old_sensors.launch": None,
            "launch/choice.launch": CHOICE.replace('"old"', '"new"'),
            "launch/new_sensors.launch": SENSORS,
            "launch/a.launch": CALLER.replace('"old"', '"new"'),
        }
    )
    repository.commit({})
    assert not [sentence for sentence in breaking(compare(repository, "HEAD~..HEAD")) if "include of" in sentence]


INSTALL = CMAKE + "install(FILES launch/a.launch DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION}/launch)\n"
SHOWN = '<launch><node pkg="rviz" type="rviz" name="rviz" args="-d $(find arm)/config/a.rviz"/></launch>'


def test_file_that_was_not_installed_before_the_package_was_renamed_is_not_new(repository, compare):
    files = {
        "arm/package.xml": CATKIN_XML,
        "arm/CMakeLists.txt": INSTALL,
        "arm/src/exec.cpp": "int main() {}\n",
        "arm/config/a.rviz": "Visualization Manager: {}\n",
        "arm/launch/a.launch": SHOWN,
    }
    repository.commit(files)
    renamed = {path.replace("arm/", "limb/", 1): text.replace("arm", "limb") for path, text in files.items()}
    repository.write({**dict.fromkeys(files), **renamed})
    repository.commit({})
    found = breaking(compare(repository, "HEAD~..HEAD"))
    assert "package 'arm' renamed to 'limb'" in found
    assert not [sentence for sentence in found if "not installed" in sentence]


DRIVER = '<node pkg="fake_driver" type="driver" name="{name}">{parameters}</node>'
PARAMETERS = '<param name="controller_name" value="arm"/><param name="port" value="/dev/arm"/>'
COMMON = '<param name="use_sim_time" value="true"/><param name="frame_id" value="base"/>'


@pytest.mark.parametrize(
    ("old", "new", "is_replaced"),
    [
        (PARAMETERS, PARAMETERS, True),
        (PARAMETERS, PARAMETERS.replace("/dev/arm", "/dev/hand"), False),
        (COMMON, COMMON, False),
        ("", "", False),
    ],
)
def test_program_with_the_same_parameters_replaces_another(repository, compare, old, new, is_replaced):
    path = "arm/launch/arm.launch"
    text = f"<launch>{DRIVER.format(name='fake', parameters=old)}</launch>"
    repository.commit({"arm/package.xml": PACKAGE_XML, path: text})
    text = text.replace(old, new) if old else text
    repository.write({path: text.replace("fake_driver", "motors").replace('"driver"', '"node"').replace("fake", "m")})
    replaced = "node 'fake_driver/driver' replaced by node 'motors/node'"
    assert (replaced in sentences(subject(compare(repository), path))) == is_replaced


@pytest.mark.parametrize(
    ("program", "arguments", "is_lost"),
    [
        ("factory", "spawn -f arm.urdf", False),
        ("factory", "-f respawn.urdf", True),
        ("create_model", "-f arm.urdf", False),
    ],
)
def test_another_program_may_spawn_the_model(repository, compare, program, arguments, is_lost):
    path = "arm/launch/arm.launch"
    old = '<node pkg="gazebo_ros" type="spawn_model" name="a" args="-urdf -param robot_description -model arm"/>'
    new = f'<node pkg="tools" type="{program}" name="b" args="{arguments}"/>'
    repository.commit({"arm/package.xml": PACKAGE_XML, path: f"<launch>{old}</launch>"})
    repository.write({path: f"<launch>{new}</launch>"})
    assert any("spawn_model' removed" in line for line in breaking(compare(repository))) == is_lost


@pytest.mark.parametrize(("program", "is_lost"), [("gui", False), ("gzclient", False), ("gzserver", True)])
def test_window_of_the_simulator_offers_nothing(repository, compare, program, is_lost):
    path = "arm/launch/arm.launch"
    node = f'<node pkg="gazebo_ros" type="{program}" name="window"/>'
    repository.commit({"arm/package.xml": PACKAGE_XML, path: f"<launch>{node}</launch>"})
    repository.write({path: "<launch/>"})
    assert bool(breaking(compare(repository))) == is_lost
