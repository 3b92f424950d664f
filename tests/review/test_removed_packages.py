"""Removed packages in a review: all their files are one change."""

from __future__ import annotations

import pytest

from linkwright.review.reports.sentences import list_other_files
from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

MANIFEST = PACKAGE_XML.replace("arm_description", "arm_driver").replace(">xacro<", ">rclpy<")
NODE = """import rclpy
from rclpy.node import Node
from std_msgs.msg import String

class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.create_publisher(String, "state", 10)
        self.create_subscription(String, "goal", print, 10)

def main():
    rclpy.init()
    rclpy.spin(Driver())
"""
SETUP = """from setuptools import setup
setup(name="arm_driver", packages=["arm_driver"],
      entry_points={"console_scripts": ["driver = arm_driver.driver:main"]})
"""
LAUNCH = '<launch><node pkg="{0}" exec="driver"/></launch>\n'
FILES = {
    "arm_driver/package.xml": MANIFEST,
    "arm_driver/setup.py": SETUP,
    "arm_driver/arm_driver/__init__.py": "",
    "arm_driver/arm_driver/driver.py": NODE,
    "arm_driver/launch/arm.launch.xml": LAUNCH.format("arm_driver"),
    "arm_driver/config/arm.yaml": "driver:\n  ros__parameters:\n    rate: 10\n",
    "robot/package.xml": PACKAGE_XML.replace("arm_description", "robot"),
    "robot/launch/robot.launch.xml": LAUNCH.format("robot_driver"),
}
REMOVED = {path: None for path in FILES if path.startswith("arm_driver/")}


def test_removed_package_is_one_breaking_change(repository, compare):
    repository.commit(FILES)
    repository.commit(REMOVED)
    result = compare(repository, "HEAD~1..HEAD")
    contents = (
        "installed executables 'driver'; launch files 'launch/arm.launch.xml'; parameter files 'config/arm.yaml'; "
        "publishers 'state' (String); subscriptions 'goal' (String)"
    )
    assert breaking(result) == [f"package removed with 6 files: {contents}"]
    assert [item.path for item in result.subjects] == ["arm_driver/package.xml"]
    assert list_other_files(result) == []


def test_what_other_packages_lose_has_lines_of_its_own(repository, compare):
    repository.commit(FILES)
    repository.commit({**REMOVED, "robot/launch/robot.launch.xml": None})
    removed = breaking(compare(repository, "HEAD~1..HEAD"))
    assert len(removed) == 2
    assert "launch file removed: node 'robot_driver/driver'" in removed


def test_file_that_moves_to_another_package_is_no_content_of_the_removed_one(repository, compare):
    repository.commit(FILES)
    repository.commit({**REMOVED, "robot/config/arm.yaml": FILES["arm_driver/config/arm.yaml"]})
    result = compare(repository, "HEAD~1..HEAD")
    assert "config/arm.yaml" not in " ".join(sentences(subject(result, "arm_driver/package.xml")))
    assert "renamed from arm_driver/config/arm.yaml" in sentences(subject(result, "robot/config/arm.yaml"))


@pytest.mark.parametrize(
    ("path", "text"),
    [
        ("robot/launch/robot.launch.xml", LAUNCH.format("arm_driver")),
        ("robot/launch/robot.launch.py", "Node(package='arm_driver', executable='driver')\n"),
        ("robot/launch/robot.launch.py", "get_package_share_directory('arm_driver')\n"),
        ("robot/launch/robot.launch", '<launch><include file="$(find arm_driver)/launch/a.launch"/></launch>'),
        ("robot/urdf/robot.xacro", '<robot><mesh filename="package://arm_driver/arm.stl"/></robot>'),
        ("robot/CMakeLists.txt", "find_package(arm_driver REQUIRED)\n"),
        ("robot/package.xml", PACKAGE_XML.replace("arm_description", "robot").replace(">xacro<", ">arm_driver<")),
        ("robot/robot/arm.py", "from arm_driver.driver import Driver\n"),
        ("robot/src/arm.cpp", "#include <arm_driver/arm.hpp>\n"),
    ],
)
def test_files_that_still_use_a_removed_package_are_named(repository, compare, path, text):
    repository.commit({**FILES, path: text})
    repository.commit(REMOVED)
    result = compare(repository, "HEAD~1..HEAD")
    (change,) = subject(result, "arm_driver/package.xml").changes
    assert f"; still used by '{path}'" in str(change.reason)


@pytest.mark.parametrize(
    ("path", "text"),
    [
        ("robot/launch/robot.launch.xml", f"<launch><!-- {LAUNCH.format('arm_driver')} --></launch>"),
        ("robot/launch/robot.launch.py", "# Node(package='arm_driver', executable='driver')\n"),
        ("robot/launch/robot.launch.py", "Node(package='arm_driver_msgs', executable='driver')\n"),
        ("robot/src/arm.cpp", "int arm_driver = 1;\n"),
    ],
)
def test_other_names_and_comments_do_not_use_a_removed_package(repository, compare, path, text):
    repository.commit({**FILES, path: text})
    repository.commit(REMOVED)
    (change,) = subject(compare(repository, "HEAD~1..HEAD"), "arm_driver/package.xml").changes
    assert "still used" not in str(change.reason)


INSTALLS = "find_package(ament_cmake REQUIRED)\ninstall(DIRECTORY config DESTINATION share/driver)\n"


@pytest.mark.parametrize(
    ("files", "is_breaking"),
    [
        ({"driver/CMakeLists.txt": "project(driver)\nfind_package(ament_cmake REQUIRED)\n"}, False),
        ({"driver/CMakeLists.txt": "project(driver)\nadd_executable(driver a.cpp)\n"}, True),
        ({"driver/CMakeLists.txt": INSTALLS, "driver/package.xml": MANIFEST}, True),
        ({"driver/CMakeLists.txt": "find_package(ament_cmake REQUIRED)\n", "driver/package.xml": MANIFEST}, False),
        (
            {
                "driver/CMakeLists.txt": "find_package(ament_cmake REQUIRED)\n",
                "driver/package.xml": MANIFEST,
                "start.sh": "ros2 run driver driver --params-file driver/config/arm.yaml\n",
            },
            True,
        ),
        ({}, True),
    ],
)
def test_file_that_is_not_installed_breaks_nothing_unless_another_file_names_it(
    repository, compare, files, is_breaking
):
    path = "driver/config/arm.yaml"
    repository.commit({**files, path: FILES["arm_driver/config/arm.yaml"]})
    repository.write({path: None})
    result = compare(repository)
    assert any(sentence.startswith("parameter file removed") for sentence in sentences(subject(result, path)))
    assert bool(breaking(result)) is is_breaking
