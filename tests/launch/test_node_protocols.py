"""The protocols through which the host of nodes supports nodes of other packages."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

import pytest

from linkwright.graph import Graph
from linkwright.launch.ros import Node
from linkwright.nodes import EXECUTABLES, NodeOptions
from linkwright.nodes.options import SingleNode, create_node
from linkwright.nodes.watched_files import FileWatcher

INCOMPLETE = (
    "<robot name='boat'><link name='hull'/><joint name='mast' type='fixed'><parent link='hull'/></joint></robot>"
)


class Boat(SingleNode):
    """A third-party node."""

    DEFAULT_NAME = "boat"
    description_parameter = "plan"

    def __init__(self, graph: Graph, options: NodeOptions, hosts: list[FileWatcher]) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME, any_parameters=True)
        self._hosts = hosts
        self.finished: asyncio.Future[int] = asyncio.get_running_loop().create_future()

    def watch_files(self, host: FileWatcher) -> None:
        self._hosts.append(host)
        self._node.get_logger().info(f"called by {host.launcher_node.get_name().rstrip('0123456789')}")
        self.finished.set_result(0)


async def test_foreign_node_has_its_files_watched_and_description_checked(
    launch: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    hosts: list[FileWatcher] = []
    entry = type("EntryPoint", (), {"load": staticmethod(lambda: lambda graph, options: Boat(graph, options, hosts))})()
    monkeypatch.setitem(EXECUTABLES.entry_points, ("my_sea", "boat"), entry)
    launched = await launch(
        Node(package="my_sea", executable="boat", parameters=[{"plan": INCOMPLETE, "other": "<x/>"}])
    )
    assert len(hosts) == 1
    assert "called by launch_ros_" in launched.err
    assert "joint 'mast'" in launched.err
    assert launched.err.count("error[") == 1
