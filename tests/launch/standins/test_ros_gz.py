"""The actions of ros_gz_sim and ros_gz_bridge, in Python and as tags."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from launch.substitutions import TextSubstitution
from ros_gz_bridge.actions import RosGzBridge
from ros_gz_sim.actions import GzServer, GzSpawnModel

from linkwright.launch.frontend.launch_file import load_launch_file
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.ros import Node

Write = Callable[[str, str], Path]
TAGS = """
<launch>
  <gz_server world_sdf_file="empty.sdf" use_composition="True" create_own_container="True"/>
  <ros_gz_bridge bridge_name="hands" config_file="bridge.yaml" namespace="robot">
    <param name="lazy" value="true"/>
  </ros_gz_bridge>
  <gz_spawn_model file="box.sdf" entity_name="box" x="1.5" allow_renaming="True"/>
</launch>
"""


@pytest.fixture
def started(monkeypatch: pytest.MonkeyPatch) -> list[dict[str, Any]]:
    """Return the arguments from which nodes are created."""
    arguments: list[dict[str, Any]] = []
    init = Node.__init__

    def note(self: Node, **words: Any) -> None:
        arguments.append(words)
        init(self, **words)

    monkeypatch.setattr(Node, "__init__", note)
    return arguments


def test_gz_server_passes_world_file_or_string(started: list[dict[str, Any]]) -> None:
    for options in ({"world_sdf_file": "a.sdf"}, {"world_sdf_string": [TextSubstitution(text="<sdf/>")]}):
        GzServer(**options, use_composition=True).execute(LaunchContext())
    assert [words["parameters"] for words in started] == [
        [{"world_sdf_file": "a.sdf"}],
        [{"world_sdf_string": "<sdf/>"}],
    ]


def test_gz_spawn_model_passes_pose_and_topic(started: list[dict[str, Any]]) -> None:
    GzSpawnModel(topic="robot_description", entity_name="mbot", z=0.2, yaw="1.5").execute(LaunchContext())
    words = started[0]["arguments"]
    pairs = dict(zip(words[::2], words[1::2], strict=True))
    assert (pairs["-topic"], pairs["-name"], pairs["-z"], pairs["-Y"]) == ("robot_description", "mbot", "0.2", "1.5")
    assert pairs["-allow_renaming"] == "false"
    assert "-file" not in pairs


def test_ros_gz_bridge_passes_extra_parameters(started: list[dict[str, Any]]) -> None:
    bridge = RosGzBridge(bridge_name="hands", config_file="b.yaml", extra_bridge_params=[{"lazy": True}])
    bridge.execute(LaunchContext())
    assert started[0]["name"] == "hands"
    assert started[0]["parameters"][0] == {"config_file": "b.yaml"}
    assert len(started[0]["parameters"]) == 2


def test_gz_tags_create_actions(started: list[dict[str, Any]], write: Write) -> None:
    description = load_launch_file(write("a.launch.xml", TAGS))
    for entity in description.entities:
        entity.execute(LaunchContext())
    assert [words["executable"] for words in started] == ["gzserver", "parameter_bridge", "create"]
    assert started[0]["parameters"] == [{"world_sdf_file": "empty.sdf"}]
    assert started[1]["namespace"] == "robot"
    assert "true" in started[2]["arguments"]
