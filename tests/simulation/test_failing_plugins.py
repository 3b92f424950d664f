"""Plugins and sensors whose code fails.

They stop, with one line in the log, and everything else continues.
"""

from __future__ import annotations

from dataclasses import dataclass
from random import Random

import pytest

from linkwright.graph import LogLevel
from linkwright.graph.endpoints.publisher import Publisher
from linkwright.loading.extensions import extensions
from linkwright.messages import get_message, get_service
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.simulation.plugins.registry import SENSOR_GROUP
from linkwright.simulation.server import server as server_module
from linkwright.testing import Recording, SteppedSimulation
from tests.remote_publishers import RemotePublisher, RemoteTransport
from tests.simulation.sensors.rooms import block
from tests.simulation.sensors.test_topics import CAMERA, RAYS, plugin, robot_with, sensor
from tests.simulation.test_plugins import SECOND_NS, joint_states, robot, running_server
from tests.simulation.worlds import GROUND

STRING, TRIGGER = "std_msgs/msg/String", "std_srvs/srv/Trigger"
TASK, CALLBACK, SERVICE, LOST = "a task", "a callback", "a service", "the loss of its commander"
CREATING, PUBLISHING, STOP = "creating a message", "publishing an object that is not a message", "stop"
HOOKS = (
    *("its parameters", "the constructor", "start", TASK, CALLBACK, SERVICE, LOST, "reset", "resume"),
    *("comparing", STOP, CREATING, PUBLISHING),
)


class PluginError(Exception):
    """The error that the plugin raises."""


@dataclass(frozen=True, kw_only=True, eq=False)
class _Parameters:
    failing_point: str = ""

    def __post_init__(self) -> None:
        self.fail_at("its parameters")

    def __eq__(self, other: object) -> bool:
        self.fail_at("comparing")
        return True

    __hash__ = None

    def fail_at(self, point: str) -> None:
        """Raise the error if the plugin is to fail at this point."""
        if self.failing_point == point:
            raise PluginError(point)


class _Failing(SimulatedPlugin[_Parameters]):
    """A plugin that fails at the point that its parameter names."""

    PARAMETERS = _Parameters

    def __init__(self, mount, node, parameters, environment) -> None:
        super().__init__(mount, node, parameters, environment)
        parameters.fail_at("the constructor")

    def start(self) -> None:
        fail_at = self.parameters.fail_at
        fail_at("start")
        output = self.node.publisher(STRING, "said")
        make = output.deferred_publisher(lambda: fail_at(CREATING) or get_message(STRING)())
        self.every(100.0, lambda: fail_at(TASK))
        self.every(100.0, make)
        self.every(
            100.0, lambda: output.publish(3 if self.parameters.failing_point == PUBLISHING else get_message(STRING)())
        )
        command_guard = self.node.command_guard(lambda: fail_at(LOST) or False)
        self.node.subscribe(STRING, "/told", lambda _: fail_at(CALLBACK), command_guard=command_guard)
        self.node.service(TRIGGER, "/asked", lambda _, response: fail_at(SERVICE) or response)

    def reset(self) -> None:
        self.parameters.fail_at("reset")

    def resume(self, before) -> None:
        self.parameters.fail_at("resume")

    def stop(self) -> None:
        self.parameters.fail_at(STOP)


@pytest.fixture(autouse=True)
def _failing(monkeypatch) -> None:
    """Let worlds use the plugin above as a library."""
    find_class = server_module.find_plugin_class
    monkeypatch.setattr(
        server_module, "find_plugin_class", lambda name: _Failing if name == "failing" else find_class(name)
    )


def failing_plugin(failing_point: str) -> str:
    return f'<plugin name="faulty" filename="libfailing.so"><failing_point>{failing_point}</failing_point></plugin>'


@pytest.mark.parametrize("failing_point", HOOKS)
async def test_failing_plugin_stops_without_affecting_others(failing_point):
    text = robot(joint_states("before"), failing_plugin(failing_point), joint_states("after"))
    async with running_server(GROUND, text) as (server, graph, log):
        recordings = [
            Recording(graph, server.node, "/joint_states"),
            Recording(graph, server.node, "/said", STRING),
        ]
        transport = RemoteTransport(graph)
        commander = RemotePublisher(transport, "/told", msg_type=STRING)
        commander.send(get_message(STRING)())
        client = server.node.create_client(get_service(TRIGGER), "/asked")
        if client.service_is_ready():
            client.call_async(get_service(TRIGGER).Request())
        await _advance(server, graph)
        if transport.lose is not None:
            commander.disappear()
        await _advance(server, graph)
        server.reset()
        nodes = [name for name, _ in graph.get_node_names_and_namespaces()]
        assert ("faulty" in nodes) is (failing_point in ("comparing", "resume", STOP))
        server.replace_model(server.simulation.scene.models["mbot"].model, "mbot")
        recordings[0].clear()
        await _advance(server, graph)
        assert len(recordings[0]) == 20  # the messages of both other plugins
        server.delete("mbot")
        errors = [record.text for record in log if record.level >= LogLevel.ERROR]
        expected = "TypeError" if failing_point == PUBLISHING else f"PluginError: {failing_point}"
        assert [expected in error for error in errors] == [True], errors
        assert errors[0].startswith("test.world:14:"), "the message has the line of the plugin's element"
        assert "'faulty' stopped because its code failed" in errors[0]
        assert "test_failing_plugins.py" in errors[0] or failing_point == PUBLISHING


async def _advance(server, graph) -> None:
    """Advance one second in steps, and deliver messages between them."""
    for _ in range(10):
        await graph.settle()
        server.advance(SECOND_NS // 10)
        await graph.settle()


async def test_pending_command_of_removed_plugin_is_dropped():
    async with running_server(GROUND, robot(failing_plugin(""))) as (server, graph, log):
        messages: list = []
        (faulty,) = server.plugins("mbot")
        faulty.node.post(lambda: messages.append(1))
        server.delete("mbot")
        await _advance(server, graph)
        assert not messages
        assert not log


def test_stepped_simulation_raises_plugin_error(tmp_path):
    world = tmp_path / "a.world"
    world.write_text(f'<sdf version="1.7"><world name="test">{robot(failing_plugin(TASK))}</world></sdf>')
    with SteppedSimulation(world) as test, pytest.raises(PluginError, match=TASK):
        test.advance(1.0)


# --- subscriptions that come and go at any moment ---------------------------------------------------------------------

_PICTURES = ("camera", "depth", "rgbd", "segmentation", "boundingbox", "thermal")
CLASSIC = {
    "classic ray": sensor("ray", f"<ray>{RAYS}</ray>" + plugin("libgazebo_ros_ray_sensor.so"), "a"),
    "classic block laser": sensor("ray", f"<ray>{RAYS}</ray>" + plugin("libgazebo_ros_block_laser.so"), "a"),
    "classic camera": sensor("camera", CAMERA + plugin("libgazebo_ros_camera.so"), "a"),
    "classic depth camera": sensor("depth", CAMERA + plugin("libgazebo_ros_camera.so"), "a"),
    "classic multicamera": sensor(
        "multicamera", CAMERA.replace("<camera>", '<camera name="left">') + plugin("libgazebo_ros_camera.so"), "a"
    ),
    "classic imu": sensor("imu", plugin("libgazebo_ros_imu_sensor.so"), "a"),
    "classic gps": sensor("gps", plugin("libgazebo_ros_gps_sensor.so"), "a"),
}
OF_GZ = {kind: sensor(kind, CAMERA if kind.startswith(_PICTURES) else "", "a") for kind in extensions(SENSOR_GROUP)}


@pytest.mark.parametrize("text", (CLASSIC | OF_GZ).values(), ids=(CLASSIC | OF_GZ).keys())
async def test_sensor_survives_changing_subscriptions(text, monkeypatch):
    rng = Random(7)
    if 'type="force_torque"' in text:
        joint = '<joint name="wrist" type="continuous"><parent>head</parent><child>arm</child>{}</joint>'
        robot = robot_with(extra=f'<link name="arm"/>{joint.format(text)}').replace("<static>true</static>", "")
    else:
        robot = robot_with(text)
    async with running_server(block("wall", "2.5 0 0 0 0 0", "1 20 20"), robot) as (server, _, log):
        assert len(server.plugins("robot")) == 1
        monkeypatch.setattr(Publisher, "get_subscription_count", lambda _: rng.randrange(2))
        server.advance(4 * SECOND_NS)
        assert len(server.plugins("robot")) == 1
        assert not [record.text for record in log if record.level >= LogLevel.ERROR]
