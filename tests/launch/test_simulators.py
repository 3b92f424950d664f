"""Launch files that start Gazebo, with Linkwright's substitutes for missing packages."""

from __future__ import annotations

import asyncio
import socket
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from launch.actions import GroupAction, OpaqueFunction, SetEnvironmentVariable
from launch.substitutions import FindExecutable

from launch import LaunchContext, LaunchDescriptionEntity
from linkwright.graph import Graph
from linkwright.launch.frontend.include import IncludeLaunchDescription
from linkwright.launch.model.actions.execute import ExecuteProcess
from linkwright.launch.ros import Node
from linkwright.messages import get_service
from linkwright.nodes import EXECUTABLES, NodeOptions
from linkwright.nodes.options import SingleNode, create_node
from linkwright.packages import PackageFinder, is_substitute
from linkwright.packages.share_layout import find_source
from tests.places import GAZEBO_PACKAGE
from tests.waiting import eventually

Write = Callable[[str, str], Path]
WORLD = GAZEBO_PACKAGE / "worlds" / "playground.world"


class SpawnedEntity(NamedTuple):
    """The name, description and x of a requested entity."""

    name: str
    description: str
    x: float


class Server(SingleNode):
    """A substitute for the simulation that ends when one entity was spawned, or immediately."""

    DEFAULT_NAME = "gazebo"

    def __init__(self, graph: Graph, options: NodeOptions, spawned: list[SpawnedEntity] | None) -> None:
        self._node, self.words = create_node(graph, options, self.DEFAULT_NAME)
        self.finished: asyncio.Future[int] = asyncio.get_running_loop().create_future()
        self._spawned = spawned
        if spawned is None:
            self.finished.set_result(0)
        self._node.create_service(get_service("gazebo_msgs/srv/SpawnEntity"), "/spawn_entity", self._spawn)
        self._node.create_service(get_service("ros_gz_interfaces/srv/SpawnEntity"), "/world/test/create", self._create)

    def _spawn(self, request: Any, response: Any) -> Any:
        return self._record(SpawnedEntity(request.name, request.xml, request.initial_pose.position.x), response)

    def _create(self, request: Any, response: Any) -> Any:
        factory = request.entity_factory
        return self._record(SpawnedEntity(factory.name, factory.sdf, factory.pose.position.x), response)

    def _record(self, entity: SpawnedEntity, response: Any) -> Any:
        assert self._spawned is not None
        self._spawned.append(entity)
        response.success = True
        self.finished.set_result(0)
        return response


class Simulators:
    """The servers that a launch started.

    Attributes:
        started: the package, parameters and command line of each server.
        environments: the environment variables of each server.
        spawned: the requested entities; None lets servers end at once.
    """

    def __init__(self) -> None:
        self.started: list[tuple[str, dict[str, Any], list[str]]] = []
        self.environments: list[dict[str, str]] = []
        self.spawned: list[SpawnedEntity] | None = None

    def entry_point(self, package: str) -> Any:
        def start(graph: Graph, options: NodeOptions) -> Server:
            self.started.append((package, options.parameters, options.arguments))
            self.environments.append(dict(options.environment))
            return Server(graph, options, self.spawned)

        start.DEFAULT_NAME = Server.DEFAULT_NAME  # type: ignore[attr-defined]
        return type("EntryPoint", (), {"load": staticmethod(lambda: start), "distribution": "test"})()


@pytest.fixture
def simulators(monkeypatch: pytest.MonkeyPatch) -> Simulators:
    simulators = Simulators()
    for package in ("gazebo_ros", "ros_gz_sim"):
        monkeypatch.setitem(EXECUTABLES.entry_points, (package, "gzserver"), simulators.entry_point(package))
    monkeypatch.setenv("PATH", "")
    return simulators


FINDER = PackageFinder(start=Path(__file__).parent, environment={})
"""A finder without Gazebo's packages, which finds only Linkwright's substitutes."""


def share_folder(package: str) -> Path:
    return FINDER.share(package)


def make_include(package: str, name: str, **arguments: str) -> IncludeLaunchDescription:
    return IncludeLaunchDescription(str(share_folder(package) / "launch" / name), launch_arguments=arguments.items())


@pytest.mark.parametrize("package", ["gazebo_ros", "ros_gz_sim", "ros_ign_gazebo", "ros_gz_bridge"])
def test_package_in_workspace_takes_precedence_over_substitute(package: str, write: Write, tmp_path: Path) -> None:
    assert is_substitute(share_folder(package))
    write(f"ws/src/{package}/package.xml", f"<package><name>{package}</name></package>")
    finder = PackageFinder(start=tmp_path / "ws", environment={})
    assert finder.share(package) == finder.packages()[package] == tmp_path / "ws" / "src" / package


COMPILED = """
project(ros_gz_sim)
add_executable(create src/create.cpp)
install(TARGETS create DESTINATION lib/${PROJECT_NAME})
configure_file(launch/gz_sim.launch.py.in launch/gz_sim.launch.py.configured @ONLY)
file(GENERATE OUTPUT "${CMAKE_CURRENT_BINARY_DIR}/launch/gz_sim.launch.py"
  INPUT "${CMAKE_CURRENT_BINARY_DIR}/launch/gz_sim.launch.py.configured")
install(FILES "${CMAKE_CURRENT_BINARY_DIR}/launch/gz_sim.launch.py" DESTINATION share/${PROJECT_NAME}/launch)
install(FILES launch/gz_spawn_model.launch.py DESTINATION share/${PROJECT_NAME}/launch)
ament_package()
"""


async def test_launch_files_missing_in_unbuilt_sources_are_substituted(
    launch: Callable[..., Any],
    simulators: Simulators,
    write: Write,
    tmp_path: Path,
) -> None:
    """The build of ros_gz generates gz_sim.launch.py, so a clone lacks it.

    The clone's own files take precedence.
    """
    folder = write("ws/src/ros_gz/ros_gz_sim/package.xml", "<package><name>ros_gz_sim</name></package>").parent
    write("ws/src/ros_gz/ros_gz_sim/CMakeLists.txt", COMPILED)
    write("ws/src/ros_gz/ros_gz_sim/launch/gz_sim.launch.py.in", "@GZ_SIM_VER@")
    edited = write("ws/src/ros_gz/ros_gz_sim/launch/gz_spawn_model.launch.py", "# edited")
    finder = PackageFinder(start=tmp_path / "ws", environment={})
    share = finder.share("ros_gz_sim")
    assert find_source(str(share / "launch" / "gz_spawn_model.launch.py")) == str(edited)
    assert (share / "launch" / "gz_server.launch.py").is_file()
    path = str(share / "launch" / "gz_sim.launch.py")
    launched = await launch(
        IncludeLaunchDescription(path, launch_arguments={"gz_args": f"-r -s {WORLD}"}.items()), finder=finder
    )
    assert launched.succeeded, launched.err
    assert [package for package, _, _ in simulators.started] == ["ros_gz_sim"]
    (folder / "CMakeLists.txt").write_text("project(ros_gz_sim)\nament_package()\n")
    assert PackageFinder(start=tmp_path / "ws", environment={}).share("ros_gz_sim") == folder


async def test_gazebo_launch_starts_server(launch: Callable[..., Any], simulators: Simulators) -> None:
    arguments = {"world": str(WORLD), "pause": "true", "verbose": "true", "gui": "false", "seed": "3"}
    launched = await launch(make_include("gazebo_ros", "gazebo.launch.py", **arguments))
    assert launched.succeeded, launched.err
    assert simulators.started == [("gazebo_ros", {"world": str(WORLD), "pause": True, "seed": 3}, [])]


async def test_world_argument_is_inherited_or_defaults_to_empty_world(
    launch: Callable[..., Any], simulators: Simulators
) -> None:
    await launch(make_include("gazebo_ros", "gzserver.launch.py"), world=str(WORLD))
    await launch(make_include("gazebo_ros", "gazebo.launch.py", gui="false"))
    worlds = [parameters["world"] for _, parameters, _ in simulators.started]
    assert worlds == [str(WORLD), str(share_folder("gazebo_ros") / "worlds" / "empty.world")]


async def test_server_false_starts_no_server(launch: Callable[..., Any], simulators: Simulators) -> None:
    launched = await launch(make_include("gazebo_ros", "gazebo.launch.py", server="false", gui="false"))
    assert launched.succeeded
    assert simulators.started == []


async def test_extra_arguments_and_parameter_files_are_passed(
    launch: Callable[..., Any], simulators: Simulators, write: Write
) -> None:
    path = write("gazebo.yaml", "gazebo:\n  ros__parameters:\n    publish_rate: 50.0\n")
    extra = f"--ros-args --params-file {path}"
    await launch(make_include("gazebo_ros", "gzserver.launch.py", extra_gazebo_args=extra))
    await launch(make_include("gazebo_ros", "gzserver.launch.py", params_file=str(path)))
    (_, _, words), (_, parameters, _) = simulators.started
    assert words == ["--ros-args", "--params-file", str(path)]
    assert parameters["publish_rate"] == 50.0


async def test_required_server_ends_launch(launch: Callable[..., Any], simulators: Simulators) -> None:
    window = make_include("gazebo_ros", "gzclient.launch.py")
    launched = await launch(make_include("gazebo_ros", "gzserver.launch.py", server_required="true"), window)
    assert launched.succeeded
    assert "the page in the browser shows the world" in launched.err
    assert len(simulators.started) == 1


@pytest.mark.parametrize(
    ("package", "name", "arguments"),
    [
        ("ros_gz_sim", "gz_sim.launch.py", {"gz_args": f"-r -v 4 {WORLD}"}),
        ("ros_gz_sim", "gz_sim.launch.py", {"ign_args": f"-r {WORLD}"}),
        ("ros_ign_gazebo", "ign_gazebo.launch.py", {"ign_args": f"{WORLD} -r"}),
    ],
)
async def test_gz_sim_launch_starts_server(
    launch: Callable[..., Any], simulators: Simulators, package: str, name: str, arguments: dict[str, str]
) -> None:
    launched = await launch(make_include(package, name, **arguments))
    assert launched.succeeded, launched.err
    assert simulators.started == [("ros_gz_sim", {"world": str(WORLD), "pause": False, "gui": True}, [])]


async def test_gz_command_is_listed_while_the_server_runs(
    launch: Callable[..., Any], simulators: Simulators, monkeypatch: pytest.MonkeyPatch
) -> None:
    events: list[object] = []

    class Recorder:
        def __init__(self, command: list[str]) -> None:
            events.append(command)

        def close(self) -> None:
            events.append("closed")

    monkeypatch.setattr("linkwright.simulation.nodes.process_list.ListedCommand", Recorder)
    launched = await launch(make_include("ros_gz_sim", "gz_sim.launch.py", gz_args=f"-v 4 -r {WORLD}"))
    assert launched.succeeded, launched.err
    assert events[:2] == [["gz", "sim", "-v", "4", "-r", str(WORLD)], "closed"]


async def test_second_include_for_gui_starts_no_second_server(
    launch: Callable[..., Any], simulators: Simulators
) -> None:
    server = make_include("ros_gz_sim", "gz_sim.launch.py", gz_args=f"-r -s {WORLD}", on_exit_shutdown="true")
    launched = await launch(make_include("ros_gz_sim", "gz_sim.launch.py", gz_args="-g"), server)
    assert launched.succeeded
    assert len(simulators.started) == 1


@pytest.mark.parametrize(
    ("command", "options"),
    [
        (["gazebo", "--verbose", "-s", "libgazebo_ros_factory.so", str(WORLD)], {}),
        (["gzserver", str(WORLD), "-s", "libgazebo_ros_init.so"], {}),
        ([f"gzserver {WORLD}"], {"shell": True}),
    ],
)
async def test_gazebo_commands_start_server(
    launch: Callable[..., Any], simulators: Simulators, command: list[str], options: dict[str, bool]
) -> None:
    action = ExecuteProcess(cmd=command, output="screen", **options)
    launched = await launch(action)
    assert launched.succeeded, launched.err
    ((package, parameters, words),) = simulators.started
    assert (package, parameters["world"], words) == ("gazebo_ros", str(WORLD), [])
    assert action.return_code == 0


@pytest.mark.parametrize(
    "command", [["gz", "sim"], ["ruby", "/usr/bin/ign", "gazebo"], ["ruby", FindExecutable(name="ign"), "gazebo"]]
)
async def test_gz_sim_command_starts_server(
    launch: Callable[..., Any], simulators: Simulators, command: list[Any]
) -> None:
    await launch(ExecuteProcess(cmd=[*command, "-r", "-s", str(WORLD)]))
    assert simulators.started == [("ros_gz_sim", {"world": str(WORLD), "pause": False, "gui": False}, [])]


@pytest.mark.parametrize(
    ("entities", "pages"),
    [
        ([make_include("gazebo_ros", "gzclient.launch.py")], 1),
        ([make_include("ros_gz_sim", "gz_sim.launch.py", gz_args=str(WORLD))], 1),
        ([make_include("ros_gz_sim", "gz_sim.launch.py", gz_args=f"-s {WORLD}")], 0),
        ([ExecuteProcess(cmd=["gazebo", str(WORLD)])], 1),
        ([ExecuteProcess(cmd=["gzserver", str(WORLD)])], 0),
        ([make_include("gazebo_ros", "gzclient.launch.py"), ExecuteProcess(cmd=["gz", "sim", "-g"])], 1),
        ([make_include("gazebo_ros", "gzclient.launch.py"), Node(package="rviz2", executable="rviz2")], 1),
    ],
)
async def test_gazebo_gui_opens_one_viewer(
    launch: Callable[..., Any], simulators: Simulators, entities: list[LaunchDescriptionEntity], pages: int
) -> None:
    """RViz's viewer is reused.

    Otherwise a viewer runs as long as the program that opens the window.
    """
    simulators.spawned = []  # the server does not end

    def look(context: LaunchContext) -> None:
        async def seen() -> None:
            if pages:
                await eventually(lambda: context.session.host.shows_world)
            context.session.shut_down("seen")

        context.session.spawn(seen())

    launched = await launch(*entities, OpaqueFunction(function=look))
    assert launched.succeeded, launched.err
    assert launched.out.count("Viewer: ") == pages


async def test_used_port_ends_gazebo_launch_with_one_error(launch: Callable[..., Any], simulators: Simulators) -> None:
    simulators.spawned = []
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        options = {"port": other.getsockname()[1]}
        launched = await launch(make_include("gazebo_ros", "gazebo.launch.py", gui="true"), session_options=options)
    assert not launched.succeeded
    assert [line for line in launched.err.splitlines() if line.startswith("error")] == [
        f"error[VIEW101]: port {options['port']} of '127.0.0.1' is in use"
    ]


async def test_simulation_inherits_environment_of_group(launch: Callable[..., Any], simulators: Simulators) -> None:
    server = make_include("ros_gz_sim", "gz_sim.launch.py", gz_args="-r -s a.sdf")
    await launch(GroupAction([SetEnvironmentVariable("GZ_SIM_RESOURCE_PATH", "/worlds"), server]))
    assert [environment["GZ_SIM_RESOURCE_PATH"] for environment in simulators.environments] == ["/worlds"]


async def test_other_gz_commands_run_as_processes(launch: Callable[..., Any], simulators: Simulators) -> None:
    launched = await launch(ExecuteProcess(cmd=["gz", "topic", "-l"]))
    assert not launched.succeeded
    assert simulators.started == []


async def test_installed_gazebo_is_started(
    launch: Callable[..., Any], simulators: Simulators, write: Write, monkeypatch: pytest.MonkeyPatch
) -> None:
    program = write("bin/gzserver", "#!/bin/sh\necho the real one\n")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", f"{program.parent}:/bin:/usr/bin")
    launched = await launch(ExecuteProcess(cmd=["gzserver", "a.world"], output="screen"))
    assert "the real one" in launched.out
    assert simulators.started == []


@pytest.mark.parametrize(
    ("name", "parts"),
    [
        ("load_mbot_into_gazebo", ()),
        ("load_mbot_camera_into_gazebo", ("camera_link",)),
        ("load_mbot_kinect_into_gazebo", ("kinect_link",)),
        ("load_mbot_laser_into_gazebo", ("laser_link",)),
        ("load_mbot_into_gz", ()),
        ("load_mbot_camera_into_gz", ("camera_link",)),
        ("load_mbot_kinect_into_gz", ("kinect_link",)),
        ("load_mbot_laser_into_gz", ("laser_link",)),
    ],
)
async def test_tutorial_launch_files_spawn_robot(
    launch: Callable[..., Any], simulators: Simulators, name: str, parts: tuple[str, ...]
) -> None:
    simulators.spawned = []
    path = str(GAZEBO_PACKAGE / "launch" / f"{name}.launch.py")
    ends = {"server_required": "true", "on_exit_shutdown": "true"}
    arguments = {"rviz": "false", "x": "-1.5", "yaw": "3.14"}
    finder = PackageFinder(start=GAZEBO_PACKAGE, environment={})
    launched = await launch(IncludeLaunchDescription(path, launch_arguments=arguments.items()), finder=finder, **ends)
    assert launched.succeeded, launched.err
    (entity,) = simulators.spawned
    assert (entity.name, entity.x) == ("mbot", -1.5)
    assert all(part in entity.description for part in parts)
    ((_, parameters, _),) = simulators.started
    assert parameters["world"] == str(WORLD)


async def test_shutdown_on_server_exit_is_decided_within_include_scope(
    launch: Callable[..., Any], simulators: Simulators
) -> None:
    """When the server ends, the scope of the include has already ended."""
    for package, name, argument in (
        ("ros_gz_sim", "gz_sim.launch.py", {"gz_args": str(WORLD)}),
        ("gazebo_ros", "gzserver.launch.py", {"world": str(WORLD)}),
    ):
        launched = await launch(GroupAction([make_include(package, name, **argument)], scoped=True, forwarding=False))
        assert launched.succeeded, launched.err
        assert "error" not in launched.err
