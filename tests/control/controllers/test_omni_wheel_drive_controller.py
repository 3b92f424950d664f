"""The drive of three or more omni wheels."""

from __future__ import annotations

from math import cos, nan, pi, sin

import numpy as np
import pytest

from linkwright.control.controllers.controller import ControllerError
from linkwright.control.controllers.omni_wheel_drive_controller import OmniWheelDriveController
from linkwright.control.controllers.registry import controller_class
from linkwright.kinematics.drives import OmniDrive
from tests.control.controllers.driving import stamped_twist

CONTROLLER_NAME = "base"
WHEELS = ("front", "left", "right")
PARAMETERS = {"wheel_names": list(WHEELS), "robot_radius": 0.2, "wheel_radius": 0.05}


@pytest.fixture
def wheel_bench(bench):
    """Return a test bench with three wheels."""
    for joint in WHEELS:
        bench.joint(joint, commands=("velocity",), position=0.0, velocity=0.0)
    return bench


def publish_command(bench, forward: float, sideways: float, angular: float) -> None:
    bench.publish(
        "geometry_msgs/msg/TwistStamped", f"/{CONTROLLER_NAME}/cmd_vel", stamped_twist(0, forward, angular, sideways)
    )


def wheel_commands(bench) -> list[float]:
    return [bench.commands[f"{wheel}/velocity"].value for wheel in WHEELS]


def test_controller_is_found_by_type():
    assert controller_class("omni_wheel_drive_controller/OmniWheelDriveController") is OmniWheelDriveController


@pytest.mark.parametrize(("count", "offset"), [(3, 0.0), (4, pi / 4), (5, 0.3)])
def test_motion_is_least_squares_solution_of_wheel_speeds(count, offset):
    drive = OmniDrive(count, 0.2, 0.05, offset)
    assert drive.motion(drive.wheel_speeds(0.3, -0.2, 0.7)) == pytest.approx((0.3, -0.2, 0.7))
    angles = [offset + 2 * pi * index / count for index in range(count)]
    equations = np.array([[sin(angle), -cos(angle), -0.2] for angle in angles])
    speeds = np.linspace(-2.0, 5.0, count)
    expected = np.linalg.lstsq(equations, speeds * 0.05, rcond=None)[0]
    assert drive.motion(list(speeds)) == pytest.approx(tuple(expected))


async def test_wheels_turn_for_motion_and_stop_after_timeout(wheel_bench):
    controller = wheel_bench.start(OmniWheelDriveController, CONTROLLER_NAME, **PARAMETERS, cmd_vel_timeout=0.1)
    publish_command(wheel_bench, 0.0, 0.5, 0.0)
    await wheel_bench.step(controller)
    assert wheel_commands(wheel_bench) == pytest.approx([-10.0, 5.0, 5.0])
    publish_command(wheel_bench, 0.0, 0.0, 1.0)
    await wheel_bench.step(controller)
    assert wheel_commands(wheel_bench) == pytest.approx([-4.0, -4.0, -4.0])
    await wheel_bench.step(controller, count=20)
    assert wheel_commands(wheel_bench) == [0.0, 0.0, 0.0]


@pytest.mark.parametrize(
    "settings", [{}, {"position_feedback": False}, {"open_loop": True}], ids=["position", "velocity", "open loop"]
)
async def test_odometry_follows_motion(wheel_bench, settings):
    controller = wheel_bench.start(
        OmniWheelDriveController, CONTROLLER_NAME, **PARAMETERS, **settings, cmd_vel_timeout=5.0
    )
    odometry = wheel_bench.record("nav_msgs/msg/Odometry", f"/{CONTROLLER_NAME}/odom")
    transforms = wheel_bench.record("tf2_msgs/msg/TFMessage", "/tf")
    publish_command(wheel_bench, 0.3, 0.4, 0.0)
    for _ in range(101):
        for wheel in WHEELS:
            speed = wheel_bench.commands[f"{wheel}/velocity"].value
            if speed == speed:  # unknown before the first update
                wheel_bench.states[f"{wheel}/velocity"].value = speed
                wheel_bench.states[f"{wheel}/position"].value += speed * 0.01
        await wheel_bench.step(controller)
    last = odometry[-1]
    assert (last.header.frame_id, last.child_frame_id) == ("odom", "base_link")
    assert last.twist.twist.linear.x == pytest.approx(0.3)
    assert last.pose.pose.position.x == pytest.approx(0.3, abs=0.01)
    assert last.pose.pose.position.y == pytest.approx(0.4, abs=0.01)
    assert transforms[-1].transforms[0].transform.translation.y == pytest.approx(0.4, abs=0.01)


async def test_states_and_commands_that_are_not_finite_are_ignored(wheel_bench):
    controller = wheel_bench.start(OmniWheelDriveController, CONTROLLER_NAME, **PARAMETERS)
    odometry = wheel_bench.record("nav_msgs/msg/Odometry", f"/{CONTROLLER_NAME}/odom")
    wheel_bench.states["left/position"].value = nan
    publish_command(wheel_bench, nan, 0.0, 0.0)
    await wheel_bench.step(controller)
    assert wheel_commands(wheel_bench) == [0.0, 0.0, 0.0]
    assert odometry[-1].pose.pose.position.x == 0.0


async def test_another_controller_commands_references_and_deactivation_stops_wheels(wheel_bench):
    controller = wheel_bench.start(OmniWheelDriveController, CONTROLLER_NAME, **PARAMETERS)
    controller.is_chained = True
    for reference, value in zip(controller.references, (0.0, 0.5, 0.0), strict=True):
        reference.value = value
    await wheel_bench.step(controller)
    assert wheel_commands(wheel_bench) == pytest.approx([-10.0, 5.0, 5.0])
    controller.on_deactivate()
    assert wheel_commands(wheel_bench) == [0.0, 0.0, 0.0]


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"wheel_names": ["front", "left"]}, "The number of wheels is less than 3"),
        ({"robot_radius": 0.0}, "'robot_radius' with the value 0 must be above 0"),
        ({"diagonal_covariance": {"pose": [0.1]}}, "'diagonal_covariance.pose' must have 6 numbers"),
    ],
)
async def test_invalid_parameters_are_rejected(wheel_bench, settings, message):
    with pytest.raises(ControllerError, match=message):
        wheel_bench.make(OmniWheelDriveController, CONTROLLER_NAME, **PARAMETERS | settings).on_configure()
