"""Nodes whose parameters move to another parameter file, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

PLANNER = "planner:\n  ros__parameters:\n    rate: 20\n    frame: map\n"
NAVIGATOR = "navigator:\n  ros__parameters:\n    rate: 10\n    frame: map\n    topic: /odom\n"
PATH, NEW_PATH = "arm/config/all.yaml", "arm/config/navigator.yaml"
LAUNCH = "arm/launch/navigator.launch.py"


def make_launch_file(name: str) -> str:
    return f"""from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([Node(package="nav", executable="navigator", parameters=["config/{name}"])])
"""


@pytest.mark.parametrize(
    ("loaded", "text", "line", "is_breaking"),
    [
        ("navigator.yaml", NAVIGATOR, f"navigator moved to {NEW_PATH}", False),
        ("navigator.yaml", NAVIGATOR.replace("10", "30"), f"navigator moved to {NEW_PATH}, with rate 10 -> 30", False),
        ("all.yaml", NAVIGATOR, f"navigator moved to {NEW_PATH} with the same values", True),
        ("navigator.yaml", NAVIGATOR.replace("rate: 10", "speed: 1"),
         "navigator removed: rate 10, frame map, topic /odom", True),
    ],
)  # fmt: skip
def test_a_node_moves_to_a_file_that_a_launch_file_loads(repository, compare, loaded, text, line, is_breaking):
    files = {"arm/package.xml": PACKAGE_XML, PATH: PLANNER + NAVIGATOR, LAUNCH: make_launch_file("all.yaml")}
    repository.commit(files)
    repository.write({PATH: PLANNER, NEW_PATH: text, LAUNCH: make_launch_file(loaded)})
    result = compare(repository)
    assert sentences(subject(result, PATH)) == [line]
    assert (line in breaking(result)) is is_breaking


def test_a_group_without_a_node_that_moves_to_another_file_has_the_values_that_differ(repository, compare):
    group, rest = "arm:\n  mass: 2.5\n  width: 0.1\n  clearance: 0.2\n", "base:\n  mass: 1\n  height: 2\n"
    repository.commit({"arm/package.xml": PACKAGE_XML, PATH: group + rest})
    for text, ending in (
        (group, " with the same values"),
        (f"{group}  depth: 0.02\n".replace("0.1", "0.3"), ", with width 0.1 -> 0.3, depth 0.02 added"),
    ):
        repository.write({PATH: rest, NEW_PATH: text})
        assert breaking(compare(repository)) == [f"arm moved to {NEW_PATH}{ending}"]
    repository.write({PATH: rest, NEW_PATH: group.replace("clearance", "gap")})
    assert breaking(compare(repository)) == ["arm removed: mass 2.5, width 0.1, clearance 0.2"]


@pytest.mark.parametrize(
    ("parameters", "is_moved"),
    [
        ("[{'rate': 10, 'frame': 'map', 'topic': '/odom'}]", True),
        ("[{'rate': 10}, {'frame': frame}, {'topic': '/odom'}]", True),
        ("[{'rate': 10}]", False),
    ],
)
def test_a_node_moves_to_the_launch_file_that_starts_it(repository, compare, parameters, is_moved):
    launch = make_launch_file("all.yaml").replace('executable="navigator"', 'executable="nav", name="navigator"')
    repository.commit({"arm/package.xml": PACKAGE_XML, PATH: PLANNER + NAVIGATOR, LAUNCH: launch})
    repository.write({PATH: PLANNER, LAUNCH: launch.replace('["config/all.yaml"]', parameters)})
    (change,) = subject(compare(repository), PATH).changes
    text = f"navigator moved to {LAUNCH}" if is_moved else "navigator removed: rate 10, frame map, topic /odom"
    assert str(change.sentence) == text
    assert (change.reason is None) is is_moved
