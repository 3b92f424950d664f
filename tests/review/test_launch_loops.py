"""The lines of a review about loops of Python launch files that number or join items."""

from __future__ import annotations

import pytest

LAUNCH = """from launch import LaunchDescription
from launch_ros.actions import Node

SIDES = ["left", "right"]
PORTS = [("left", (1, "a")), ("right", (2, "b"))]
IDS = ["one", "two"]


def generate_launch_description():
    actions = []
    for TARGET in ITEMS:
        actions.append(Node(package="arm", executable="driver", name=f"NAME", output="screen"))
    return LaunchDescription(actions)
"""
LOOPS = [
    ("number, side", "enumerate(SIDES)", "{side}_{number}", ["left_0", "right_1"]),
    ("number, (side, (port, _))", "enumerate(PORTS)", "{side}_{number}_{port}", ["left_0_1", "right_1_2"]),
    ("side, part", "zip(SIDES, IDS)", "{side}_{part}", ["left_one", "right_two"]),
]


@pytest.mark.parametrize(("target", "items", "name", "expected"), LOOPS)
def test_nodes_of_numbered_loops_are_known(review_changes, target, items, name, expected):
    text = LAUNCH.replace("TARGET", target).replace("ITEMS", items).replace("NAME", name)
    found, _ = review_changes("arm.launch.py", text, text, text.replace(name, f"{name}_x"))
    assert found == [f"node 'arm/driver': name {each} -> {each}_x" for each in expected]


@pytest.mark.parametrize(("target", "items", "name"), [loop[:3] for loop in LOOPS])
def test_a_new_item_of_a_loop_is_a_new_node(review_changes, target, items, name):
    text = LAUNCH.replace("TARGET", target).replace("ITEMS", items).replace("NAME", name)
    new = text.replace('"right"]', '"right", "top"]').replace('(2, "b"))]', '(2, "b")), ("top", (3, "c"))]')
    new = new.replace('"two"]', '"two", "three"]')
    found, _ = review_changes("arm.launch.py", text, text, new)
    assert any(line.startswith("node 'arm/driver' added: name top_") for line in found), found


def test_an_item_that_only_a_condition_reads_starts_a_node_and_is_other_code(review_changes):
    text = LAUNCH.replace("TARGET", "number, (side, (port, _))").replace("ITEMS", "enumerate(PORTS)")
    text = text.replace("NAME", "{side}_{number}").replace(
        "        actions.append", "        if port:\n            actions.append"
    )
    found, _ = review_changes("arm.launch.py", text, text, text.replace('(2, "b")', '(0, "b")'))
    old, new = (f"[('left', (1, 'a')), ('right', ({number}, 'b'))]" for number in (2, 0))
    assert found == ["node 'arm/driver' removed: name right_1, output screen", f"values of 'PORTS': {old} -> {new}"]


@pytest.mark.parametrize("items", ["zip(SIDES, other())", "enumerate(other())", "enumerate(SIDES, start=1)"])
def test_loops_over_unknown_items_have_one_node(review_changes, items):
    text = LAUNCH.replace("TARGET", "a, b").replace("ITEMS", items).replace("NAME", "{a}")
    found, _ = review_changes("arm.launch.py", text, text, text.replace('output="screen"', 'output="log"'))
    assert len(found) == 1


@pytest.mark.parametrize("addition", ["points.append(text)", "points += [text]"])
@pytest.mark.parametrize(("target", "items"), [("x", "points"), ("i, x", "enumerate(points)")])
def test_a_loop_over_a_list_that_statements_fill_has_one_node(review_changes, addition, target, items):
    text = LAUNCH.replace("TARGET", target).replace("ITEMS", items).replace("NAME", "{x}")
    text = text.replace(
        "    actions = []", f"    points = []\n    for text in read():\n        {addition}\n    actions = []"
    )
    found, _ = review_changes("arm.launch.py", text, text, text.replace('output="screen"', 'output="log"'))
    assert found == ["node 'arm/driver': output screen -> log"]
