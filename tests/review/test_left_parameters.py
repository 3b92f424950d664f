"""The lines of a review about files that still set a parameter which a program no longer reads."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking

MANIFEST = "<package><name>lamp</name><version>1.0.0</version></package>\n"
ROSPY = 'import rospy\nrospy.init_node("lamp")\nlevel = rospy.get_param("~{name}", 1)\n'
ROS1 = '<launch><node pkg="lamp" type="{program}" name="{node}">{content}</node></launch>\n'
RCLPY = """from rclpy.node import Node
class Lamp(Node):
    def __init__(self):
        super().__init__("lamp")
        self.declare_parameter("{name}", 1)
def main():
    Lamp()
"""
SETUP = """from setuptools import setup
setup(name="lamp", packages=["lamp"], entry_points={"console_scripts": ["lamp = lamp.lamp:main"]})
"""
ROS2 = """from launch import LaunchDescription
from launch_ros.actions import Node
def generate_launch_description():
    return LaunchDescription([Node(package="lamp", executable="lamp", parameters=[{"level": 2, "rate": 1}])])
"""
RCLCPP = """#include <rclcpp/rclcpp.hpp>
class Lamp : public rclcpp::Node {{
public:
  Lamp() : Node("lamp") {{ declare_parameter("{name}", 1); }}
}};
"""
CMAKE = """project(lamp)
add_library(lamp_core src/lamp.cpp)
add_executable(lamp_node src/main.cpp)
target_link_libraries(lamp_node lamp_core)
install(TARGETS lamp_node lamp_core DESTINATION lib/lamp)
"""
CHOSEN = '<rosparam file="$(find lamp)/config/$(arg name).yaml" command="load"/>'
LOADED = '<rosparam file="$(find lamp)/config/lamp.yaml" command="load"/>'


def find_users(repository, compare, files, path, text):
    """Return the breaking lines about parameters that files still set after `text` loses its parameter."""
    repository.commit({"lamp/package.xml": MANIFEST, **files, path: text.format(name="level")})
    repository.write({path: text.format(name="brightness")})
    return [line for line in breaking(compare(repository)) if line.startswith("sets the parameter")]


@pytest.mark.parametrize(
    ("program", "node", "content", "config", "is_found"),
    [
        ("lamp.py", "lamp", '<param name="level" value="2"/>', "", True),
        ("lamp.py", "lamp", '<param name="rate" value="2"/>', "", False),
        ("other.py", "lamp", '<param name="level" value="2"/>', "", False),
        ("lamp.py", "lamp", LOADED, "level: 3\n", True),
        ("lamp.py", "lamp", LOADED, "rate: 3\n", False),
        ("lamp.py", "lamp", LOADED.replace("/>", ' ns="inner"/>'), "level: 3\n", False),
        ("lamp.py", "lamp", CHOSEN, "level: 3\n", True),
        ("lamp.py", "lamp", CHOSEN.replace("find lamp", "find light"), "level: 3\n", False),
        ("lamp.py", "lamp", CHOSEN.replace("/config/", "/params/"), "level: 3\n", False),
        ("other.py", "lamp", CHOSEN, "level: 3\n", False),
        ("lamp.py", "lamp", "", "level: 3\n", False),
    ],
)
def test_files_of_ros1_that_set_a_lost_parameter(repository, compare, program, node, content, config, is_found):
    files = {
        "lamp/launch/a.launch": ROS1.format(program=program, node=node, content=content),
        "lamp/config/lamp.yaml": config,
    }
    found = find_users(repository, compare, files, "lamp/scripts/lamp.py", ROSPY)
    line = "sets the parameter 'level', which 'lamp/scripts/lamp.py' no longer reads"
    assert found == ([line] if is_found else [])


def test_a_parameter_that_another_source_of_the_package_reads(repository, compare):
    launch = ROS1.format(program="lamp.py", node="lamp", content='<param name="level" value="2"/>')
    files = {"lamp/launch/a.launch": launch, "lamp/src/lamp/base.py": 'KEY = "~level"\n'}
    assert find_users(repository, compare, files, "lamp/scripts/lamp.py", ROSPY) == []


def test_a_program_that_reads_all_parameters(repository, compare):
    launch = ROS1.format(program="lamp.py", node="lamp", content='<param name="level" value="2"/>')
    text = f'{ROSPY}settings = rospy.get_param("~")\n'
    assert find_users(repository, compare, {"lamp/launch/a.launch": launch}, "lamp/scripts/lamp.py", text) == []


def test_files_of_ros2_that_set_a_lost_parameter(repository, compare):
    parameters = "{node}:\n  ros__parameters:\n    level: 2\n    rate: 1\n"
    files = {
        "lamp/setup.py": SETUP,
        "lamp/lamp/__init__.py": "",
        "lamp/launch/a.launch.py": ROS2,
        "lamp/config/lamp.yaml": parameters.format(node="lamp"),
        "lamp/config/other.yaml": parameters.format(node="other"),
    }
    repository.commit({"lamp/package.xml": MANIFEST, **files, "lamp/lamp/lamp.py": RCLPY.format(name="level")})
    repository.write({"lamp/lamp/lamp.py": RCLPY.format(name="brightness")})
    found = [
        (subject.path, change.location.line)
        for subject, change in compare(repository).breaking_changes
        if str(change.sentence).startswith("sets the parameter 'level'")
    ]
    assert found == [("lamp/config/lamp.yaml", 3), ("lamp/launch/a.launch.py", 4)]


@pytest.mark.parametrize("program", ["lamp_node", "other_node"])
def test_an_executable_with_the_source_in_a_library(repository, compare, program):
    node = f'<launch><node pkg="lamp" exec="{program}"><param name="level" value="2"/></node></launch>\n'
    files = {
        "lamp/CMakeLists.txt": CMAKE,
        "lamp/src/main.cpp": "int main() {}\n",
        "lamp/launch/a.launch.xml": node,
    }
    found = find_users(repository, compare, files, "lamp/src/lamp.cpp", RCLCPP)
    line = "sets the parameter 'level', which 'lamp/src/lamp.cpp' no longer reads"
    assert found == ([line] if program == "lamp_node" else [])


@pytest.mark.parametrize(("target", "is_found"), [("lamp_node", True), ("other_node", False)])
def test_an_executable_with_another_name_than_its_target(repository, compare, target, is_found):
    node = '<launch><node pkg="lamp" type="bulb" name="bulb"><param name="level" value="2"/></node></launch>\n'
    build = f'{CMAKE}set_target_properties({target} PROPERTIES OUTPUT_NAME bulb PREFIX "")\n'
    files = {"lamp/CMakeLists.txt": build, "lamp/src/main.cpp": "int main() {}\n", "lamp/launch/a.launch": node}
    assert bool(find_users(repository, compare, files, "lamp/src/lamp.cpp", RCLCPP)) is is_found


def test_a_parameter_file_of_a_node_with_the_name_of_another_one(repository, compare):
    other = '<launch><node pkg="other" exec="other" name="lamp"/></launch>\n'
    files = {
        "lamp/launch/b.launch.xml": other,
        "lamp/config/lamp.yaml": "lamp:\n  ros__parameters:\n    level: 2\n",
    }
    assert find_users(repository, compare, files, "lamp/src/lamp.cpp", RCLCPP) == []
