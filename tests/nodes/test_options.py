"""The command line of a node, and the options that it starts with."""

import os
import sys
from unittest.mock import MagicMock

import numpy as np
import pytest

from linkwright.geometry.octrees import encode_octree
from linkwright.graph import LogLevel
from linkwright.nodes import EXECUTABLES, NodeOptions
from linkwright.nodes.options import create_node, find_default_name
from linkwright.vision.cameras.video import VideoSource
from tests.navigation.nodes.test_cartographer import CONFIGURATION
from tests.nodes.harness import joint, robot
from tests.speech.nodes import fake_sounddevice

ARGUMENTS = {
    "static_transform_publisher": ["--frame-id", "a", "--child-frame-id", "b"],
    "tf2_echo": ["a", "b"],
    "spawn_entity.py": ["-entity", "a", "-topic", "b"],
    "create": ["-topic", "a"],
    "delete_entity": ["--name", "a"],
    "set_entity_pose": ["--name", "a", "--pos", "0", "0", "0"],
    "spawner": ["a"],
    "spawner.py": ["a"],
    "unspawner": ["a"],
    "unspawner.py": ["a"],
    "lifecycle_manager": ["--ros-args", "-p", "node_names:=[a]"],
    "hardware_spawner": ["a", "--activate"],
    "relay": ["a"],
    "throttle": ["messages", "a", "1"],
    "drop": ["a", "1", "2"],
    "delay": ["a", "1"],
    "mux": ["a", "b"],
    "demux": ["a", "b"],
    "transform": ["a", "b", "std_msgs/String"],
    "relay_field": ["a", "b", "std_msgs/String", "{data: m.data}"],
}
NAMED_BY_THEMSELVES = (
    *(f"{un}spawner{end}" for un in ("", "un") for end in ("", ".py")),
    "static_transform_publisher",
    "transform",
    "relay_field",
)
"""Nodes whose default names contain a number that differs each time."""

PARAMETERS = {
    "robot_description": robot(joint("a")),
    "robot_description_semantic": "<robot name='test'><group name='g'><chain base_link='base' tip_link='a_link'/>"
    "</group></robot>",
    "moveit_servo.move_group_name": "g",
    "port": 0,  # any free port, for the bridge
    "entity_name": "a",
    "node_names": ["a"],
    "joints": ["a"],
    "goal_names": ["numbers", "point"],
    "target_frames": ["base"],
    "numbers": [0.0],
    "point.positions": [0.0],
}
"""The parameters without which a node does not start."""

NEED_A_TERMINAL = ("teleop_twist_keyboard",)


@pytest.fixture
def terminal():
    """Return the terminal of nodes that need one."""
    if sys.platform == "win32":
        yield None
        return
    sides = os.openpty()
    yield sides[1]
    for side in sides:
        os.close(side)


@pytest.fixture(autouse=True)
def microphone(monkeypatch):
    """Return the microphone of a machine that has one."""
    monkeypatch.setitem(sys.modules, "sounddevice", fake_sounddevice)


@pytest.fixture(autouse=True)
def camera(monkeypatch):
    """Return the camera of a machine that has one, which sends no images."""
    monkeypatch.setattr(VideoSource, "_open", lambda *_: MagicMock(**{"read.return_value": (False, None)}))


@pytest.fixture
def files(tmp_path):
    """Return the folder with the files that nodes need: a configuration of Cartographer, and an octomap."""
    (tmp_path / "robot.lua").write_text(f"{CONFIGURATION}\nreturn options\n")
    data, size = encode_octree((0, 0, 0), np.full((1, 1, 1), 2))
    header = f"# Octomap OcTree binary file\nid OcTree\nsize {size}\nres 0.1\ndata\n"
    (tmp_path / "map.bt").write_bytes(header.encode() + data)
    return tmp_path


def make_options(executable, files, **fields):
    arguments = ARGUMENTS.get(executable[1], [])
    if executable[1] == "cartographer_node":
        arguments = ["-configuration_directory", str(files), "-configuration_basename", "robot.lua"]
    parameters = {**PARAMETERS, "octomap_path": str(files / "map.bt")}
    return NodeOptions(parameters=parameters, arguments=arguments, **fields)


@pytest.mark.parametrize("executable", EXECUTABLES, ids="/".join)
async def test_executables_start_and_close(harness, executable, files, terminal):
    options = make_options(
        executable,
        files,
        name="mine",
        namespace="/robot",
        library=harness.library,
        terminal=terminal,
    )
    if executable[0] in NEED_A_TERMINAL and terminal is None:
        pytest.skip("Windows has no pseudo-terminals")
    running = EXECUTABLES[executable](harness.graph, options)
    assert running.node.get_fully_qualified_name() == "/robot/mine"
    running.close()
    running.close()
    await harness.clock.advance(1.0)
    assert harness.graph.node_names() == ["/test_node"]


@pytest.mark.parametrize("executable", EXECUTABLES, ids="/".join)
async def test_default_name_matches_started_node(harness, executable, files, terminal):
    options = make_options(
        executable,
        files,
        library=harness.library,
        terminal=terminal,
    )
    if executable[0] in NEED_A_TERMINAL and terminal is None:
        pytest.skip("Windows has no pseudo-terminals")
    running = EXECUTABLES[executable](harness.graph, options)
    name = find_default_name(*executable)
    assert running.node.get_name() == name or (name is None and executable[1] in NAMED_BY_THEMSELVES)
    running.close()


async def test_log_level_argument_is_applied(graph):
    node, other_options = create_node(graph, NodeOptions(arguments=["--ros-args", "--log-level", "warn"]), "node")
    assert node.get_logger().level is LogLevel.WARN
    assert other_options == []


async def test_ros_arguments_are_applied(graph, tmp_path):
    file = tmp_path / "p.yaml"
    file.write_text("/robot/renamed: {ros__parameters: {a: 1, b: 1}}\nnode: {ros__parameters: {b: 2}}\n")
    words = ["x", "--ros-args", "-r", "node:__node:=renamed", "-r", "__ns:=/robot", "--params-file", str(file)]
    words += ["--log-level", "other:=error", "--disable-rosout-logs"]
    node, other_options = create_node(graph, NodeOptions(arguments=words, parameters={"b": 3, "c": 3}), "node")
    assert node.get_fully_qualified_name() == "/robot/renamed"
    assert [node.declare_parameter(name, 0).value for name in "abc"] == [1, 1, 3]
    assert graph.get_logger("other").level is LogLevel.ERROR
    assert "/rosout" not in graph.topics()
    assert other_options == ["x"]
