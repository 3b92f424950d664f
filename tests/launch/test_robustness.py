"""Launch files that are endless, recursive or deeply nested: one error with the location."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.launch import LaunchTarget, print_description, show_arguments
from linkwright.launch.arguments import check_arguments
from linkwright.launch.engine.processes import _MAX_LINE_LENGTH, _LineSplitter
from linkwright.launch.frontend.include import IncludeLaunchDescription
from linkwright.launch.frontend.launch_file import load_launch_file
from linkwright.launch.ros import Node, PushRosNamespace

Write = Callable[[str, str], Path]

HEAD = """import sys
from launch import LaunchDescription
from launch.actions import *
from launch.conditions import IfCondition
"""

AGAIN_AND_AGAIN = {
    "itself.launch.py": HEAD
    + "def generate_launch_description():\n    return LaunchDescription([IncludeLaunchDescription(__file__)])\n",
    "twice.launch.py": HEAD
    + "def generate_launch_description():\n    return LaunchDescription([IncludeLaunchDescription(__file__)] * 2)\n",
    "itself.launch.xml": '<launch>\n  <include file="$(dirname)/itself.launch.xml"/>\n</launch>\n',
    "itself.launch.yaml": "launch:\n- include: $(dirname)/itself.launch.yaml\n",
    "one.launch.xml": '<launch>\n  <include file="$(dirname)/other.launch.yaml"/>\n</launch>\n',
    "other.launch.yaml": "launch:\n- include:\n    file: $(dirname)/one.launch.xml\n",
    "function.launch.py": HEAD
    + "def again(context):\n    return [OpaqueFunction(function=again)]\n"
    + "def generate_launch_description():\n    return LaunchDescription([OpaqueFunction(function=again)])\n",
}
"""Launch files that include themselves or each other, or repeat an action endlessly."""


@pytest.mark.parametrize("name", AGAIN_AND_AGAIN)
async def test_recursive_includes_and_actions_are_one_error(launch, write: Write, name: str) -> None:
    for file_name, text in AGAIN_AND_AGAIN.items():
        write(file_name, text)
    path = write(name, AGAIN_AND_AGAIN[name])
    result = await launch(IncludeLaunchDescription(str(path)))
    assert not result.succeeded
    assert result.err.count("error[") == 1
    assert "error[LAUNCH156]" in result.err
    assert f"{path.parent}" in result.err
    assert "asyncio" not in result.err
    assert result.err.count("included from here") <= 3  # each location is listed once


def test_arguments_of_recursive_include_are_listed(write: Write) -> None:
    path = write(
        "countdown.launch.py",
        HEAD
        + "def generate_launch_description():\n"
        + "    again = IncludeLaunchDescription(__file__, condition=IfCondition('false'))\n"
        + "    return LaunchDescription([DeclareLaunchArgument('rounds', default_value='3'), again])\n",
    )
    assert "'rounds':" in show_arguments(LaunchTarget(str(path)))
    assert check_arguments(load_launch_file(path), {"rounds": "2", "other": "1"}) == []
    with pytest.raises(LinkwrightError) as caught:
        print_description(LaunchTarget(str(path)))
    assert [diagnostic.code for diagnostic in caught.value.diagnostics] == ["LAUNCH156"]


DEEP = {
    "groups.launch.xml": "<launch>" + "<group>" * 900 + "</group>" * 900 + "</launch>",
    "substitutions.launch.xml": '<launch><log_info message="' + "$(var " * 900 + "x" + ")" * 900 + '"/></launch>',
    "groups.launch.yaml": "launch:\n- group: " + "[{group: " * 400 + "[]" + "}]" * 400,
    "lists.launch.yaml": "launch: " + "[" * 700 + "]" * 700,
}


@pytest.mark.parametrize("name", DEEP)
def test_too_deeply_nested_file_is_rejected(write: Write, name: str) -> None:
    with pytest.raises(LinkwrightError) as caught:
        load_launch_file(write(name, DEEP[name]))
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == "LAUNCH156"
    assert name in diagnostic.message


@pytest.mark.parametrize("text", ["launch: &a\n- group: *a\n", "launch:\n- node: &n\n    pkg: a\n    more: {x: *n}\n"])
def test_recursive_yaml_alias_is_rejected(write: Write, text: str) -> None:
    with pytest.raises(LinkwrightError) as caught:
        load_launch_file(write("a.launch.yaml", text))
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == "LAUNCH108"
    assert "refers to a node that contains it" in diagnostic.message
    assert diagnostic.span is not None
    assert diagnostic.span.line == len(text.splitlines())


def test_yaml_anchor_can_be_reused(write: Write) -> None:
    text = "launch:\n- group: &g\n  - log_info: {message: a}\n- group: *g\n"
    assert len(load_launch_file(write("a.launch.yaml", text)).entities) == 2


ENDED = HEAD + "def stop(context):\n    sys.exit({given})\n"
TAIL = (
    "def generate_launch_description():\n    {first}\n    return LaunchDescription([OpaqueFunction(function=stop)])\n"
)


@pytest.mark.parametrize(("exit_argument", "message"), [("'I give up'", "I give up"), ("3", "3"), ("", ""), ("0", "0")])
async def test_sys_exit_in_running_launch_is_an_error(launch, write: Write, exit_argument: str, message: str) -> None:
    path = write("a.launch.py", (ENDED + TAIL).format(given=exit_argument, first="pass"))
    result = await launch(IncludeLaunchDescription(str(path)))
    assert not result.succeeded
    assert f"raised SystemExit{': ' * bool(message)}{message}\n" in result.err
    assert "a.launch.py:6:5" in result.err


@pytest.mark.parametrize("text", [HEAD + "sys.exit('no')\n", (ENDED + TAIL).format(given="'no'", first="stop(1)")])
def test_sys_exit_while_loading_launch_file_is_an_error(write: Write, text: str) -> None:
    with pytest.raises(LinkwrightError) as caught:
        load_launch_file(write("a.launch.py", text))
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.message.endswith("raised SystemExit: no")
    assert diagnostic.span is not None


@pytest.mark.parametrize("text", [HEAD + "sys.exit()\n", (ENDED + TAIL).format(given="0", first="stop(1)")])
def test_sys_exit_with_status_0_while_loading_is_passed_on(write: Write, text: str) -> None:
    with pytest.raises(SystemExit) as caught:
        load_launch_file(write("a.launch.py", text))
    assert not caught.value.code


async def test_recursive_function_is_reported_once(launch, write: Write) -> None:
    text = HEAD + "def stop(context):\n    return stop(context)\n" + TAIL.format(first="pass")
    result = await launch(IncludeLaunchDescription(str(write("a.launch.py", text))))
    assert "raised RecursionError" in result.err
    assert result.err.count("called from here") == 1


def test_generate_function_with_parameters_is_reported(write: Write) -> None:
    with pytest.raises(LinkwrightError) as caught:
        load_launch_file(write("a.launch.py", HEAD + "def generate_launch_description(x):\n    pass\n"))
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.span is not None
    assert diagnostic.span.line == 5


@pytest.mark.parametrize("name", ["机器人", "my node", "a-b", "1st", "x" * 300])
async def test_malformed_node_name_is_rejected(launch, name: str) -> None:
    result = await launch(Node(package="robot_state_publisher", executable="robot_state_publisher", name=name))
    assert not result.succeeded
    assert f"error[LAUNCH134]: node name '{name}' is malformed: node name " in result.err


@pytest.mark.parametrize("namespace", ["机器人", "a b", "a//b", "a/1"])
async def test_malformed_namespace_is_rejected(launch, namespace: str) -> None:
    result = await launch(PushRosNamespace(namespace))
    assert not result.succeeded
    assert f"error[LAUNCH134]: namespace '/{namespace}' is malformed: namespace " in result.err


def test_line_splitter_decodes_and_splits_output() -> None:
    lines = _LineSplitter()
    assert lines.feed(b"one\r\ntw") == ["one"]
    assert lines.feed("o\n\n机".encode()[:-1]) == ["two", ""]
    assert lines.feed("机".encode()[-1:]) == []
    assert lines.feed(b"\xff\n") == ["机\N{REPLACEMENT CHARACTER}"]
    assert lines.feed(b"end\xe6") == []
    assert lines.finish() == ["end\N{REPLACEMENT CHARACTER}"]


def test_long_line_is_split_into_pieces() -> None:
    lines = _LineSplitter()
    pieces = [piece for _ in range(300) for piece in lines.feed(b"x" * 1000)]
    assert [len(piece) for piece in pieces] == [_MAX_LINE_LENGTH] * 3
    assert lines.finish() == []


PARAM = '<launch>\n <arg name="n" default="x"/>\n <node pkg="robot_state_publisher" exec="robot_state_publisher">\n  {}'
WRONG_VALUES = {
    '<param name="p" value="x" type="int"/>': "is 'x', which is not of type 'int'",
    '<param name="p" value="1;x" value-sep=";" type="list_of_float"/>': "'x'], which is not of type 'list_of_float'",
    '<param name="p" value="true;maybe" value-sep=";" type="list_of_bool"/>': "which is not of type 'list_of_bool'",
    '<param name="p" value="1;x" value-sep=";"/>': "is [1, 'x'], whose items have different types",
    '<param name="p" value="$(var n)" type="int"/>': "is not of the requested type int",
}


@pytest.mark.parametrize("tag", WRONG_VALUES)
async def test_parameter_of_wrong_type_is_reported_with_name(launch, write: Write, tag: str) -> None:
    path = write("a.launch.xml", PARAM.format(tag) + "\n </node>\n</launch>\n")
    result = await launch(IncludeLaunchDescription(str(path)))
    assert "error[LAUNCH132]: parameter 'p' " in result.err
    assert WRONG_VALUES[tag] in result.err
    assert f"{path}:4:3" in result.err
