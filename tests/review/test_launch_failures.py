"""The lines of a review about Python launch files that fail or choose between lists of nodes."""

from __future__ import annotations


LAUNCH = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

BOTH = ["left", "right"]
ONE = ["left"]
TABLE = {"both": 1, "one": 2, "none": 3}


def spawner(name):
    return Node(package="controller_manager", executable="spawner", arguments=[name])


def setup(context):
    kind = LaunchConfiguration("kind").perform(context)
    if kind not in ("both", "one"):
        raise RuntimeError("no such kind")
    nodes = []
    if kind == "both":
        nodes.extend(spawner(item) for item in BOTH)
    return nodes


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("kind", default_value="both"),
        OpaqueFunction(function=setup),
    ])
"""
CHECK = '    if kind not in ("both", "one"):\n        raise RuntimeError("no such kind")\n'
NESTED = "".join(f"    {line}\n" for line in CHECK.splitlines())
ARGUMENT = '        DeclareLaunchArgument("kind"'


def test_a_loop_over_a_chosen_list_starts_the_same_nodes(review_changes):
    new = 'names = BOTH if kind == "both" else ONE\n        nodes.extend(spawner(item) for item in names)'
    assert review_changes("arm.launch.py", LAUNCH, "nodes.extend(spawner(item) for item in BOTH)", new) == ([], [])


def test_the_items_of_a_chosen_list_have_its_condition(review_changes):
    old, new = (f"in (BOTH if kind == 'both' and {name} else ONE)" for name in ("gpu", "cpu"))
    text = LAUNCH.replace("in BOTH", old)
    spawned = "controller_manager/spawner' of"
    changes, found_breaking = review_changes("arm.launch.py", text, old, new)
    assert any(f"{spawned} 'right'" in change and "and cpu`" in change for change in changes)
    assert found_breaking == []


def test_no_controller_is_lost_and_none_has_the_name_of_a_variable_if_a_list_is_unknown(review_changes):
    changes, found_breaking = review_changes("arm.launch.py", LAUNCH, "for item in BOTH", "for item in load(kind)")
    assert any("'$(eval item)'" in change for change in changes)
    assert found_breaking == []
