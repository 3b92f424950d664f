"""The mecanum drive controller: wheel speeds, odometry, limits and timeouts."""

from __future__ import annotations

from math import cos, isnan, nan, pi, sin

import pytest

from linkwright.control.controllers.controller import ControllerError
from linkwright.control.controllers.mecanum_drive_controller import MecanumDriveController
from linkwright.control.controllers.registry import controller_class
from tests.control.controllers.driving import roll_wheels, stamped_twist

CONTROLLER_NAME = "base"
CORNERS = ("front_left", "front_right", "rear_right", "rear_left")
CENTER_DISTANCE_SUM, WHEEL_RADIUS = 0.5, 0.1
SIZES = {"wheels_radius": WHEEL_RADIUS, "sum_of_robot_center_projection_on_X_Y_axis": CENTER_DISTANCE_SUM}
PARAMETERS = {f"{corner}_wheel_command_joint_name": corner for corner in CORNERS} | {"kinematics": SIZES}


@pytest.fixture
def wheel_bench(bench):
    """Return a test bench with four wheels."""
    for joint in CORNERS:
        bench.joint(joint, commands=("velocity",), position=0.0, velocity=0.0)
    return bench


def publish_command(bench, forward: float, sideways: float, turning: float) -> None:
    bench.publish(
        "geometry_msgs/msg/TwistStamped", f"/{CONTROLLER_NAME}/reference", stamped_twist(0, forward, turning, sideways)
    )


def wheel_commands(bench) -> list[float]:
    return [bench.commands[f"{corner}/velocity"].value for corner in CORNERS]


def test_controller_is_found_by_type():
    assert controller_class("mecanum_drive_controller/MecanumDriveController") is MecanumDriveController


@pytest.mark.parametrize(
    ("velocity", "wheels_turn"),
    [
        ((1.0, 0.0, 0.0), [10.0, 10.0, 10.0, 10.0]),
        ((0.0, 1.0, 0.0), [-10.0, 10.0, -10.0, 10.0]),
        ((0.0, 0.0, 1.0), [-5.0, 5.0, 5.0, -5.0]),
    ],
)
async def test_wheel_speeds_match_motion(wheel_bench, velocity, wheels_turn):
    controller = wheel_bench.start(MecanumDriveController, CONTROLLER_NAME, **PARAMETERS, reference_timeout=1.0)
    publish_command(wheel_bench, *velocity)
    await wheel_bench.step(controller)
    assert wheel_commands(wheel_bench) == pytest.approx(wheels_turn)


async def test_odometry_matches_driven_arc(wheel_bench):
    controller = wheel_bench.start(MecanumDriveController, CONTROLLER_NAME, **PARAMETERS, reference_timeout=60.0)
    odometry = wheel_bench.record("nav_msgs/msg/Odometry", f"/{CONTROLLER_NAME}/odometry")
    transforms = wheel_bench.record("tf2_msgs/msg/TFMessage", f"/{CONTROLLER_NAME}/tf_odometry")
    publish_command(wheel_bench, 0.3, 0.4, 0.5)
    await roll_wheels(wheel_bench, controller, 501)
    pose, velocity, yaw = odometry[-1].pose.pose, odometry[-1].twist.twist, 2.5
    x = (0.3 * sin(yaw) + 0.4 * (cos(yaw) - 1.0)) / 0.5
    y = (0.3 * (1.0 - cos(yaw)) + 0.4 * sin(yaw)) / 0.5
    assert (pose.position.x, pose.position.y) == pytest.approx((x, y), abs=1e-9)
    assert (velocity.linear.x, velocity.linear.y, velocity.angular.z) == pytest.approx((0.3, 0.4, 0.5))
    assert transforms[-1].transforms[0].transform.translation.x == pose.position.x


async def test_base_frame_offset_is_applied(wheel_bench):
    offset = {"x": 0.2, "y": -0.1, "theta": pi / 2.0}
    sizes = {"kinematics": SIZES | {"base_frame_offset": offset}}
    controller = wheel_bench.start(
        MecanumDriveController, CONTROLLER_NAME, **PARAMETERS | sizes, reference_timeout=60.0
    )
    odometry = wheel_bench.record("nav_msgs/msg/Odometry", f"/{CONTROLLER_NAME}/odometry")
    publish_command(wheel_bench, 1.0, 0.0, 0.0)
    await wheel_bench.step(controller)
    assert wheel_commands(wheel_bench) == pytest.approx([-10.0, 10.0, -10.0, 10.0])
    publish_command(wheel_bench, 0.3, 0.4, 0.5)
    await roll_wheels(wheel_bench, controller, 3)
    velocity = odometry[-1].twist.twist
    assert (velocity.linear.x, velocity.linear.y, velocity.angular.z) == pytest.approx((0.3, 0.4, 0.5))


async def test_command_expires_after_timeout_or_one_update(wheel_bench):
    controller = wheel_bench.start(MecanumDriveController, CONTROLLER_NAME, **PARAMETERS)
    publish_command(wheel_bench, 1.0, 0.0, 0.0)
    await wheel_bench.step(controller, 0.001)
    assert wheel_commands(wheel_bench) == pytest.approx([10.0] * 4)
    await wheel_bench.step(controller, 0.001)
    assert wheel_commands(wheel_bench) == [0.0] * 4
    publish_command(wheel_bench, nan, 0.0, 0.0)
    await wheel_bench.step(controller, 0.001)
    assert wheel_commands(wheel_bench) == [0.0] * 4


async def test_limits_apply_to_each_axis_until_command_expires(wheel_bench):
    limits = {"linear": {"x": {"max_acceleration": 1.0}, "y": {"max_velocity": 0.2}}, "angular": {"z": {}}}
    controller = wheel_bench.start(
        MecanumDriveController, CONTROLLER_NAME, **PARAMETERS, **limits, reference_timeout=0.25
    )
    publish_command(wheel_bench, 1.0, 0.5, 0.0)
    for forward in (0.1, 0.2):
        await wheel_bench.step(controller, 0.1)
        assert wheel_commands(wheel_bench) == pytest.approx(
            [10.0 * (forward + sign * 0.2) for sign in (-1, 1, -1, 1)], abs=1e-9
        )
    await wheel_bench.step(controller, 0.1, count=2)
    assert wheel_commands(wheel_bench) == [0.0, 0.0, 0.0, 0.0]
    publish_command(wheel_bench, 1.0, 0.0, 0.0)
    await wheel_bench.step(controller, 0.1)
    assert wheel_commands(wheel_bench) == pytest.approx([1.0, 1.0, 1.0, 1.0])


async def test_chained_mode_accepts_references_and_publishes_state(wheel_bench):
    controller = wheel_bench.start(MecanumDriveController, CONTROLLER_NAME, **PARAMETERS)
    assert [reference.name for reference in controller.references] == [
        "base/linear/x/velocity",
        "base/linear/y/velocity",
        "base/angular/z/velocity",
    ]
    states = wheel_bench.record("control_msgs/msg/MecanumDriveControllerState", f"/{CONTROLLER_NAME}/controller_state")
    controller.is_chained = True
    for reference, value in zip(controller.references, (0.0, 1.0, 0.0), strict=True):
        reference.value = value
    await roll_wheels(wheel_bench, controller)
    assert states[-1].reference_velocity.linear.y == 1.0
    await roll_wheels(wheel_bench, controller)
    assert wheel_commands(wheel_bench) == [0.0] * 4
    assert (states[-1].front_left_wheel_velocity, states[-1].back_left_wheel_velocity) == pytest.approx((-10.0, 10.0))
    assert isnan(states[-1].reference_velocity.linear.y)


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({"rear_left_wheel_command_joint_name": ""}, "'rear_left_wheel_command_joint_name' cannot be empty"),
        (
            {"kinematics": {"wheels_radius": 0.1}},
            "'kinematics.sum_of_robot_center_projection_on_X_Y_axis' with the value 0",
        ),
    ],
)
def test_invalid_parameters_fail_configuration(wheel_bench, parameters, message):
    with pytest.raises(ControllerError) as error:
        wheel_bench.start(MecanumDriveController, CONTROLLER_NAME, **PARAMETERS | parameters)
    assert message in str(error.value)
