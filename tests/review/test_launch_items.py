"""Items of lists in Python launch files, in a review."""

from __future__ import annotations

import pytest

LAUNCH = """from arm import find
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

FILES = {"left": ["a.yaml"]}
SIDE = "left"
PARAMETERS = {"rate": 3}


def start(context):
    topics = ["left/joint_states", "right/joint_states"]
    return [Node(package="arm", executable="arm", remappings=[("joint_states", TARGET)], parameters=VALUES)]


def generate_launch_description():
    return LaunchDescription(
        [DeclareLaunchArgument("topics", default_value="a,b"), OpaqueFunction(function=start)]
    )
"""


@pytest.mark.parametrize(
    ("target", "expected"),
    [
        ("topics[0]", None),
        ("topics[-2]", None),
        ("topics[1]", "right/joint_states"),
        ("topics[7]", "[left/joint_states, right/joint_states][7]"),
        ("find(topics)[0]", "find([left/joint_states, right/joint_states])[0]"),
    ],
)
def test_an_item_of_a_literal_list_is_its_value(review_changes, target, expected):
    text = LAUNCH.replace("VALUES", "[PARAMETERS]").replace("TARGET", '"left/joint_states"')
    found, broken = review_changes("arm.launch.py", text, '"left/joint_states")', f"{target})")
    change = f"node 'arm/arm': remapping joint_states left/joint_states -> {expected}"
    assert found == ([] if expected is None else [change])
    assert broken == ([change] if expected == "right/joint_states" else [])


def test_an_item_of_a_list_in_a_dictionary_is_its_value(review_changes):
    text = LAUNCH.replace("TARGET", '"x"').replace("VALUES", '["a.yaml"]')
    assert review_changes("arm.launch.py", text, '["a.yaml"])]', "[FILES[SIDE][0]])]") == ([], [])


def test_a_list_and_a_sum_of_lists_are_the_same(review_changes):
    text = LAUNCH.replace("TARGET", '"x"').replace("VALUES", '["a.yaml"] + [{"depth": 2}]')
    found, _ = review_changes("arm.launch.py", text, '["a.yaml"] + [{"depth": 2}]', '["a.yaml"]')
    assert found == ["node 'arm/arm': parameter depth 2 removed"]


def test_a_default_that_the_file_splits_is_a_list(review_changes):
    split = 'LaunchConfiguration("topics").perform(context).split(",")'
    text = LAUNCH.replace("TARGET", '"x"').replace("VALUES", f'[{{"sources": {split}}}]')
    found, _ = review_changes("arm.launch.py", text, split, '["a", "b"]')
    assert found == [
        "node 'arm/arm': parameter sources $(var topics).split(,) -> [a, b] (the same by default)",
        "argument 'topics' is no longer used",
    ]
