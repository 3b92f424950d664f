"""Plugins.

The tests cover how they are found, their parameters, their nodes, and the messages about errors.
"""

from __future__ import annotations

from contextlib import asynccontextmanager
from dataclasses import dataclass

import pytest

from linkwright.diagnostics import Diagnostic, LinkwrightError, Severity
from linkwright.graph import Graph, LogLevel, LogRecord
from linkwright.graph.stepped.calls import create_logged_calls
from linkwright.graph.stepped.exchange import Exchange
from linkwright.graph.stepped.node import Output
from linkwright.loading.extensions import extensions
from linkwright.messages import get_message
from linkwright.sdf.plugins import library_name
from linkwright.sdf.text import parse_as_gazebo
from linkwright.simulation.plugins.parameters import parameter, parameters_from
from linkwright.simulation.plugins.registry import (
    _BUILT_IN,
    _LIBRARIES_WITHOUT_EFFECT,
    _OWN_SYSTEMS,
    _SENSORS_BY_SYSTEM,
    SENSOR_GROUP,
    is_built_in,
    is_gz_library,
)
from linkwright.simulation.plugins.ros_element import read_node_description
from linkwright.simulation.server.server import ServerOptions, SimulationServer
from linkwright.testing import Recording
from tests.simulation.worlds import GROUND, box, make_simulation, mbot, model

SECOND_NS = 1_000_000_000
CLASSIC_SYSTEMS = ("gazebo_ros_init", "gazebo_ros_factory", "gazebo_ros_force_system", "gazebo_ros_api_plugin")
"""Plugins that tests/simulation/test_server.py and test_classic_services.py test."""
UNSIMULATED = (
    "follow-actor",
    "log",
    "log-playback",
    "model-photo-shoot",
)


@dataclass(frozen=True, kw_only=True)
class _Table:
    joint: tuple[str, ...] = parameter(aliases=("jointName",))
    rate: float = parameter(10.0, aliases=("updateRate",))
    count: int = 3
    sent: bool = False


def _element(text: str):
    document, _ = parse_as_gazebo(f"<plugin>{text}</plugin>".encode(), "robot.sdf")
    return document.root


@pytest.mark.parametrize(
    ("filename", "name"),
    [
        ("libgazebo_ros_diff_drive.so", "gazebo_ros_diff_drive"),
        ("gazebo_ros_diff_drive", "gazebo_ros_diff_drive"),
        ("/opt/ros/humble/lib/libgazebo_ros_camera.so", "gazebo_ros_camera"),
        ("gz-sim-diff-drive-system", "gz-sim-diff-drive-system"),
        ("gz-sim8-diff-drive-system", "gz-sim-diff-drive-system"),
        ("libignition-gazebo6-diff-drive-system.so.6.0.0", "gz-sim-diff-drive-system"),
        ("ignition-gazebo-diff-drive-system", "gz-sim-diff-drive-system"),
    ],
)
def test_library_name_normalizes_spellings(filename, name):
    assert library_name(filename) == name


def test_built_in_systems_are_recognized():
    assert is_built_in("libignition-gazebo-physics-system.so")
    assert is_built_in("libgazebo_ros_factory.so")
    assert is_built_in("libRayPlugin.so")
    assert is_built_in("libGpuRayPlugin.so")
    assert is_built_in("libWaveVisual.so")
    assert is_built_in("dummyfile")
    assert not is_built_in("gz-sim-diff-drive-system")
    assert is_gz_library("gz-sim7-diff-drive-system")
    assert not is_gz_library("libgazebo_ros_camera.so")


def test_systems_listed_as_built_in_are_simulated():
    sensor_types = extensions(SENSOR_GROUP)
    assert [
        type_name for types in _SENSORS_BY_SYSTEM.values() for type_name in types if type_name not in sensor_types
    ] == []
    for library in _BUILT_IN:
        name = library.removeprefix("gz-sim-").removesuffix("-system")
        assert name in (*_OWN_SYSTEMS, *_SENSORS_BY_SYSTEM) or library in (
            *CLASSIC_SYSTEMS,
            *_LIBRARIES_WITHOUT_EFFECT,
            "ActorCollisionsPlugin",
            "WaveVisual",
            "rmagine_embree_map_gzplugin",
            "rotors_gazebo_ros_interface_plugin",
            "rmagine_optix_map_gzplugin",
        ), library


@pytest.mark.parametrize("name", UNSIMULATED)
async def test_unsupported_gz_system_is_reported_with_alternative(name):
    plugin = f'<plugin name="a" filename="gz-sim-{name}-system"/>'
    async with running_server(robot(plugin)) as (_, __, log):
        warning, *alternatives = [record.text for record in log]
        assert warning == f"plugins and sensors that are not simulated: gz-sim-{name}-system"
        assert [text.split(", use ")[0] for text in alternatives] == [f"instead of gz-sim-{name}-system"]


def test_parameters_are_converted_and_accept_old_names():
    text = "<jointName>a</jointName><jointName>b</jointName><updateRate>5</updateRate><sent>1</sent><ros/>"
    parameters, findings = parameters_from(_Table, _element(text))
    assert (parameters, findings) == (_Table(joint=("a", "b"), rate=5.0, sent=True), [])


async def test_plugin_of_a_sensor_outside_of_a_sensor_is_told_of():
    plugin = '<plugin name="scan" filename="libgazebo_ros_ray_sensor.so"/>'
    async with running_server(robot(plugin)) as (_, __, log):
        assert log[0].text.endswith("plugin 'scan' must be in a <sensor>, whose measurements it publishes")


def test_unknown_and_malformed_parameters_are_reported():
    parameters, findings = parameters_from(_Table, _element("<joint>a</joint>\n<rat>1</rat>\n<count>many</count>"))
    assert parameters == _Table(joint=("a",))
    assert [(finding.code, str(finding.span)) for finding in findings] == [
        ("SIM131", "robot.sdf:3:1"),
        ("SIM130", "robot.sdf:2:1"),
    ]
    assert "rate" in str(findings[1].hint)


def test_missing_required_parameter_is_rejected():
    with pytest.raises(LinkwrightError, match="needs the parameter 'joint'"):
        parameters_from(_Table, _element("<rate>1</rate>"))


def test_ros_element_configures_plugin_node():
    ros = (
        "<ros><namespace>robots/one</namespace><remapping>odom:=odometry</remapping><argument>~/out:=scan</argument>"
        '<parameter name="gain" type="double">2</parameter></ros>'
    )
    node = read_node_description("drive", _element(ros), "/spawned")
    assert node.full_name == "/robots/one/drive"
    assert node.remappings == [("~/out", "scan"), ("odom", "odometry")]
    assert node.parameters == {"gain": 2.0}


def test_plugin_without_namespace_uses_robot_namespace():
    assert read_node_description("drive-1", _element(""), "/spawned").full_name == "/spawned/drive_1"
    assert (
        read_node_description("drive", _element("<robotNamespace>/old</robotNamespace>"), "").full_name == "/old/drive"
    )


@pytest.mark.parametrize("tag", ["robotNamespace", "robot_namespace"])
def test_plugin_that_ros_1_lacks_does_not_read_robot_namespace(tag):
    element = _element(f"<{tag}>/old</{tag}>")
    element.attributes["filename"] = "libgazebo_ros2_control.so"
    assert read_node_description("control", element, "/spawned").full_name == "/spawned/control"


@asynccontextmanager
async def running_server(
    *parts: str, options: ServerOptions | None = None, step: float = 0.001, gravity: str = "0 0 -9.81"
):
    """Run a simulation on a graph; yield the server, the graph and the log."""
    log: list[LogRecord] = []
    graph = Graph(on_log=log.append)
    server = SimulationServer(make_simulation(*parts, step=step, gravity=gravity), graph.create_node("gazebo"), options)
    server.start()
    yield server, graph, log
    server.close()
    await graph.close()


def robot(*plugins: str, name: str = "mbot") -> str:
    """Return mbot with plugins."""
    text = mbot().replace('name="mbot"', f'name="{name}"')
    return text.replace("</model>", "".join(plugins) + "</model>")


def joint_states(name: str = "joints", extra: str = "") -> str:
    """Return the joint state plugin of Gazebo classic."""
    return (
        f'<plugin name="{name}" filename="libgazebo_ros_joint_state_publisher.so"><joint_name>left_joint</joint_name>'
        f"<joint_name>right_joint</joint_name><update_rate>10</update_rate>{extra}</plugin>"
    )


async def test_advance_delivers_messages_published_until_then():
    async with running_server(GROUND, robot(joint_states())) as (server, graph, log):
        recording = Recording(graph, server.node, "/joint_states")
        server.advance(SECOND_NS)
        await graph.settle()
        assert len(recording) == 10
        assert [(message.header.stamp.sec, message.header.stamp.nanosec) for message in recording][-1] == (1, 0)
        assert recording.last.name == ["left_joint", "right_joint"]
        assert not log
        assert ("joints", "/") in graph.get_node_names_and_namespaces()


async def test_deferred_message_is_created_once_on_delivery():
    graph, exchange, messages = Graph(), Exchange(), []
    node = graph.create_node("robot")
    topics = ("/model/robot/where", "/where")
    output = Output(
        exchange,
        [node.create_publisher("std_msgs/msg/String", topic, 10) for topic in topics],
        create_logged_calls(node.get_logger(), "robot"),
    )
    recordings = [Recording(graph, node, topic) for topic in topics]

    def text(number: int, text: str):
        messages.append(get_message("std_msgs/msg/String")(data=f"{number} {text}"))
        return messages[-1]

    send = output.deferred_publisher(text)
    send(1, "one")
    assert not messages
    exchange.deliver()
    await graph.settle()
    assert [message.data for message in messages] == ["1 one"]
    assert [recording.last.data for recording in recordings] == ["1 one", "1 one"]
    await graph.close()


async def test_plugin_with_duplicate_node_name_is_not_loaded():
    async with running_server(GROUND, robot(joint_states()), robot(joint_states(), name="two")) as (server, _, log):
        assert [len(server.plugins(name)) for name in ("mbot", "two")] == [1, 0]
        assert [record.text for record in log if "another plugin already uses the node name '/joints'" in record.text]


async def test_unsimulated_plugins_are_reported_once():
    unknown = '<plugin name="a" filename="libvacuum.so"/>'
    built_in = '<plugin name="b" filename="gz-sim-physics-system"/>'
    async with running_server(robot(unknown, built_in), robot(unknown, name="two")) as (_, __, log):
        warnings = [record.text for record in log if "not simulated" in record.text]
        assert warnings == ["plugins and sensors that are not simulated: libvacuum.so"]


async def test_deleted_model_removes_its_nodes():
    async with running_server(GROUND, robot(joint_states())) as (server, graph, log):
        server.delete("mbot")
        assert ("joints", "/") not in graph.get_node_names_and_namespaces()
        server.advance(SECOND_NS)
        server.spawn(model(robot(joint_states())), "mbot")
        assert ("joints", "/") in graph.get_node_names_and_namespaces()
        assert not log


async def test_unplaceable_model_leaves_world_unchanged():
    unplaceable = '<model name="lost"><link name="a"><pose relative_to="nowhere">0 0 0 0 0 0</pose></link></model>'
    async with running_server(GROUND, box("one", "0 0 5 0 0 0")) as (server, _, __):
        server.advance(SECOND_NS // 10)
        with pytest.raises(LinkwrightError, match="the pose of 'nowhere' is not defined"):
            server.spawn(model(unplaceable), "lost")
        with pytest.raises(LinkwrightError, match="a model 'one' already exists"):
            server.spawn(model(box("one", "0 0 5 0 0 0")), "one")
        server.advance(SECOND_NS // 10)
        assert list(server.simulation.scene.models) == ["ground", "one"]


async def test_gz_joint_state_publisher_uses_gz_topic():
    plugin = '<plugin name="gz::sim::systems::JointStatePublisher" filename="gz-sim-joint-state-publisher-system"/>'
    async with running_server(GROUND, robot(plugin)) as (server, graph, _):
        recording = Recording(graph, server.node, "/world/test/model/mbot/joint_state")
        server.advance(SECOND_NS // 100)
        await graph.settle()
        assert len(recording) == 10
        assert recording.last.name == ["left_joint", "right_joint"]


@pytest.mark.parametrize("library", ["libgazebo_ros_joint_state_publisher.so", "gz-sim-joint-state-publisher-system"])
async def test_named_joint_without_axis_is_at_zero(library: str) -> None:
    names = ("left_joint", "anchor")
    parameters = "".join(f"<joint_name>{name}</joint_name>" for name in names) + "<topic>joint_states</topic>"
    anchor = '<joint name="anchor" type="fixed"><parent>world</parent><child>base_link</child></joint>'
    plugin = f'<plugin name="joints" filename="{library}">{parameters}</plugin>'
    async with running_server(GROUND, robot(anchor, plugin)) as (server, graph, log):
        recording = Recording(graph, server.node, "/joint_states")
        server.advance(SECOND_NS // 10)
        await graph.settle()
        assert tuple(recording.last.name) == names
        assert (recording.last.position[1], recording.last.velocity[1]) == (0.0, 0.0)
        assert not [record for record in log if record.level is LogLevel.ERROR]


async def test_magnetometer_measures_field_in_its_axes():
    sensor = (
        '<sensor name="compass" type="magnetometer"><pose>0 0 0 0 0 1.5707963267948966</pose><topic>mag</topic>'
        "<update_rate>10</update_rate></sensor>"
    )
    text = box("one", "0 0 5 0 0 0").replace("</link>", sensor + "</link>")
    async with running_server("<magnetic_field>1 2 3</magnetic_field>", text) as (server, graph, _):
        recording = Recording(graph, server.node, "/mag")
        server.advance(SECOND_NS // 10)
        await graph.settle()
        field = recording.last.magnetic_field
        assert (field.x, field.y, field.z) == pytest.approx((2.0, -1.0, 3.0))
        assert recording.last.header.frame_id == "one/link/compass"


async def test_warnings_and_errors_are_logged_once_in_order():
    warning = Diagnostic("SIM100", "odd", severity=Severity.WARNING)
    async with running_server(GROUND) as (server, _, log):
        server.report([warning, Diagnostic("SIM100", "wrong"), warning])
        assert [(record.level, record.text) for record in log] == [(LogLevel.WARN, "odd"), (LogLevel.ERROR, "wrong")]
