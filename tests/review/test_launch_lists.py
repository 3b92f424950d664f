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
        ('"--out", "x"', '"--out", "y"', "process 'python3': command: --out x -> y"),
        ("name=sim", 'name=context.launch_configurations["mode"]', "node 'arm/driver': name $(var sim) -> $(var mode)"),
        ('"joy", "a"', '"joy", "b"', "node 'arm/driver': parameters [joy_$(var joy a).yaml] -> [joy_$(var joy b)"),
    ],
)  # fmt: skip
def test_words_added_to_a_list_and_values_of_the_context_are_read(review_changes, old, new, expected):
    found, _ = review_changes("arm.launch.py", COMMAND, old, new)
    assert any(sentence.startswith(expected) for sentence in found), found
    assert not any(sentence.startswith("other code") for sentence in found)


def test_old_names_of_the_arguments_of_nodes_change_no_node(review_changes):
    node = 'ComposableNode(package="arm", node_plugin="arm::Driver", node_name="d", node_namespace="n")'
    text = COMMAND.replace("    return [\n", f"    return [\n        {node},\n")
    line = "no longer uses 'node_plugin', 'node_name', 'node_namespace', which ROS 2 Galactic and later refuse"
    assert review_changes("arm.launch.py", text, node, node.replace("node_", "")) == ([line], [])


MESSAGES = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, LogInfo, RegisterEventHandler
from launch.event_handlers import OnProcessExit
from launch.substitutions import LaunchConfiguration
from other_package import state_publisher


def generate_launch_description():
    load = ExecuteProcess(cmd=["ros2", "control", "load_controller", "--set-state", "active", "state"])
    left = ExecuteProcess(cmd=["ros2", "control", "load_controller", "--set-state", "active", "left"])
    right = ExecuteProcess(cmd=["ros2", "control", "load_controller", "--set-state", "active", "right"])
    publisher = state_publisher.load_node(name="arm")
    return LaunchDescription([
        load,
        publisher,
        RegisterEventHandler(OnProcessExit(target_action=load, on_exit=[right])),
    ])
"""
LOG = '        LogInfo(msg=["port ", LaunchConfiguration("port")]),\n'
HANDLER = "        RegisterEventHandler(OnProcessExit(target_action=load, on_exit=[left])),\n"


def test_an_event_handler_is_told_by_the_commands_that_it_starts(repository, compare):
    repository.commit({"arm/launch/arm.launch.py": MESSAGES})
    before = "        RegisterEventHandler("
    repository.write({"arm/launch/arm.launch.py": MESSAGES.replace(before, HANDLER + before)})
    (launch,) = compare(repository).subjects
    (change,) = [change for change in launch.changes if "event handler" in str(change.sentence)]
    assert str(change.sentence).endswith("on_exit ['ros2 control load_controller ... left']")
    assert change.location.line == MESSAGES[: MESSAGES.index(before)].count("\n") + 1


def test_a_handler_that_starts_a_changed_process_is_no_other_change(review_changes):
    found, _ = review_changes("arm.launch.py", MESSAGES, '"active", "right"', '"active", "arm"')
    assert found == ["process 'ros2': command: arm added, right removed"]


def test_actions_for_each_item_of_a_list_are_no_other_code(review_changes):
    loop = 'LogInfo(msg=["camera ", name]) for name in ["front", "back"]'
    found, _ = review_changes("arm.launch.py", MESSAGES, "        load,\n", f"        load,\n        *[{loop}],\n")
    assert found == ["log message added: camera front", "log message added: camera back"]


def test_the_default_of_an_argument_that_is_the_argument_itself(review_changes):
    declared = 'DeclareLaunchArgument("port", default_value=LaunchConfiguration("port", default="{}"))'
    text = MESSAGES.replace("        load,\n", f"        {declared.format('a')},\n        load,\n")
    found, _ = review_changes("arm.launch.py", text, declared.format("a"), declared.format("b"))
    assert found == ["argument 'port': default a -> b"]


def test_log_messages_are_actions(review_changes):
    found, found_breaking = review_changes("arm.launch.py", MESSAGES, "        load,\n", f"        load,\n{LOG}")
    assert (found, found_breaking) == (["log message added: port $(var port)"], [])


def test_actions_of_other_packages_in_a_sum_of_lists_are_not_removed(repository, compare):
    repository.commit({"arm/launch/arm.launch.py": MESSAGES})
    new = MESSAGES.replace("    return LaunchDescription([\n", "    nodes: list = [\n")
    new = new.replace(
        "on_exit=[right])),\n    ])", "on_exit=[right])),\n    ]\n    return LaunchDescription([] + nodes)"
    )
    repository.write({"arm/launch/arm.launch.py": new})
    assert new.count("nodes") == 2
    assert compare(repository).subjects == []


SPAWNERS = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def start(context):
    arm = LaunchConfiguration("controller")

    def spawn(controllers, active=True):
        flags = ["--inactive"] if not active else []
        return Node(package="controller_manager", executable="spawner", arguments=["-t", "10"] + flags + controllers)

    active = ["state"]
    inactive = ["gripper"]
    return [
        spawn(active),
        spawn(inactive, active=False),
        Node(package="controller_manager", executable="spawner", arguments=[arm]),
    ]


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("controller", default_value="arm"),
            DeclareLaunchArgument("use", default_value="DEFAULT"),
            OpaqueFunction(function=start),
        ]
    )
"""
ARM = """        Node(package="controller_manager", executable="spawner", arguments=[arm]),
"""
APPENDED = """    inactive = ["gripper"]
    if LaunchConfiguration("use").perform(context) == "true":
        active.append(arm.perform(context))
"""


@pytest.mark.parametrize(("default", "is_started"), [("true", True), ("false", False)])
def test_controller_that_another_spawner_gets_by_append_is_started(review_changes, default, is_started):
    text = SPAWNERS.replace("DEFAULT", default)
    old, new = text, text.replace(ARM, "").replace('    inactive = ["gripper"]\n', APPENDED)
    found, found_breaking = review_changes("arm.launch.py", old, old, new)
    title = "node 'controller_manager/spawner' of 'state', '$(var controller)': arguments [-t, 10, state] -> "
    assert any(line.startswith(f"{title}[-t, 10, state, $(var") for line in found)
    assert (found_breaking == []) is is_started


def test_words_of_a_list_that_a_constant_argument_chooses_are_read(review_changes):
    found, _ = review_changes("arm.launch.py", SPAWNERS, 'inactive = ["gripper"]', 'inactive = ["gripper", "tool"]')
    (line,) = found
    assert line.endswith("arguments [-t, 10, --inactive, gripper] -> [-t, 10, --inactive, gripper, tool]")


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ('"/{}/driver".format(sim)', "/$(var sim)/driver"),
        ('"/{0}/driver{1}".format(sim, 2)', "/$(var sim)/driver2"),
        ('"/{robot}/driver".format(robot=sim)', "/$(var sim)/driver"),
        ('"/robot{}".format(int(sim))', "/robot$(var sim)"),
        ('f"/robot{int(sim)}"', "/robot$(var sim)"),
        ('"/%s/driver" % sim', "/$(var sim)/driver"),
        ('"/%s/driver%02d" % (sim, 2)', "/$(var sim)/driver2"),
        ('"100%%_%s" % sim', "100%_$(var sim)"),
        ('"/{}".format(sim) + "_x"', "/$(var sim)_x"),
        ('"/{a[0]}".format(a=sim)', "/{a[0]}.format(a=$(var sim))"),
    ],
)
def test_fields_of_formatted_texts_have_their_values(review_changes, name, text):
    found, _ = review_changes("arm.launch.py", COMMAND, "name=sim", f"name={name}")
    assert f"node 'arm/driver': name $(var sim) -> {text}" in found


def test_a_list_and_a_sum_of_lists_with_the_same_items_are_equal(review_changes):
    found, _ = review_changes("arm.launch.py", COMMAND, "parameters=[file]", "parameters=[file] + []")
    assert found == []


SHELL = """from launch import LaunchDescription
from launch.actions import ExecuteProcess
from launch.substitutions import FindExecutable

def generate_launch_description():
    name = "{}"
    set_state = ExecuteProcess(cmd=[[FindExecutable(name="ros2"), " lifecycle set /", name, " ", "active"]], shell=True)
    return LaunchDescription([set_state, ExecuteProcess(cmd=[FindExecutable(name="router"), ["--to=", name]])])
"""


def test_list_in_a_command_is_one_text(review_changes):
    changes, _ = review_changes("arm.launch.py", SHELL.format("front/arm"), "front/arm", "arm")
    assert changes == [
        "process 'ros2': command ros2 lifecycle set /front/arm active -> ros2 lifecycle set /arm active",
        "process 'router': command [router, --to=front/arm] -> [router, --to=arm]",
    ]


JOINED = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    side = LaunchConfiguration("side", default="left")
    return LaunchDescription([
        DeclareLaunchArgument("side", default_value="left"),
        Node(package="arm", executable="driver"),
    ])
"""


@pytest.mark.parametrize(
    ("added", "expected"),
    [
        (", namespace=[side]", "node 'arm/driver': namespace $(var side) added"),
        (', namespace=["arm_", side]', "node 'arm/driver': namespace arm_$(var side) added"),
        (', parameters=[{"side": side}]', "node 'arm/driver': parameter side $(var side) added"),
        (
            ', parameters=[{"side": LaunchConfiguration("side", default="right")}]',
            "node 'arm/driver': parameter side $(var side right) added",
        ),
    ],
)
def test_texts_are_joined_and_defaults_that_the_argument_has_are_left_out(review_changes, added, expected):
    old = 'executable="driver"'
    found, _ = review_changes("arm.launch.py", JOINED, old, old + added)
    assert found == [expected]
