"""Arguments of Python launch files that are declared in another way, or no longer, in a review."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking, sentences, subject

FILE = """from pathlib import Path
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    bag = LaunchConfiguration("bag")
    topic = LaunchConfiguration("topic")
    view = LaunchConfiguration("view")
    urdf = str(Path(get_package_share_directory("lamp"), "urdf", "lamp.urdf"))
    return LaunchDescription([
        DeclareLaunchArgument("topic"),
        DeclareLaunchArgument("bag", default_value="day"),
        DeclareLaunchArgument("view", default_value="true"),
        ExecuteProcess(cmd=["ros2", "bag", "play", bag]),
        Node(package="lamp", executable="lamp", remappings=[("light", topic)], arguments=[urdf]),
        Node(package="lamp", executable="view", condition=IfCondition(view)),
    ])
"""
PATH = "lamp/launch/lamp.launch.py"
TOPIC, BAG, VIEW = (f"{line}\n" for line in FILE.splitlines() if "DeclareLaunchArgument(" in line)
LEFT = "argument '{}' is no longer declared, but the file still uses it"


@pytest.mark.parametrize(
    ("replacements", "told", "told_as_breaking"),
    [
        ({BAG: "", '("bag")': '("bag", default="day")'}, [LEFT.format("bag")], []),
        ({VIEW: "", '("view")': '("view", default=True)'}, [LEFT.format("view")], []),
        ({TOPIC: ""}, [LEFT.format("topic")], []),
        ({BAG: ""}, ["argument 'bag' removed"], ["argument 'bag' removed"]),
        ({BAG: BAG + "        # a comment\n"}, [], []),
    ],
)
def test_an_argument_that_is_no_longer_declared(repository, compare, replacements, told, told_as_breaking):
    text = FILE
    for old, new in replacements.items():
        assert old in text
        text = text.replace(old, new)
    repository.commit({PATH: FILE})
    repository.write({PATH: text})
    result = compare(repository)
    assert [sentence for found in result.subjects for sentence in sentences(found)] == told
    assert breaking(result) == told_as_breaking


@pytest.mark.parametrize(("replaced", "is_breaking"), [({}, False), ({'("bag")': '("bag", default="day")'}, True)])
def test_an_argument_that_callers_had_to_pass_before_its_declaration(repository, compare, replaced, is_breaking):
    """The old version read it without a default, so it failed without a value, too."""
    undeclared = FILE.replace(BAG, "")
    for old, new in replaced.items():
        undeclared = undeclared.replace(old, new)
    repository.commit({PATH: undeclared})
    repository.write({PATH: FILE.replace(', default_value="day"', "")})
    result = compare(repository)
    assert "argument 'bag' added (required)" in sentences(subject(result, PATH))
    assert ("argument 'bag' added (required)" in breaking(result)) is is_breaking


def test_an_argument_with_another_inline_default_is_told(repository, compare):
    repository.commit({PATH: FILE})
    repository.write({PATH: FILE.replace(BAG, "").replace('("bag")', '("bag", default="night")')})
    found = sentences(subject(compare(repository), PATH))
    assert "process 'ros2': command [ros2, bag, play, $(var bag)] -> [ros2, bag, play, $(var bag night)]" in found


def test_all_parts_of_a_path_are_read(repository, compare):
    repository.commit({PATH: FILE})
    repository.write({PATH: FILE.replace('"lamp.urdf"', '"tall.urdf"')})
    share = "$(find-pkg-share lamp)/urdf/"
    assert sentences(subject(compare(repository), PATH)) == [
        f"node 'lamp/lamp': arguments [{share}lamp.urdf] -> [{share}tall.urdf]"
    ]
