"""The substitutes for the launch files of nav2_bringup, slam_toolbox and nav2_map_server."""

from __future__ import annotations

import asyncio
import re
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
import yaml
from launch_ros.actions import Node

from linkwright.graph import Graph
from linkwright.launch.frontend.include import IncludeLaunchDescription
from linkwright.launch.ros.skipped_nodes import remove_skipped_nodes
from linkwright.messages import get_message, get_service
from linkwright.navigation.substitutes.servers import Server
from linkwright.nodes import EXECUTABLES, NodeOptions
from linkwright.nodes.options import SingleNode, create_node
from linkwright.packages import PackageFinder, is_substitute
from linkwright.rviz.config.rviz_config import RvizConfig

Launch = Callable[..., Any]
LOCALIZATION = [("nav2_map_server", "map_server"), ("nav2_amcl", "amcl")]
NAVIGATION = [
    ("nav2_controller", "controller_server"),
    ("nav2_smoother", "smoother_server"),
    ("nav2_planner", "planner_server"),
    ("nav2_behaviors", "behavior_server"),
    ("nav2_bt_navigator", "bt_navigator"),
    ("nav2_waypoint_follower", "waypoint_follower"),
    ("nav2_velocity_smoother", "velocity_smoother"),
]
MANAGER = ("nav2_lifecycle_manager", "lifecycle_manager")
SLAM = [(f"slam_toolbox/{kind}_slam_toolbox_node").split("/") for kind in ("async", "sync", "localization")]


def share_folder(package: str) -> Path:
    # Without sources: a checkout of nav2 or slam_toolbox near the start folder would take precedence.
    return PackageFinder(start=Path("/no/such/folder"), environment={}).share(package)


def make_include(package: str, name: str, **arguments: str) -> IncludeLaunchDescription:
    return IncludeLaunchDescription(str(share_folder(package) / "launch" / name), launch_arguments=arguments.items())


class StartedNodes:
    """The nodes that a launch started: executable -> name, parameters and remappings of each."""

    def __init__(self) -> None:
        self.nodes: dict[str, list[tuple[str, dict[str, Any], list[tuple[str, str]]]]] = {}

    def entry_point(self, executable: str) -> Any:
        class Ending(SingleNode):
            DEFAULT_NAME = executable

            def __init__(ending, graph: Graph, options: NodeOptions) -> None:  # noqa: N805 - self is taken
                ending._node, _ = create_node(graph, options, executable)
                ending.finished = asyncio.get_running_loop().create_future()
                ending.finished.set_result(0)
                name = ending._node.get_fully_qualified_name()
                self.nodes.setdefault(executable, []).append((name, options.parameters, list(options.remappings)))

        return type("EntryPoint", (), {"load": staticmethod(lambda: Ending), "distribution": "test"})()

    @property
    def names(self) -> set[str]:
        return {name for nodes in self.nodes.values() for name, _, _ in nodes}

    def node(self, executable: str) -> tuple[str, dict[str, Any], list[tuple[str, str]]]:
        (node,) = self.nodes[executable]
        return node


@pytest.fixture
def started(monkeypatch: pytest.MonkeyPatch) -> StartedNodes:
    started = StartedNodes()
    for package, executable in (*LOCALIZATION, *NAVIGATION, MANAGER, *SLAM, ("nav2_map_server", "map_saver_server")):
        monkeypatch.setitem(EXECUTABLES.entry_points, (package, executable), started.entry_point(executable))
    monkeypatch.delitem(EXECUTABLES.entry_points, ("nav2_collision_monitor", "collision_monitor"), raising=False)
    return started


@pytest.mark.parametrize("package", ["nav2_bringup", "slam_toolbox", "nav2_map_server"])
def test_package_in_workspace_takes_precedence_over_substitute(package: str, tmp_path: Path) -> None:
    assert is_substitute(share_folder(package))
    (tmp_path / "src" / package).mkdir(parents=True)
    (tmp_path / "src" / package / "package.xml").write_text(f"<package><name>{package}</name></package>")
    assert PackageFinder(start=tmp_path, environment={}).share(package) == tmp_path / "src" / package


async def test_localization_launch_starts_map_server_and_amcl(
    launch: Launch, started: StartedNodes, tmp_path: Path
) -> None:
    place = tmp_path / "house.yaml"
    launched = await launch(make_include("nav2_bringup", "localization_launch.py", map=str(place), use_sim_time="True"))
    assert launched.succeeded, launched.err
    assert started.names == {"/map_server", "/amcl", "/lifecycle_manager_localization"}
    _, parameters, remappings = started.node("map_server")
    assert parameters["yaml_filename"] == str(place)
    assert parameters["use_sim_time"] is True
    assert ("/tf", "tf") in remappings
    assert started.node("amcl")[1]["max_particles"] == 2000
    assert started.node("lifecycle_manager")[1] == {
        "use_sim_time": True,
        "autostart": True,
        "node_names": ["map_server", "amcl"],
    }


async def test_navigation_launch_starts_all_servers(launch: Launch, started: StartedNodes) -> None:
    launched = await launch(make_include("nav2_bringup", "navigation_launch.py", autostart="false"))
    assert launched.succeeded, launched.err
    assert started.names == {*(f"/{name}" for _, name in NAVIGATION), "/lifecycle_manager_navigation"}
    manager = started.node("lifecycle_manager")[1]
    assert manager["node_names"] == [name for _, name in NAVIGATION]
    assert manager["autostart"] is False
    assert ("cmd_vel", "cmd_vel_nav") in started.node("controller_server")[2]
    smoothed = started.node("velocity_smoother")[2]
    assert [remapping for remapping in smoothed if "cmd_vel" in remapping[0]] == [
        ("cmd_vel", "cmd_vel_nav"),
        ("cmd_vel_smoothed", "cmd_vel"),
    ]


async def test_missing_server_is_skipped_and_not_managed(
    launch: Launch, started: StartedNodes, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delitem(EXECUTABLES.entry_points, ("nav2_smoother", "smoother_server"))
    launched = await launch(make_include("nav2_bringup", "navigation_launch.py"))
    assert launched.succeeded
    assert "one part of the launch is skipped" in launched.err
    assert "smoother_server" in launched.err
    assert "smoother_server" not in started.node("lifecycle_manager")[1]["node_names"]


async def test_bringup_launch_applies_namespace(launch: Launch, started: StartedNodes) -> None:
    launched = await launch(
        make_include(
            "nav2_bringup", "bringup_launch.py", namespace="red", use_namespace="true", use_composition="False"
        )
    )
    assert launched.succeeded, launched.err
    assert {f"/red/{name}" for _, name in (*LOCALIZATION, *NAVIGATION)} <= started.names
    assert {"/red/lifecycle_manager_localization", "/red/lifecycle_manager_navigation"} <= started.names
    assert started.node("planner_server")[1]["planner_plugins"] == ["GridBased"]


async def test_bringup_launch_with_slam_builds_map(launch: Launch, started: StartedNodes, tmp_path: Path) -> None:
    file = tmp_path / "params.yaml"
    file.write_text("slam_toolbox:\n  ros__parameters:\n    resolution: 0.02\n")
    launched = await launch(
        make_include("nav2_bringup", "bringup_launch.py", slam="True", use_composition="False", params_file=str(file))
    )
    assert launched.succeeded, launched.err
    assert "/map_saver" in started.names
    assert "/slam_toolbox" in started.names
    assert "amcl" not in started.nodes
    assert started.node("sync_slam_toolbox_node")[1]["resolution"] == 0.02


async def test_slam_toolbox_uses_own_defaults_without_section_in_file(
    launch: Launch, started: StartedNodes, tmp_path: Path
) -> None:
    file = tmp_path / "params.yaml"
    file.write_text("amcl:\n  ros__parameters:\n    max_beams: 30\n")
    launched = await launch(make_include("nav2_bringup", "slam_launch.py", params_file=str(file)))
    assert launched.succeeded, launched.err
    parameters = started.node("sync_slam_toolbox_node")[1]
    assert (parameters["resolution"], parameters["use_sim_time"]) == (0.05, True)


@pytest.mark.parametrize(
    ("file", "executable"),
    [
        ("online_async_launch.py", "async_slam_toolbox_node"),
        ("online_sync_launch.py", "sync_slam_toolbox_node"),
        ("offline_launch.py", "sync_slam_toolbox_node"),
        ("localization_launch.py", "localization_slam_toolbox_node"),
    ],
)
async def test_slam_toolbox_launch_files_start_node(
    launch: Launch, started: StartedNodes, file: str, executable: str
) -> None:
    launched = await launch(make_include("slam_toolbox", file, use_sim_time="false"))
    assert launched.succeeded, launched.err
    name, parameters, _ = started.node(executable)
    assert name == "/slam_toolbox"
    assert parameters["use_sim_time"] is False
    assert parameters["base_frame"] == "base_footprint"


async def test_map_saver_launch_starts_managed_node(launch: Launch, started: StartedNodes) -> None:
    launched = await launch(make_include("nav2_map_server", "map_saver_server.launch.py"))
    assert launched.succeeded, launched.err
    assert started.node("lifecycle_manager")[1]["node_names"] == ["map_saver"]


async def test_composed_servers_receive_parameters(launch: Launch, monkeypatch: pytest.MonkeyPatch) -> None:
    from linkwright.navigation.substitutes import servers

    composed: list[Any] = []

    def load(**words: Any) -> Node:
        composed.append(words)
        return Node(executable="true")

    monkeypatch.setattr(servers, "LoadComposableNodes", load)
    launched = await launch(
        make_include("nav2_bringup", "localization_launch.py", use_composition="True", namespace="red")
    )
    assert launched.succeeded, launched.err
    (words,) = composed
    assert words["target_container"] == "red/nav2_container"
    plugins = [component.node_plugin[0].text for component in words["composable_node_descriptions"]]
    assert plugins == ["nav2_map_server::MapServer", "nav2_amcl::AmclNode", "nav2_lifecycle_manager::LifecycleManager"]


def test_server_node_name_follows_executable() -> None:
    assert Server("nav2_amcl", "amcl", "nav2_amcl::AmclNode").node_name == "amcl"
    assert not Server("nav2_docking", "docking_server", "").is_available


def test_default_view_loads_without_warnings() -> None:
    config = RvizConfig.load(share_folder("nav2_bringup") / "rviz" / "nav2_default_view.rviz")
    assert not config.warnings


def test_namespaced_view_is_default_view_with_topics_in_namespace() -> None:
    folder = share_folder("nav2_bringup") / "rviz"
    text = (folder / "nav2_namespaced_view.rviz").read_text()
    assert text.replace("<robot_namespace>/", "") == (folder / "nav2_default_view.rviz").read_text()
    topics = [line.split()[-1] for line in text.splitlines() if "<robot_namespace>/" in line]
    assert {"map", "scan", "robot_description", "initialpose", "goal_pose"} <= {
        topic.removeprefix("<robot_namespace>/") for topic in topics
    }
    topics_without_namespace = [
        line
        for line in re.findall(r"Topic:\n(?: +\w.*\n)*? +Value: (\S+)", text)
        if not line.startswith("<robot_namespace>/")
    ]
    assert not topics_without_namespace


def test_default_parameters_cover_started_nodes() -> None:
    content = yaml.safe_load((share_folder("nav2_bringup") / "params" / "nav2_params.yaml").read_text())
    nodes = {name for _, name in (*LOCALIZATION, *NAVIGATION)}
    assert nodes <= {*content}
    assert {*content} - nodes == {"map_saver", "local_costmap", "global_costmap"}


async def test_lifecycle_manager_skips_missing_nodes_of_user_launch_file(launch: Launch, started: StartedNodes) -> None:
    names = ["planner_server", "coverage_server", "red/route_server"]
    launched = await launch(
        Node(package="opennav_coverage", executable="opennav_coverage", name="coverage_server"),
        Node(package="nav2_route", executable="route_server"),
        Node(package="nav2_planner", executable="planner_server"),
        Node(package="nav2_lifecycle_manager", executable="lifecycle_manager", parameters=[{"node_names": names}]),
    )
    assert launched.succeeded
    assert started.node("lifecycle_manager")[1]["node_names"] == ["planner_server"]
    assert "'coverage_server' is skipped, so no lifecycle manager waits for it" in launched.err


def test_composed_lifecycle_manager_skips_missing_nodes() -> None:
    messages: list[str] = []
    log = SimpleNamespace(write_warning=lambda _name, text: messages.append(text))
    context = SimpleNamespace(session=SimpleNamespace(skipped_nodes={"docking_server"}, log=log))
    request = get_service("composition_interfaces/srv/LoadNode").Request(package_name="nav2_lifecycle_manager")
    parameter = get_message("rcl_interfaces/msg/Parameter")(name="node_names")
    parameter.value.string_array_value = ["bt_navigator", "docking_server"]
    request.parameters = [parameter]
    remove_skipped_nodes(context, request)
    assert list(request.parameters[0].value.string_array_value) == ["bt_navigator"]
    assert len(messages) == 1
