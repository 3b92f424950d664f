"""The programs `gz` and `ign`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from linkwright.cli.tools.programs import main
from linkwright.graph import SENSOR_DATA_QOS, Graph
from linkwright.messages import get_message
from linkwright.simulation.gz_services import CONTROL, CREATE, REMOVE, SET_POSE, GzService

AddToGraph = Callable[[Callable[[Graph], object]], None]


class World:
    """The services of a world, which record requests.

    Attributes:
        requests: the requests of all services.
    """

    def __init__(self, *, succeeds: bool = True) -> None:
        self.requests: list[Any] = []
        self._succeeds = succeeds

    def offer(self, graph: Graph) -> None:
        """Offer the services in a graph."""
        node = graph.create_node("gazebo")
        for service in (CONTROL, CREATE, REMOVE, SET_POSE):
            node.create_service(service.ros_type, f"/world/hall/{service.name}", self._handle)

    def _handle(self, request: Any, response: Any) -> Any:
        self.requests.append(request)
        response.success = self._succeeds
        return response


def call(service: GzService, text: str, program: str = "gz") -> int:
    """Call a service of the world with a request."""
    types = ["--reqtype", service.gz_type, "--reptype", "gz.msgs.Boolean", "--timeout", "2000"]
    return main(program, ["service", "-s", f"/world/hall/{service.name}", *types, "--req", text])


@pytest.mark.parametrize("program", ["gz", "ign"])
def test_model_is_created(program: str, add_to_graph: AddToGraph, capsys: pytest.CaptureFixture[str]) -> None:
    world = World()
    add_to_graph(world.offer)
    pose = "pose { position: {x: 1, z: 2}, orientation: {z: 1} }"
    text = f'sdf_filename: "/a/b.sdf", name: "box" {pose} allow_renaming: true'
    assert call(CREATE, text, program) == 0
    factory = world.requests[0].entity_factory
    assert (factory.sdf_filename, factory.name, factory.allow_renaming) == ("/a/b.sdf", "box", True)
    assert (factory.pose.position.x, factory.pose.position.z) == (1.0, 2.0)
    assert (factory.pose.orientation.z, factory.pose.orientation.w) == (1.0, 0.0)
    assert capsys.readouterr().out == "data: true\n\n"


def test_sdf_in_request_keeps_its_quotes(add_to_graph: AddToGraph) -> None:
    world = World()
    add_to_graph(world.offer)
    assert call(CREATE, r'sdf: "<?xml version=\"1.0\" ?><sdf/>"') == 0
    assert world.requests[0].entity_factory.sdf == '<?xml version="1.0" ?><sdf/>'


def test_model_is_moved_removed_and_world_is_paused(add_to_graph: AddToGraph) -> None:
    world = World()
    add_to_graph(world.offer)
    assert call(SET_POSE, 'name: "box", position: {x: 3}') == 0
    assert call(REMOVE, "name: 'box' type: MODEL") == 0
    assert call(CONTROL, "pause: true, multi_step: 4, reset: {all: true}") == 0
    moved, removed, controlled = world.requests
    assert (moved.entity.name, moved.pose.position.x, moved.pose.orientation.w) == ("box", 3.0, 1.0)
    assert (removed.entity.name, removed.entity.type) == ("box", removed.entity.MODEL)
    control = controlled.world_control
    assert (control.pause, control.multi_step, control.reset.all) == (True, 4, True)


def test_refused_request_has_empty_response_and_status(
    add_to_graph: AddToGraph, capsys: pytest.CaptureFixture[str]
) -> None:
    add_to_graph(World(succeeds=False).offer)
    assert call(REMOVE, 'name: "nobody"') == 1
    assert capsys.readouterr().out == "\n"


def test_services_are_listed_and_described(add_to_graph: AddToGraph, capsys: pytest.CaptureFixture[str]) -> None:
    add_to_graph(World().offer)
    assert main("gz", ["service", "-l"]) == 0
    assert capsys.readouterr().out.split() == [
        f"/world/hall/{name}" for name in ("control", "create", "remove", "set_pose")
    ]
    assert main("gz", ["service", "-i", "-s", "/world/hall/create"]) == 0
    assert "linkwright, gz.msgs.EntityFactory, gz.msgs.Boolean" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["service", "-s", "/gui/follow", "--req", ""], "the service '/gui/follow' of gz does not exist in Linkwright"),
        (["service", "-s", "/world/hall/control", "--req", "pause"], "'pause' is not a 'gz.msgs.WorldControl'"),
        (["topic", "-t", "/a", "-m", "gz.msgs.Twist", "-p", "linear"], "'linear' is not a 'gz.msgs.Twist'"),
        (["topic", "-t", "/a", "-m", "gz.msgs.Nothing", "-p", ""], "'' is not a 'gz.msgs.Nothing'"),
        (["paint"], "'gz' has no verb 'paint'"),
    ],
)
def test_invalid_command_is_reported(
    words: list[str], message: str, add_to_graph: AddToGraph, capsys: pytest.CaptureFixture[str]
) -> None:
    add_to_graph(World().offer)
    assert main("gz", words) == 1
    assert message in capsys.readouterr().err


def test_message_is_published(add_to_graph: AddToGraph) -> None:
    messages: list[Any] = []
    twist = get_message("geometry_msgs/msg/Twist")
    add_to_graph(lambda graph: graph.create_node("robot").create_subscription(twist, "/cmd_vel", messages.append, 10))
    assert main("gz", ["topic", "-t", "cmd_vel", "-m", "gz.msgs.Twist", "-p", "linear: {x: 0.5}"]) == 0
    assert [message.linear.x for message in messages] == [0.5]


def test_messages_are_printed_as_text(add_to_graph: AddToGraph, capsys: pytest.CaptureFixture[str]) -> None:
    def add(graph: Graph) -> None:
        node = graph.create_node("robot")
        joint_states = get_message("sensor_msgs/msg/JointState")
        publisher = node.create_publisher(joint_states, "/joints", SENSOR_DATA_QOS)
        message = joint_states(name=['a"b', ""], position=[0.5, 0.0])
        message.header.stamp.nanosec = 7
        node.create_timer(0.01, lambda: publisher.publish(message))

    add_to_graph(add)
    assert main("gz", ["topic", "-e", "-t", "/joints", "-n", "1"]) == 0
    assert capsys.readouterr().out == (
        'header {\n  stamp {\n    nsec: 7\n  }\n}\nname: "a\\"b"\nname: ""\nposition: 0.5\nposition: 0\n\n'
    )


def test_urdf_is_printed_as_sdf(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "cart.urdf"
    path.write_text(
        '<robot name="cart"><link name="base"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" '
        'iyy="1" iyz="0" izz="1"/></inertial></link></robot>',
        encoding="utf-8",
    )
    assert main("gz", ["sdf", "-p", str(path)]) == 0
    assert '<model name="cart">' in capsys.readouterr().out
