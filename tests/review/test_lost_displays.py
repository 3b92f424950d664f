"""RViz configurations that show a topic which a changed source or launch file no longer publishes."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

SOURCE = 'self.pose = self.create_publisher(Pose, "pose", 10)\n'
DISPLAY = "Displays:\n  - Class: rviz_default_plugins/Pose\n    Topic:\n      Depth: 5\n      Value: /pose\n"
EXPECTED = "shows the topic 'pose', which 'arm/node.py' no longer publishes"


@pytest.mark.parametrize(
    ("others", "is_lost"),
    [
        ({}, True),
        ({"arm/other.py": SOURCE}, False),
        ({"arm/launch/arm.launch.py": 'remappings=[("out", "/pose")]\n'}, False),
        ({"arm/config/arm.yaml": "pose_topic: /pose\n"}, False),
        ({"arm/config/arm.yaml": "pose_topic: /arm/pose\n"}, True),
    ],
)
def test_configuration_of_rviz_that_shows_a_lost_topic_is_breaking(repository, compare, others, is_lost):
    repository.commit({"arm/node.py": SOURCE, "arm/rviz/arm.rviz": DISPLAY, **others})
    repository.write({"arm/node.py": SOURCE.replace('"pose"', '"state"')})
    result = compare(repository)
    assert (EXPECTED in breaking(result)) == is_lost
    if is_lost:
        assert sentences(subject(result, "arm/rviz/arm.rviz")) == [EXPECTED]


def make_launch_file(remappings: str, rviz: str, more: str) -> str:
    return f"""from launch import LaunchDescription
from launch.substitutions import PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    return LaunchDescription([
        Node(package="rviz2", executable="rviz2", {rviz}),
        Node(package="robot_state_publisher", executable="robot_state_publisher", remappings=[{remappings}]),
        {more}
    ])
"""


OPENED = "arguments=['-d', PathJoinSubstitution([FindPackageShare('arm'), 'rviz', 'arm.rviz'])]"
REMAPPING = "('robot_description', 'ego_description')"
MODEL = """Displays:
  - Class: rviz_default_plugins/RobotModel
    Description Source: Topic
    Description Topic:
      Value: /robot_description
"""


@pytest.mark.parametrize(
    ("rviz", "more", "model", "is_lost"),
    [
        (OPENED, "", MODEL, True),
        ("", "", MODEL, True),
        (OPENED, "", MODEL.replace("Source: Topic", "Source: File"), False),
        (OPENED, "", MODEL.replace("/robot_description", "/ego_description"), False),
        (OPENED.replace("arm.rviz", "other.rviz"), "", MODEL, False),
        (f"{OPENED}, remappings=[{REMAPPING}]", "", MODEL, False),
        (OPENED, 'Node(package="robot_state_publisher", executable="robot_state_publisher", name="b"),', MODEL, False),
        (OPENED, 'Node(package="arm", executable="a", remappings=[("b", "robot_description")]),', MODEL, False),
    ],
)
def test_configuration_of_rviz_that_shows_a_remapped_topic_is_breaking(repository, compare, rviz, more, model, is_lost):
    path = "arm/launch/arm.launch.py"
    repository.commit(
        {"arm/package.xml": PACKAGE_XML, path: make_launch_file("", rviz, more), "arm/rviz/arm.rviz": model}
    )
    repository.write({path: make_launch_file(REMAPPING, rviz, more)})
    expected = f"shows the topic 'robot_description', which '{path}' remaps to 'ego_description' now"
    assert (expected in breaking(compare(repository))) == is_lost
