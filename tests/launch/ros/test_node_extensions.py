"""Extensions of the node action, found through the entry points of launch_ros."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from launch.actions import Shutdown, TimerAction
from launch.substitutions import TextSubstitution
from launch_ros.actions import Node
from launch_ros.actions.node import NodeActionExtension

from linkwright.launch.ros import node_extensions


class Remapping(NodeActionExtension):
    """An extension that renames the node, and remaps a topic."""

    def prepare_for_execute(self, context: Any, ros_specific_arguments: Any, node_action: Any) -> Any:
        assert node_action.is_node_name_fully_specified()
        changed = {**ros_specific_arguments, "name": "__node:=other"}
        return [TextSubstitution(text="-r"), TextSubstitution(text=f"chatter:={self.NAME}")], changed


class BrokenExtension:
    def __init__(self) -> None:
        raise RuntimeError("no license")


@dataclass
class Entry:
    loaded: Any

    def load(self) -> Any:
        return self.loaded


@pytest.fixture
def install(monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., None]]:
    """Install extensions with given names."""

    def install_extensions(**found: Any) -> None:
        entries = {name: Entry(extension) for name, extension in found.items()}
        monkeypatch.setattr(
            node_extensions, "extensions", lambda group: entries if group == node_extensions.GROUP else {}
        )
        node_extensions.node_extensions.cache_clear()

    yield install_extensions
    node_extensions.node_extensions.cache_clear()


def install_tell_program(tmp_path: Path, **options: Any) -> Node:
    program = tmp_path / "tell"
    program.write_text(f"#!{sys.executable}\nimport json, sys\nprint(json.dumps(sys.argv[1:]))\n")
    program.chmod(0o755)
    return Node(executable=str(program), name="talker", namespace="ns", output="screen", **options)


async def test_extension_changes_process_arguments(launch, install, tmp_path: Path) -> None:
    install(mine=Remapping)
    result = await launch(install_tell_program(tmp_path))
    words = json.loads(result.out.partition("] ")[2])
    assert words == ["--ros-args", "-r", "__node:=other", "-r", "__ns:=/ns", "-r", "chatter:=mine"]


async def test_extension_changes_hosted_node(launch, install, tmp_path: Path) -> None:
    install(mine=Remapping)
    urdf = '<robot name="r"><link name="base"/></robot>'
    options: dict[str, Any] = {"parameters": [{"robot_description": urdf}], "namespace": "ns", "name": "given"}
    node = Node(package="robot_state_publisher", executable="robot_state_publisher", **options)
    result = await launch(node, TimerAction(period=0.3, actions=[Shutdown()]))
    assert "[robot_state_publisher-1] [INFO]" in result.err
    assert "[ns.other]" in result.err


async def test_extension_that_cannot_be_loaded_is_reported(launch, install, tmp_path: Path) -> None:
    install(broken=BrokenExtension)
    result = await launch(install_tell_program(tmp_path))
    assert not result.succeeded
    assert "error[LAUNCH155]: the node extension 'broken' cannot be loaded: no license" in result.err


async def test_node_without_extensions_has_default_arguments(launch, install, tmp_path: Path) -> None:
    install()
    result = await launch(install_tell_program(tmp_path))
    assert json.loads(result.out.partition("] ")[2]) == ["--ros-args", "-r", "__node:=talker", "-r", "__ns:=/ns"]
