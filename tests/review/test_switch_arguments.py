"""Arguments of launch files that only started actions which are gone, in a review."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking

FILE = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    eye = LaunchConfiguration("eye")
    eye_argument = DeclareLaunchArgument("eye", default_value="false")
    eye_node = Node(package="eye", executable="eye_node", condition=IfCondition(eye))
    other = IncludeLaunchDescription("other.launch.py")
    lamp_node = Node(package="lamp", executable="lamp_node")
    ld = LaunchDescription([eye_argument, other, lamp_node])
    ld.add_action(eye_node)
    return ld
"""
LEFT_OUT = "    ld.add_action(eye_node)\n"
UNUSED = "argument 'eye' is no longer used"
STARTED = 'executable="lamp_node"'


@pytest.mark.parametrize(
    ("text", "old", "new", "expected"),
    [
        (FILE, LEFT_OUT, "", [UNUSED]),
        (FILE, LEFT_OUT, "    if True:\n        pass\n    else:\n        unread = eye\n", [UNUSED]),
        (FILE, LEFT_OUT, "    print(eye)\n", []),
        (FILE.replace(STARTED, f"{STARTED}, condition=IfCondition(eye)"), LEFT_OUT, "", []),
        (FILE.replace('="false"', '="true"'), LEFT_OUT, "", ["node 'eye/eye_node' removed: if $(var eye)"]),
    ],
)
def test_an_argument_that_starts_nothing_any_more(repository, compare, text, old, new, expected):
    repository.commit({"lamp/launch/lamp.launch.py": text})
    repository.write({"lamp/launch/lamp.launch.py": text.replace(old, new)})
    assert breaking(compare(repository)) == expected
