"""turtlesim_node in launch files: it runs in this process, and the launch has a page for it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from launch.actions import IncludeLaunchDescription, LogInfo, RegisterEventHandler
from launch.event_handlers import OnProcessExit
from launch_ros.actions import Node

from linkwright.packages import PackageFinder
from linkwright.panels.turtlesim import TurtlesimFeature
from tests.launch.ending import end_when, has_printed, run_when
from tests.launch.test_rqt import end_node


def make_turtlesim(**options) -> Node:
    return Node(package="turtlesim", executable="turtlesim_node", **options)


def list_shown_nodes(context) -> list[list[str]]:
    """Return the names of the nodes that each viewer shows."""
    viewers = [viewer for _, viewer in context.session.host._viewers._viewers.values()]
    features = [viewer.add_feature(TurtlesimFeature) for viewer in viewers]
    return [[entry.name for entry in feature.opening_messages()[0].simulators] for feature in features]


@pytest.mark.parametrize("with_rviz", [False, True])
async def test_nodes_share_a_page(launch, with_rviz: bool) -> None:
    shown: list[list[str]] = []

    def look(context) -> bool:
        shown[:] = list_shown_nodes(context)
        return bool(shown) and len(shown[0]) == 2

    nodes = [make_turtlesim(namespace=name) for name in ("a", "b")]
    viewers = [Node(package="rviz2", executable="rviz2")] if with_rviz else []
    result = await launch(*nodes, *viewers, end_when(look))
    assert result.succeeded, result.err
    assert shown == [["/a/turtlesim", "/b/turtlesim"]]
    assert result.out.count("Viewer: ") == 1


async def test_launch_ends_with_its_last_turtlesim(launch) -> None:
    node = make_turtlesim()
    handler = OnProcessExit(target_action=node, on_exit=[LogInfo(msg="the window was closed")])
    started = has_printed("Spawning turtle [turtle1]")
    result = await launch(RegisterEventHandler(handler), node, run_when(started, end_node(node)))
    assert result.succeeded, result.err
    assert result.messages == ["the window was closed"]


async def test_multisim_of_the_package_starts_two_nodes(launch) -> None:
    path = PackageFinder().share("turtlesim") / "launch" / "multisim.launch.py"
    result = await launch(IncludeLaunchDescription(str(path)), end_when(has_printed("Spawning turtle", times=2)))
    assert result.succeeded, result.err
    assert "[turtlesim2.turtlesim]: Starting turtlesim with node name /turtlesim2/turtlesim" in result.out + result.err


async def test_parameters_of_a_file_apply(launch, write: Callable[[str, str], Path]) -> None:
    file = write("turtlesim.yaml", "/turtlesim2/sim:\n  ros__parameters: {background_r: 255}\n")
    backgrounds = []

    def look(context) -> bool:
        node = context.session.host.find_node("/turtlesim2/sim")
        if node is not None:
            backgrounds.append(node.get_parameter("background_r").value)
        return bool(backgrounds)

    result = await launch(make_turtlesim(namespace="turtlesim2", name="sim", parameters=[str(file)]), end_when(look))
    assert result.succeeded, result.err
    assert backgrounds == [255]
