"""Controllers of ROS 1 for one joint, and trajectory controllers under their old names."""

from __future__ import annotations

from math import isnan, nan

import pytest

from linkwright.control.controllers.joint_state_broadcaster import JointStateBroadcaster
from linkwright.control.controllers.registry import controller_class
from linkwright.control.controllers.single_joint_controllers import ClassicPid
from linkwright.diagnostics import LinkwrightError
from linkwright.messages import get_message
from tests.control.robots import robot

GAINS = {"pid": {"p": 10.0, "d": 1.0}}


def start_controller(bench, kind: str, interface: str, **parameters):
    """Return the active controller of the joint ``hip``.

    The joint is at 0.5 rad and turns at 2 rad/s.
    """
    bench.joint("hip", commands=(interface,), position=0.5, velocity=2.0)
    return bench.start(controller_class(kind), "hip_controller", joint="hip", **parameters)


def publish_command(bench, value: float) -> None:
    bench.publish("std_msgs/msg/Float64", "/hip_controller/command", get_message("std_msgs/msg/Float64")(data=value))


@pytest.mark.parametrize(
    ("kind", "interface", "first"),
    [("Position", "position", 0.5), ("Velocity", "velocity", 0.0), ("Effort", "effort", 0.0)],
)
async def test_command_is_forwarded_to_the_joint(bench, kind, interface, first):
    controller = start_controller(bench, f"{interface}_controllers/Joint{kind}Controller", interface)
    command = bench.commands[f"hip/{interface}"]
    await bench.step(controller)
    assert command.value == first
    publish_command(bench, 1.25)
    await bench.step(controller)
    assert command.value == 1.25
    publish_command(bench, nan)
    await bench.step(controller)
    assert command.value == 1.25
    controller.on_deactivate()
    assert command.value == (1.25 if kind == "Position" else 0.0)


async def test_effort_follows_the_error_of_the_position(bench):
    controller = start_controller(bench, "effort_controllers/JointPositionController", "effort", pid={"p": 10.0})
    await bench.step(controller)
    assert bench.commands["hip/effort"].value == 0.0
    publish_command(bench, 0.75)
    await bench.step(controller)
    assert bench.commands["hip/effort"].value == pytest.approx(2.5)


async def test_derivative_gain_acts_on_the_change_of_the_error(bench):
    controller = start_controller(bench, "effort_controllers/JointPositionController", "effort", **GAINS)
    await bench.step(controller)
    publish_command(bench, 0.75)
    await bench.step(controller)
    assert bench.commands["hip/effort"].value == pytest.approx(2.5 + 0.25 / 0.01)


async def test_effort_follows_the_error_of_the_velocity(bench):
    controller = start_controller(bench, "effort_controllers/JointVelocityController", "effort", pid={"p": 3.0})
    await bench.step(controller)
    assert bench.commands["hip/effort"].value == pytest.approx(-6.0)
    publish_command(bench, 2.5)
    await bench.step(controller)
    assert bench.commands["hip/effort"].value == pytest.approx(1.5)


async def test_velocity_follows_the_error_of_the_position(bench):
    controller = start_controller(bench, "velocity_controllers/JointPositionController", "velocity", pid={"p": 4.0})
    publish_command(bench, 1.0)
    await bench.step(controller)
    assert bench.commands["hip/velocity"].value == pytest.approx(2.0)


async def test_continuous_joint_turns_the_shortest_way(bench):
    bench.joint("hip", commands=("effort",), position=3.0)
    kind = controller_class("effort_controllers/JointPositionController")
    description = robot("").replace("revolute", "continuous")
    controller = bench.activate(bench.make(kind, description=description, joint="hip", pid={"p": 1.0}))
    message = get_message("std_msgs/msg/Float64")(data=-3.0)
    bench.publish("std_msgs/msg/Float64", "/controller/command", message)
    await bench.step(controller)
    assert bench.commands["hip/effort"].value == pytest.approx(2 * 3.14159265 - 6.0)


@pytest.mark.parametrize(
    ("bounds", "expected"),
    [
        ({}, (0.0, 0.0)),
        ({"i_clamp": 2.0}, (-2.0, 2.0)),
        ({"i_clamp_min": -1.0, "i_clamp_max": 3.0}, (-1.0, 3.0)),
        ({"i_clamp": 2.0, "i_clamp_max": 3.0}, (-2.0, 3.0)),
    ],
)
def test_integral_needs_a_bound(bounds, expected):
    gains = ClassicPid(p=1.0, i=5.0, **bounds).pid
    assert (gains.i_min, gains.i_max) == expected
    assert (gains.p, gains.i) == (1.0, 5.0)


async def test_velocity_stops_without_its_commander(bench):
    controller = start_controller(bench, "velocity_controllers/JointVelocityController", "velocity")
    assert controller._stop_motion() is False
    publish_command(bench, 1.0)
    await bench.step(controller)
    assert controller._stop_motion() is True
    await bench.step(controller)
    assert bench.commands["hip/velocity"].value == 0.0
    position = start_controller(bench, "position_controllers/JointPositionController", "position")
    assert position._stop_motion() is False


def test_command_before_activation_is_ignored(bench):
    controller = bench.make(controller_class("velocity_controllers/JointVelocityController"), joint="hip")
    controller.on_configure()
    assert controller._stop_motion() is False
    controller._on_command(get_message("std_msgs/msg/Float64")(data=1.0))
    assert isnan(controller._target)


def test_joint_is_required(bench):
    with pytest.raises(LinkwrightError, match="Parameter 'joint' cannot be empty"):
        bench.make(controller_class("position_controllers/JointPositionController"))


@pytest.mark.parametrize("interface", ["position", "velocity", "effort"])
def test_trajectory_controller_commands_the_interface_in_its_name(bench, interface):
    kind = controller_class(f"{interface}_controllers/JointTrajectoryController")
    controller = bench.make(kind, joints=["hip"], gains={"hip": {"p": 1.0}})
    assert list(controller.command_interfaces()) == [f"hip/{interface}"]
    assert list(controller.state_interfaces()) == ["hip/position", "hip/velocity"]


@pytest.mark.parametrize("topic", ["command", "joint_trajectory"])
async def test_trajectory_controller_accepts_trajectories_on_both_topics(bench, topic):
    bench.joint("hip", commands=("position",), position=0.0, velocity=0.0)
    kind = controller_class("position_controllers/JointTrajectoryController")
    controller = bench.start(kind, joints=["hip"])
    point = get_message("trajectory_msgs/msg/JointTrajectoryPoint")(positions=[0.5])
    message = get_message("trajectory_msgs/msg/JointTrajectory")(joint_names=["hip"], points=[point])
    bench.publish("trajectory_msgs/msg/JointTrajectory", f"/controller/{topic}", message)
    await bench.step(controller, count=3)
    assert bench.commands["hip/position"].value == pytest.approx(0.5)


def test_joint_state_controller_is_the_broadcaster():
    assert controller_class("joint_state_controller/JointStateController") is JointStateBroadcaster


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("imu_sensor_controller/ImuSensorController", "imu_sensor_broadcaster/IMUSensorBroadcaster"),
        ("four_wheel_steering_controller/FourWheelSteeringController", "ackermann_steering_controller/Ackermann"),
    ],
)
def test_other_controllers_of_ros1_are_refused_with_their_replacement(old, new):
    with pytest.raises(LinkwrightError) as error:
        controller_class(old)
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.code == "CTL103"
    assert f"use {new}" in str(diagnostic.hint)
