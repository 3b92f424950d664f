"""Drives whose commander is lost.

They stop; after a regular departure they keep their command.
"""

from __future__ import annotations

import pytest

from linkwright.graph.log.logger import LogLevel
from linkwright.messages import get_message
from linkwright.simulation.server.server import ServerOptions
from tests.remote_publishers import RemotePublisher, RemoteTransport
from tests.simulation.test_ackermann import car, plugin
from tests.simulation.test_diff_drive import classic_plugin, gz_plugin
from tests.simulation.test_movers import moving_box_model, planar_plugin
from tests.simulation.test_plugins import SECOND_NS, robot, running_server
from tests.simulation.worlds import GROUND

Twist = get_message("geometry_msgs/msg/Twist")
VELOCITY_CONTROL = (
    '<plugin name="gz::sim::systems::VelocityControl" filename="gz-sim-velocity-control-system">'
    "<topic>cmd_vel</topic></plugin>"
)
SKID = (
    '<plugin name="skid" filename="libgazebo_ros_skid_steer_drive.so"><leftFrontJoint>left_joint</leftFrontJoint>'
    "<leftRearJoint>left_joint</leftRearJoint><rightFrontJoint>right_joint</rightFrontJoint>"
    "<rightRearJoint>right_joint</rightRearJoint><wheelSeparation>0.38</wheelSeparation>"
    "<wheelDiameter>0.12</wheelDiameter></plugin>"
)
LOST = "'/driver', which sent the commands on '/cmd_vel', was lost (killed, crashed or out of reach)"
DRIVES = {
    "classic diff drive": robot(classic_plugin()),
    "gz diff drive": robot(gz_plugin()),
    "planar move": moving_box_model(planar_plugin()),
    "skid steer": robot(SKID),
    "velocity control": moving_box_model(VELOCITY_CONTROL),
    "classic ackermann": car(plugin()).replace('name="car"', 'name="mbot"', 1),
}


def forward_twist(speed: float):
    """Return a command."""
    twist = Twist()
    twist.linear.x = speed
    return twist


def logged_warnings(log) -> list[str]:
    """Return the warnings in a log."""
    return [record.text for record in log if record.level >= LogLevel.WARN]


@pytest.mark.parametrize("model", DRIVES.values(), ids=DRIVES.keys())
async def test_drive_stops_and_reports_lost_commander_once(model: str) -> None:
    async with running_server(GROUND, model) as (server, graph, log):
        driver = RemotePublisher(RemoteTransport(graph), "/cmd_vel")
        driver.send(forward_twist(0.3))
        await advance(server, graph, 1.5)
        assert robot_speed(server) == pytest.approx(0.3, abs=0.02)
        driver.disappear()
        await advance(server, graph, 1.5)
        assert robot_speed(server) == pytest.approx(0.0, abs=0.01)
        assert logged_warnings(log) == [f"{LOST}: the motion stops"]


@pytest.mark.parametrize("model", DRIVES.values(), ids=DRIVES.keys())
async def test_drive_reports_two_simultaneous_commanders_once(model: str) -> None:
    async with running_server(GROUND, model) as (server, graph, log):
        transport = RemoteTransport(graph)
        drivers = [RemotePublisher(transport, "/cmd_vel", name) for name in ("keys", "planner")]
        silent = RemotePublisher(transport, "/cmd_vel", "behaviors")
        silent.send(forward_twist(0.0))
        for _ in range(30):
            for driver, target in zip(drivers, (0.1, 0.3), strict=True):
                driver.send(forward_twist(target))
                await advance(server, graph, 0.1)
        (warning,) = logged_warnings(log)
        assert warning.startswith(
            "several nodes drive the robot: '/keys', '/planner' send commands on '/cmd_vel', and the robot"
        )


async def test_drive_keeps_command_of_remaining_commander() -> None:
    async with running_server(GROUND, robot(classic_plugin())) as (server, graph, log):
        transport = RemoteTransport(graph)
        lost, other = RemotePublisher(transport, "/cmd_vel", "lost"), RemotePublisher(transport, "/cmd_vel", "other")
        lost.send(forward_twist(0.1))
        other.send(forward_twist(0.3))
        lost.disappear()
        await advance(server, graph, 1.5)
        assert robot_speed(server) == pytest.approx(0.3, abs=0.02)
        assert not logged_warnings(log)


async def test_lost_commander_is_reported_after_pending_command() -> None:
    async with running_server(GROUND, robot(classic_plugin())) as (server, graph, log):
        driver = RemotePublisher(RemoteTransport(graph), "/cmd_vel")
        driver.send(forward_twist(0.3))
        driver.disappear()  # before the command is processed
        await advance(server, graph, 1.0)
        assert robot_speed(server) == pytest.approx(0.0, abs=0.01)
        assert len(logged_warnings(log)) == 1


async def test_lost_commander_of_stopped_robot_is_not_reported() -> None:
    async with running_server(GROUND, robot(classic_plugin())) as (server, graph, log):
        driver = RemotePublisher(RemoteTransport(graph), "/cmd_vel")
        driver.send(forward_twist(0.3))
        driver.send(forward_twist(0.0))
        await advance(server, graph, 0.5)
        driver.disappear()
        await advance(server, graph, 0.1)
        assert not logged_warnings(log)


async def test_drive_with_two_topic_names_tracks_last_commander() -> None:
    plugin = gz_plugin().replace("<topic>cmd_vel</topic>", "")
    async with running_server(GROUND, robot(plugin), options=ServerOptions(usual_names=True)) as (server, graph, log):
        transport = RemoteTransport(graph)
        model_topic, usual_topic = (
            RemotePublisher(transport, "/model/mbot/cmd_vel", "mine"),
            RemotePublisher(transport, "/cmd_vel", "usual"),
        )
        model_topic.send(forward_twist(0.1))
        await graph.settle()
        usual_topic.send(forward_twist(0.3))
        await graph.settle()
        model_topic.disappear()
        await advance(server, graph, 1.5)
        assert robot_speed(server) == pytest.approx(0.3, abs=0.02)
        usual_topic.disappear()
        await advance(server, graph, 1.5)
        assert robot_speed(server) == pytest.approx(0.0, abs=0.01)
        assert len(logged_warnings(log)) == 1


async def advance(server, graph, seconds: float) -> None:
    """Advance the time, and deliver messages before and after."""
    await graph.settle()
    server.advance(round(seconds * SECOND_NS))
    await graph.settle()


def robot_speed(server) -> float:
    """Return the robot's speed in m/s."""
    linear, _ = server.simulation.link_velocity(server.simulation.scene.models["mbot"].structure.links[0].link.name)
    return float(linear[0] ** 2 + linear[1] ** 2) ** 0.5
