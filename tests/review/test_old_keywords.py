"""Arguments of nodes in Python launch files that are named as before ROS 2 Foxy, in a review."""

from __future__ import annotations

import pytest

FILE = """from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([Node(package="arm", node_executable="driver", name="arm")])
"""
LINE = "no longer uses 'node_executable', which ROS 2 Galactic and later refuse"
BREAKING = "uses 'node_executable', which ROS 2 Galactic and later refuse"


@pytest.mark.parametrize(
    ("old", "new", "lines", "breaking_lines"),
    [
        ("node_executable", "executable", [LINE], []),
        ('"arm")', '"base")', None, []),  # both versions have the old keyword
    ],
)
def test_launch_file_without_old_keywords(review_changes, old, new, lines, breaking_lines):
    told, breaking = review_changes("arm.launch.py", FILE, old, new)
    assert [line for line in told if "Galactic" in line] == (lines or [])
    assert [line for line in breaking if "Galactic" in line] == breaking_lines


def test_launch_file_with_a_new_old_keyword_is_breaking(review_changes):
    text = FILE.replace("node_executable", "executable")
    _, breaking = review_changes("arm.launch.py", text, "executable", "node_executable")
    assert breaking == [BREAKING]
