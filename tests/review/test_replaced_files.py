"""Launch and parameter files that take the place of removed ones, with few equal lines."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences, subject

OLD_LAUNCH = """from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([Node(package='arm', executable='driver', name='driver', parameters=[{'rate': 10}])])
"""
NEW_LAUNCH = """import launch
import launch_ros


def make_driver():
    driver = launch_ros.actions.Node(
        package='arm',
        executable='driver',
        name='left_driver',
    )
    return driver


def generate_launch_description():
    ld = launch.LaunchDescription()
    ld.add_action(make_driver())
    return ld
"""
VALUES = "".join(f"    value_{number}: text {number}\n" for number in range(8))
OLD_VALUES = f"driver:\n  ros__parameters:\n{VALUES}" + "".join(f"other{i}: {{a: {i}}}\n" for i in range(20))
NEW_VALUES = f"driver:\n  ros__parameters:\n{VALUES.replace('text 0', 'other')}"


def test_launch_file_that_starts_the_same_programs_is_renamed(repository, compare):
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/launch/node_driver.launch.py": OLD_LAUNCH})
    path = "arm/launch/driver.launch.py"
    repository.write({"arm/launch/node_driver.launch.py": None, path: NEW_LAUNCH})
    result = compare(repository)
    assert sentences(subject(result, path))[:2] == [
        "renamed from arm/launch/node_driver.launch.py",
        "node 'arm/driver': name driver -> left_driver",
    ]
    assert [found.path for found in result.subjects] == [path]


@pytest.mark.parametrize(
    ("path", "code"),
    [
        ("arm/launch/calibrate.launch.py", NEW_LAUNCH),
        ("arm/start/my_driver.launch.py", NEW_LAUNCH),
        ("arm/launch/my_driver.launch.py", NEW_LAUNCH.replace("'driver'", "'camera'")),
    ],
)
def test_launch_file_with_another_name_folder_or_program_is_another_file(repository, compare, path, code):
    old = "arm/launch/driver.launch.py"
    repository.commit({"arm/package.xml": PACKAGE_XML, old: OLD_LAUNCH})
    repository.write({old: None, path: code})
    assert {found.path for found in compare(repository).subjects} == {old, path}


def test_parameter_file_with_most_values_of_a_removed_one_is_renamed(repository, compare):
    path = "arm/config/driver.yaml"
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/launch/driver_b.yaml": OLD_VALUES})
    repository.write({"arm/launch/driver_b.yaml": None, path: NEW_VALUES})
    result = compare(repository)
    assert sentences(subject(result, path))[:2] == [
        "renamed from arm/launch/driver_b.yaml",
        "driver.ros__parameters.value_0 text 0 -> other",
    ]
    assert [found.path for found in result.subjects] == [path]


def test_parameter_file_with_few_of_the_values_is_another_file(repository, compare):
    old, path = "arm/config/driver_b.yaml", "arm/config/driver.yaml"
    repository.commit({"arm/package.xml": PACKAGE_XML, old: OLD_VALUES})
    repository.write({old: None, path: NEW_VALUES.replace("text", "another")})
    assert {found.path for found in compare(repository).subjects} == {old, path}


OLD_HEADER = """class Tool {
 public:
  Tool();
  void init(const std::string & name);
};
"""
NEW_HEADER = """#include <memory>
#include <string>
// The tool at the flange.
struct Limits { double low; double high; };
class Tool {
 public:
  Tool(std::shared_ptr<Node> node, const std::string & name, Limits limits);
  double width() const;
 private:
  Limits limits_;
};
"""
BUILD = "project(arm)\ninstall(DIRECTORY include/ DESTINATION include)\nament_package()\n"
LOST = "functions removed: 'Tool::init' (const std::string&)"


@pytest.mark.parametrize(
    ("path", "text", "is_pair"),
    [
        ("include/arm/parts/tool.hpp", NEW_HEADER, True),
        ("include/arm/parts/Tool.hpp", NEW_HEADER, True),
        ("include/arm/parts/gripper.hpp", NEW_HEADER, False),
        ("include/arm/parts/tool.hpp", NEW_HEADER.replace("Tool", "Other"), False),
    ],
)
def test_a_header_with_the_class_of_a_removed_one_is_compared_with_it(repository, compare, path, text, is_pair):
    manifest = PACKAGE_XML.replace("arm_description", "arm")
    repository.commit(
        {"arm/package.xml": manifest, "arm/CMakeLists.txt": BUILD, "arm/include/arm/tool.hpp": OLD_HEADER}
    )
    repository.commit({"arm/include/arm/tool.hpp": None, f"arm/{path}": text})
    result = compare(repository, "HEAD~1..HEAD")
    lines = [line for found in result.subjects if found.path == f"arm/{path}" for line in sentences(found)]
    assert (LOST in lines) == is_pair


OLD_NODE = """import rospy
from std_msgs.msg import String


class Tool:
    def __init__(self):
        self.p = rospy.Publisher('state', String, queue_size=1)
"""
NEW_NODE = """#!/usr/bin/env python3
# The tool at the flange.
import rclpy
from rclpy.node import Node
from std_msgs.msg import Bool, String


class Tool(Node):
    def __init__(self):
        super().__init__('tool')
        self.state = self.create_publisher(String, 'status', 10)
"""


def test_a_python_source_with_the_class_of_a_removed_one_is_compared_with_it(repository, compare):
    repository.commit(
        {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), "arm/scripts/tool.py": OLD_NODE}
    )
    repository.commit({"arm/scripts/tool.py": None, "arm/arm/tool.py": NEW_NODE})
    found = subject(compare(repository, "HEAD~1..HEAD"), "arm/arm/tool.py")
    assert "publisher 'state' (String) renamed to 'status' (String)" in sentences(found)
