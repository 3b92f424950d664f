"""Nodes of Python launch files that get their arguments from a dictionary or a constant of a call, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

PATH = "crane/launch/crane.launch.py"
OLD = """from launch import LaunchDescription
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        Node(package="bulbs", executable="bulb", name="bulb", parameters=["a.yaml"], remappings=[("light", "sun")]),
    ])
"""
NEW = """from crane.nodes import make_launch


def generate_launch_description():
    return make_launch("bulbs", "bulb", remappings=[("light", "sun")])
"""
HELPER = """from launch import LaunchDescription
from launch_ros.actions import Node


def make_launch(package, executable, name=None, remappings=None):
    settings = {"package": package, "executable": executable, "name": name or executable}
    if name:
        settings["namespace"] = name
    settings["parameters"] = ["a.yaml"]
    if remappings:
        settings["remappings"] = remappings
    node = Node(**settings)
    return LaunchDescription([node])
"""
UNKNOWN = HELPER.replace("{", "read({").replace("}", "})")


@pytest.mark.parametrize(
    ("call", "helper", "expected"),
    [
        ('"bulbs", "bulb", ', HELPER, []),
        ('"bulbs", "bulb", "sun", ', HELPER, ["name bulb -> sun", "namespace sun added"]),
        ('"bulbs", "bulb", ', UNKNOWN, ["node 'Node' added", "node 'bulbs/bulb' removed"]),
    ],
)
def test_a_helper_that_unpacks_a_dictionary_starts_the_same_node(repository, compare, call, helper, expected):
    manifest = PACKAGE_XML.replace("arm_description", "crane")
    files = {"crane/package.xml": manifest, "crane/crane/__init__.py": "", PATH: OLD}
    repository.commit(files)
    changed = manifest.replace("<version>1", "<version>2")
    new = NEW.replace('"bulbs", "bulb", ', call)
    repository.write({PATH: new, "crane/crane/nodes.py": helper, "crane/package.xml": changed})
    result = compare(repository)
    lines = [line for line in sentences(subject(result, PATH)) if line.startswith("node ")]
    assert len(lines) == len(expected)
    assert all(any(text in line for line in lines) for text in expected), lines
    assert not [line for line in breaking(result) if "removed" in line]
    assert not result.fixed_findings


STAGES = """from launch import LaunchDescription
from launch.actions import TimerAction
from launch_ros.actions import Node


def stage(name, delay):
    node = Node(package="crane", executable=name)
    if delay > 0:
        return TimerAction(period=delay, actions=[node])
    return TimerAction(period=0.0, actions=[node])


def generate_launch_description():
    return LaunchDescription([stage("bulb", 0.0), stage("sun", 5.0)])
"""
CHECK = "    if delay > 0:\n        return TimerAction(period=delay, actions=[node])\n"


def test_a_comparison_of_a_constant_of_a_call_is_known(review_changes):
    text = STAGES.replace("period=0.0", "period=delay")
    assert review_changes("crane.launch.py", text, CHECK, "")[1] == []
    changes, _ = review_changes("crane.launch.py", STAGES, "delay > 0", "delay > 9")
    assert [change for change in changes if "if `" in change] == []
    assert any("after 5.0 s -> after 0.0 s" in change for change in changes), changes
