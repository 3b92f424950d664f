"""The lines of a review about launch files that pass arguments which no longer exist."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking

MANIFEST = "<package><name>lamp</name><version>1.0.0</version></package>\n"
ROS1 = '<launch><arg name="run" default="false"/><arg name="x" default="1"/><node pkg="a" type="b"/></launch>\n'
ROS2 = '<launch><arg name="run" default="false"/><arg name="x" default="1"/><node pkg="a" exec="b"/></launch>\n'
CALL1 = '<launch><include file="$(find lamp)/launch/{file}"><arg name="{name}" value="1"/></include></launch>\n'
CALL2 = CALL1.replace("find ", "find-pkg-share ")
PYTHON = """from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import AnyLaunchDescriptionSource
from launch.substitutions import PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare
def generate_launch_description():
    path = PathJoinSubstitution([FindPackageShare("lamp"), "launch", "a.launch.xml"])
    include = IncludeLaunchDescription(AnyLaunchDescriptionSource(path), launch_arguments={"run": "1"}.items())
    return LaunchDescription([include])
"""


@pytest.mark.parametrize(
    ("included", "text", "caller", "call", "is_found"),
    [
        ("a.launch", ROS1, "b.launch", CALL1.format(file="a.launch", name="run"), True),
        ("a.launch", ROS1, "b.launch", CALL1.format(file="a.launch", name="x"), False),
        ("a.launch", ROS1, "b.launch", CALL1.format(file="other.launch", name="run"), False),
        ("a.launch.xml", ROS2, "b.launch.xml", CALL2.format(file="a.launch.xml", name="run"), True),
        ("a.launch.xml", ROS2, "b.launch.py", PYTHON, True),
        ("a.launch.xml", ROS2.replace("exec=", 'name="$(var run)" exec='), "b.launch.py", PYTHON, False),
    ],
)
def test_a_launch_file_that_passes_a_removed_argument_is_named(
    repository, compare, included, text, caller, call, is_found
):
    files = {"lamp/package.xml": MANIFEST, f"lamp/launch/{included}": text, f"lamp/launch/{caller}": call}
    repository.commit(files)
    repository.write({f"lamp/launch/{included}": text.replace('<arg name="run" default="false"/>', "")})
    found = [line for line in breaking(compare(repository)) if line.startswith("passes")]
    line = f"passes 'run' to 'lamp/launch/{included}', which no longer has the argument"
    assert found == ([line] if is_found else [])
