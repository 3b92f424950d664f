"""The lines of a review about words that Python launch files add to lists, and about values of the launch context."""

from __future__ import annotations

import pytest

COMMAND = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, OpaqueFunction
from launch_ros.actions import ComposableNodeContainer, Node
from launch_ros.descriptions import ComposableNode


def start(context):
    sim = context.launch_configurations["sim"]
    file = "joy_" + context.launch_configurations.get("joy", "a") + ".yaml"
    command = ["python3", "make.py"]
    if sim == "true":
        command.append("--sim")
    command.extend(["--out", "x"])
    return [
        ExecuteProcess(cmd=command),
        Node(package="arm", executable="driver", name=sim, parameters=[file]),
    ]


def generate_launch_description():
    return LaunchDescription([DeclareLaunchArgument("sim", default_value="false"), OpaqueFunction(function=start)])
"""


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (
            '["python3", "make.py"]\n    if sim == "true":\n        command.append("--sim")\n',
            '["python3", "make.py", "--fast"]\n    if sim == "true":\n        command.append("--sim")\n',
            "process 'python3': command: --fast added",
        ),
        (
            '    if sim == "true":\n        command.append("--sim")\n',
            "",
            "process 'python3': command [python3, make.py, --sim (if `sim == 'true'`), --out, x] -> [python3,",
        ),
        ('"--out", "x"', '"--out", "y"', "process 'python3': command: y added, x removed"),
        ("name=sim", 'name=context.launch_configurations["mode"]', "node 'arm/driver': name $(var sim) -> $(var mode)"),
        ('"joy", "a"', '"joy", "b"', "node 'arm/driver': parameters [joy_$(var joy a).yaml] -> [joy_$(var joy b)"),
    ],
)  # fmt: skip
def test_words_added_to_a_list_and_values_of_the_context_are_read(review_changes, old, new, expected):
    found, _ = review_changes("arm.launch.py", COMMAND, old, new)
    assert any(sentence.startswith(expected) for sentence in found), found
    assert not any(sentence.startswith("other code") for sentence in found)


def test_old_names_of_the_arguments_of_nodes_are_no_change(review_changes):
    node = 'ComposableNode(package="arm", node_plugin="arm::Driver", node_name="d", node_namespace="n")'
    text = COMMAND.replace("    return [\n", f"    return [\n        {node},\n")
    assert review_changes("arm.launch.py", text, node, node.replace("node_", "")) == ([], [])
