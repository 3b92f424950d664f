"""The mecanum drive controller with the parameters of Husarion."""

from __future__ import annotations

from math import cos, sin

import pytest

from linkwright.control.controllers.controller import ControllerError
from linkwright.control.controllers.husarion_mecanum_controller import HusarionMecanumController
from linkwright.control.controllers.mecanum_drive_controller import MecanumDriveController
from tests.control.controllers.driving import roll_wheels, stamped_twist, twist

CONTROLLER_NAME = "base"
CORNERS = ("front_left", "front_right", "rear_left", "rear_right")
PARAMETERS = {f"{corner}_wheel_name": corner for corner in CORNERS} | {
    "wheel_separation_x": 0.4,
    "wheel_separation_y": 0.6,
    "wheel_radius": 0.1,
    "velocity_rolling_window_size": 1,
}


@pytest.fixture
def wheel_bench(bench):
    """Return a test bench with four wheels."""
    for joint in CORNERS:
        bench.joint(joint, commands=("velocity",), position=0.0, velocity=0.0)
    return bench


def publish_command(bench, forward: float, sideways: float, turning: float) -> None:
    bench.publish(
        "geometry_msgs/msg/TwistStamped", f"/{CONTROLLER_NAME}/cmd_vel", stamped_twist(0, forward, turning, sideways)
    )


def wheel_commands(bench) -> list[float]:
    return [bench.commands[f"{corner}/velocity"].value for corner in CORNERS]


def test_husarion_parameters_select_husarion_controller():
    assert MecanumDriveController.variant(list(PARAMETERS)) is HusarionMecanumController
    assert MecanumDriveController.variant(["front_left_wheel_command_joint_name"]) is MecanumDriveController
    assert HusarionMecanumController.variant(list(PARAMETERS)) is HusarionMecanumController


@pytest.mark.parametrize(
    ("velocity", "wheels_turn"),
    [
        ((1.0, 0.0, 0.0), [10.0, 10.0, 10.0, 10.0]),
        ((0.0, 1.0, 0.0), [-10.0, 10.0, 10.0, -10.0]),
        ((0.0, 0.0, 1.0), [-5.0, 5.0, -5.0, 5.0]),
    ],
)
async def test_wheel_speeds_match_motion_with_and_without_header(wheel_bench, velocity, wheels_turn):
    controller = wheel_bench.start(HusarionMecanumController, CONTROLLER_NAME, **PARAMETERS, use_stamped_vel=False)
    publish_command(wheel_bench, *velocity)
    await wheel_bench.step(controller)
    assert wheel_commands(wheel_bench) == pytest.approx(wheels_turn)
    forward, sideways, turning = velocity
    message = twist(-forward, -turning, -sideways)
    wheel_bench.publish("geometry_msgs/msg/Twist", f"/{CONTROLLER_NAME}/cmd_vel_unstamped", message)
    await wheel_bench.step(controller)
    assert wheel_commands(wheel_bench) == pytest.approx([-speed for speed in wheels_turn])


async def test_command_expires_after_timeout(wheel_bench):
    controller = wheel_bench.start(HusarionMecanumController, CONTROLLER_NAME, **PARAMETERS, cmd_vel_timeout=0.1)
    publish_command(wheel_bench, 1.0, 0.0, 0.0)
    await wheel_bench.step(controller, 0.05)
    assert wheel_commands(wheel_bench) == [10.0] * 4
    await wheel_bench.step(controller, 0.05, count=3)
    assert wheel_commands(wheel_bench) == [0.0] * 4


async def test_limits_apply_to_each_axis_and_result_is_published(wheel_bench):
    limits = {"linear": {"y": {"has_velocity_limits": True, "max_velocity": 0.5}}}
    controller = wheel_bench.start(
        HusarionMecanumController, CONTROLLER_NAME, **PARAMETERS, **limits, publish_limited_velocity=True
    )
    commands = wheel_bench.record("geometry_msgs/msg/TwistStamped", f"/{CONTROLLER_NAME}/cmd_vel_out")
    publish_command(wheel_bench, 0.2, 2.0, 0.0)
    await wheel_bench.step(controller)
    assert (commands[-1].twist.linear.x, commands[-1].twist.linear.y) == pytest.approx((0.2, 0.5))


@pytest.mark.parametrize("source", [{"position_feedback": True}, {"position_feedback": False}, {"open_loop": True}])
async def test_odometry_matches_driven_arc(wheel_bench, source):
    controller = wheel_bench.start(
        HusarionMecanumController, CONTROLLER_NAME, **PARAMETERS, **source, cmd_vel_timeout=60.0
    )
    odometry = wheel_bench.record("nav_msgs/msg/Odometry", f"/{CONTROLLER_NAME}/odom")
    publish_command(wheel_bench, 0.3, 0.4, 0.5)
    await roll_wheels(wheel_bench, controller, 501)
    pose, velocity = odometry[-1].pose.pose, odometry[-1].twist.twist
    yaw = 2.5
    x = (0.3 * sin(yaw) + 0.4 * (cos(yaw) - 1.0)) / 0.5
    y = (0.3 * (1.0 - cos(yaw)) + 0.4 * sin(yaw)) / 0.5
    assert (pose.position.x, pose.position.y) == pytest.approx((x, y), abs=0.02)
    assert (velocity.linear.x, velocity.linear.y, velocity.angular.z) == pytest.approx((0.3, 0.4, 0.5))


@pytest.mark.parametrize("missing", [f"{CORNERS[0]}_wheel_name", "wheel_radius", "wheel_separation_x"])
def test_missing_parameter_is_reported(wheel_bench, missing):
    parameters = {name: value for name, value in PARAMETERS.items() if name != missing}
    with pytest.raises(ControllerError, match=missing):
        wheel_bench.make(HusarionMecanumController, CONTROLLER_NAME, **parameters).on_configure()
