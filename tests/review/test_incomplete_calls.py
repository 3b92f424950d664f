"""Actions of Python launch files without a required argument, and items of lists, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

LAUNCH = """from launch import LaunchDescription
from launch.actions import ExecuteProcess
from launch_ros.actions import Node, SetRemap
from launch_ros.descriptions import ComposableNode

TOPICS = ["arm/states", "hand/states"]


def generate_launch_description():
    return LaunchDescription([
        REMAP
        Node(package="arm", executable="driver", remappings=[("states", TOPIC)]),
        ADDED
    ])
"""
PATH = "arm/launch/arm.launch.py"


@pytest.fixture
def review_launch(repository, compare):
    """Review two versions of the launch file, given by replacements of its words."""

    def run(old: dict[str, str], new: dict[str, str]):
        texts = []
        for values in (old, new):
            text = LAUNCH
            for word, value in ({"REMAP": "", "ADDED": "", "TOPIC)": '"arm/states")'} | values).items():
                text = text.replace(word, value)
            texts.append(text)
        repository.commit({"arm/package.xml": PACKAGE_XML, PATH: texts[0]})
        repository.write({PATH: texts[1]})
        result = compare(repository)
        found = sentences(subject(result, PATH)) if result.subjects else []
        return found, breaking(result)

    return run


@pytest.mark.parametrize(
    ("added", "line"),
    [
        ('Node(package="arm", plugin="arm::Hand"),', "Node() has no argument 'executable'"),
        ('Node(package="arm", executable="hand"),', None),
        ('Node(package="arm", node_executable="hand"),', None),
        ("Node(**settings),", None),
        ('ComposableNode(package="arm", executable="hand"),', "ComposableNode() has no argument 'plugin'"),
        ('ExecuteProcess(["ls"]),', "ExecuteProcess() has no argument 'cmd'"),
        ("Other(),", None),
    ],
)
def test_an_action_without_a_required_argument_makes_the_launch_file_fail(review_launch, added, line):
    _, found = review_launch({}, {"ADDED": added})
    assert [each for each in found if "has no argument" in each] == ([] if line is None else [line])
    _, found = review_launch({"ADDED": added}, {"ADDED": added, "TOPIC)": '"other")'})
    assert not [each for each in found if "has no argument" in each]


@pytest.mark.parametrize(
    ("topic", "lines"),
    [
        ("TOPICS[0])", []),
        ("TOPICS[1])", ["node 'arm/driver': remapping states arm/states -> hand/states"]),
        ("load()[0])", []),
    ],
)
def test_an_item_of_a_list_is_evaluated(review_launch, topic, lines):
    _, found_breaking = review_launch({}, {"TOPIC)": topic})
    assert found_breaking == lines


@pytest.mark.parametrize(
    ("old", "new", "is_breaking"),
    [
        ({}, {"REMAP": 'SetRemap("/tf", "tf_arm"),'}, True),
        ({}, {"REMAP": 'SetRemap("/tf", "tf_arm"),', "ADDED": 'Node(package="arm", executable="hand"),'}, False),
    ],
)
def test_a_remapping_of_the_nodes_that_follow(review_launch, old, new, is_breaking):
    _, found = review_launch(old, new)
    assert ("remapping of '/tf' for the nodes that follow added: tf_arm" in found) is is_breaking
