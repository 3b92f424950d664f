"""Controllers whose commander is lost.

Velocities are stopped, positions and efforts are held.
"""

from __future__ import annotations

import pytest

from linkwright.control.controllers.registry import controller_class
from linkwright.graph.log.logger import LogLevel
from linkwright.messages import get_message
from tests.remote_publishers import RemotePublisher, RemoteTransport

Array, Stamped = get_message("std_msgs/msg/Float64MultiArray"), get_message("geometry_msgs/msg/TwistStamped")
FORWARD = "forward_command_controller/ForwardCommandController"
WHEELS = {"left_wheel_names": ["left"], "right_wheel_names": ["right"], "wheel_separation": 0.4, "wheel_radius": 0.1}


@pytest.mark.parametrize(
    ("kind", "interface", "expected"),
    [
        (FORWARD, "velocity", 0.0),
        ("velocity_controllers/JointGroupVelocityController", "velocity", 0.0),
        (FORWARD, "position", 0.5),
        (FORWARD, "effort", 0.5),
    ],
)
async def test_lost_publisher_stops_velocity_and_holds_position_and_effort(bench, kind, interface, expected):
    bench.joint("hip", commands=(interface,))
    parameters = {"interface_name": interface} if kind == FORWARD else {}
    controller = bench.start(controller_class(kind), "hips", joints=["hip"], **parameters)
    driver = RemotePublisher(RemoteTransport(bench.graph), "/hips/commands", msg_type="std_msgs/msg/Float64MultiArray")
    driver.send(Array(data=[0.5]))
    await bench.step(controller)
    assert bench.commands[f"hip/{interface}"].value == 0.5
    driver.disappear()
    await bench.step(controller)
    assert bench.commands[f"hip/{interface}"].value == expected
    texts = [record.text for record in bench.log if "was lost" in record.text]
    assert len(texts) == (expected == 0.0)


async def test_drive_stops_before_timeout_when_publisher_is_lost(bench):
    for side in ("left", "right"):
        bench.joint(side, commands=("velocity",), position=0.0)
    drive = controller_class("diff_drive_controller/DiffDriveController")
    controller = bench.start(drive, "base", cmd_vel_timeout=10.0, **WHEELS)
    driver = RemotePublisher(RemoteTransport(bench.graph), "/base/cmd_vel", msg_type="geometry_msgs/msg/TwistStamped")
    message = Stamped()
    message.twist.linear.x = 1.0
    driver.send(message)
    await bench.step(controller, count=3)
    assert [command.value for command in bench.commands.values()] == pytest.approx([10.0, 10.0])
    driver.disappear()
    await bench.step(controller)
    assert [command.value for command in bench.commands.values()] == [0.0, 0.0]
    (text,) = [record.text for record in bench.log if "was lost" in record.text]
    assert text.startswith("'/driver', which sent the commands on '/base/cmd_vel', was lost")


async def test_drive_reports_two_simultaneous_publishers_once(bench, clock):
    for side in ("left", "right"):
        bench.joint(side, commands=("velocity",), position=0.0)
    drive = controller_class("diff_drive_controller/DiffDriveController")
    controller = bench.start(drive, "base", **WHEELS)
    transport = RemoteTransport(bench.graph)
    drivers = [
        RemotePublisher(transport, "/base/cmd_vel", name, "geometry_msgs/msg/TwistStamped")
        for name in ("keys", "planner")
    ]
    message = Stamped()
    for speed in range(1, 101):
        message.header.stamp.sec, message.twist.linear.x = speed, float(speed)
        drivers[speed % 2].send(message)
        await clock.advance(0.1)
    await bench.step(controller)
    (warning,) = [record.text for record in bench.log if record.level >= LogLevel.WARN]
    assert warning.startswith("several nodes drive the robot: '/keys', '/planner' send commands on '/base/cmd_vel'")


async def test_lost_publisher_of_expired_command_is_not_reported(bench):
    for side in ("left", "right"):
        bench.joint(side, commands=("velocity",), position=0.0)
    drive = controller_class("diff_drive_controller/DiffDriveController")
    controller = bench.start(drive, "base", cmd_vel_timeout=0.05, **WHEELS)
    driver = RemotePublisher(RemoteTransport(bench.graph), "/base/cmd_vel", msg_type="geometry_msgs/msg/TwistStamped")
    message = Stamped()
    message.twist.linear.x = 1.0
    driver.send(message)
    await bench.step(controller, count=20)
    driver.disappear()
    await bench.step(controller)
    assert not [record.text for record in bench.log if "was lost" in record.text]
