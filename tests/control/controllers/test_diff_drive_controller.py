"""The differential drive controller: wheel speeds, odometry, limits and timeouts."""

from __future__ import annotations

from itertools import pairwise
from math import cos, inf, nan, sin

import pytest

from linkwright.control.controllers.controller import ControllerError
from linkwright.control.controllers.diff_drive_controller import DiffDriveController
from linkwright.control.controllers.registry import controller_class
from linkwright.diagnostics import LinkwrightError
from tests.control.controllers.driving import STEP_S, logged_warnings, roll_wheels, stamped_twist, twist

CONTROLLER_NAME = "base"
PARAMETERS = {
    "left_wheel_names": ["left"],
    "right_wheel_names": ["right"],
    "wheel_separation": 0.4,
    "wheel_radius": 0.1,
}


@pytest.fixture
def wheel_bench(bench):
    """Return a test bench with two wheels."""
    for joint in ("left", "right"):
        bench.joint(joint, commands=("velocity",), position=0.0, velocity=0.0)
    return bench


def wheel_commands(bench) -> list[float]:
    return [bench.commands[f"{joint}/velocity"].value for joint in ("left", "right")]


def publish_command(bench, *velocity: float, time_ns: int = 0) -> None:
    bench.publish("geometry_msgs/msg/TwistStamped", f"/{CONTROLLER_NAME}/cmd_vel", stamped_twist(time_ns, *velocity))


def test_controller_is_found_by_type():
    assert controller_class("diff_drive_controller/DiffDriveController") is DiffDriveController


async def test_command_turns_wheels(wheel_bench):
    controller = wheel_bench.start(DiffDriveController, CONTROLLER_NAME, **PARAMETERS)
    await wheel_bench.step(controller)
    assert wheel_commands(wheel_bench) == [0.0, 0.0]
    publish_command(wheel_bench, 1.0, 0.5)
    await wheel_bench.step(controller)
    assert wheel_commands(wheel_bench) == pytest.approx([9.0, 11.0])


async def test_multipliers_correct_wheel_dimensions(wheel_bench):
    parameters = {
        "wheel_separation_multiplier": 2.0,
        "left_wheel_radius_multiplier": 0.5,
        "right_wheel_radius_multiplier": 2.0,
    }
    controller = wheel_bench.start(DiffDriveController, CONTROLLER_NAME, **PARAMETERS, **parameters)
    publish_command(wheel_bench, 1.0, 0.5)
    await wheel_bench.step(controller)
    assert wheel_commands(wheel_bench) == pytest.approx([0.8 / 0.05, 1.2 / 0.2])


async def test_wheels_of_one_side_turn_equally_and_are_averaged(bench):
    for joint in ("fl", "rl", "fr", "rr"):
        bench.joint(joint, commands=("velocity",), position=0.0, velocity=0.0)
    parameters = PARAMETERS | {
        "left_wheel_names": ["fl", "rl"],
        "right_wheel_names": ["fr", "rr"],
        "publish_rate": 100.0,
    }
    controller = bench.start(DiffDriveController, CONTROLLER_NAME, **parameters)
    odometry = bench.record("nav_msgs/msg/Odometry", f"/{CONTROLLER_NAME}/odom")
    await bench.step(controller)
    for joint, angle in (("fl", 1.0), ("rl", 3.0), ("fr", 2.0), ("rr", 2.0)):
        bench.states[f"{joint}/position"].value = angle
    await bench.step(controller)
    assert odometry[-1].pose.pose.position.x == pytest.approx(0.2)
    publish_command(bench, 1.0)
    await bench.step(controller)
    assert [command.value for command in bench.commands.values()] == pytest.approx([10.0] * 4)


@pytest.mark.parametrize("feedback", [True, False], ids=["positions", "velocities"])
async def test_odometry_matches_driven_arc(wheel_bench, feedback):
    controller = wheel_bench.start(
        DiffDriveController, CONTROLLER_NAME, **PARAMETERS, position_feedback=feedback, cmd_vel_timeout=60.0
    )
    odometry = wheel_bench.record("nav_msgs/msg/Odometry", f"/{CONTROLLER_NAME}/odom")
    transforms = wheel_bench.record("tf2_msgs/msg/TFMessage", "/tf")
    publish_command(wheel_bench, 0.5, 0.4)
    await roll_wheels(wheel_bench, controller, 501)
    pose, velocity = odometry[-1].pose.pose, odometry[-1].twist.twist
    yaw = 0.4 * 5.0
    assert (pose.position.x, pose.position.y) == pytest.approx((1.25 * sin(yaw), 1.25 * (1 - cos(yaw))), abs=1e-9)
    assert (pose.orientation.z, pose.orientation.w) == pytest.approx((sin(yaw / 2), cos(yaw / 2)))
    assert (velocity.linear.x, velocity.angular.z) == pytest.approx((0.5, 0.4))
    assert (odometry[-1].header.frame_id, odometry[-1].child_frame_id) == ("odom", "base_link")
    last = transforms[-1].transforms[0]
    assert (last.header.frame_id, last.child_frame_id) == ("odom", "base_link")
    assert last.transform.translation.x == pose.position.x


async def test_odometry_starts_at_zero_for_any_wheel_angle(wheel_bench):
    wheel_bench.states["left/position"].value = 100.0
    controller = wheel_bench.start(DiffDriveController, CONTROLLER_NAME, **PARAMETERS, publish_rate=100.0)
    odometry = wheel_bench.record("nav_msgs/msg/Odometry", f"/{CONTROLLER_NAME}/odom")
    await wheel_bench.step(controller, count=3)
    assert odometry[-1].pose.pose.position.x == 0.0


async def test_open_loop_odometry_follows_limited_command(wheel_bench):
    limits = {"linear": {"x": {"max_acceleration": 1.0}}}
    controller = wheel_bench.start(
        DiffDriveController, CONTROLLER_NAME, **PARAMETERS, open_loop=True, cmd_vel_timeout=60.0, **limits
    )
    assert controller.states == []
    odometry = wheel_bench.record("nav_msgs/msg/Odometry", f"/{CONTROLLER_NAME}/odom")
    publish_command(wheel_bench, 1.0)
    await wheel_bench.step(controller, count=201)
    assert odometry[-1].pose.pose.position.x == pytest.approx(0.505 + 1.01, abs=1e-9)
    assert odometry[-1].twist.twist.linear.x == 1.0


@pytest.mark.parametrize("has_zero_stamp", [True, False], ids=["no time in the header", "time in the header"])
async def test_command_expires_after_timeout(wheel_bench, has_zero_stamp):
    controller = wheel_bench.start(DiffDriveController, CONTROLLER_NAME, **PARAMETERS, cmd_vel_timeout=0.25)
    await wheel_bench.step(controller, 0.001)
    publish_command(wheel_bench, 1.0, time_ns=0 if has_zero_stamp else wheel_bench.time_ns + 1_000_000)
    await wheel_bench.step(controller, 0.001, count=251)
    assert wheel_commands(wheel_bench) == pytest.approx([10.0, 10.0])
    await wheel_bench.step(controller, 0.001)
    assert wheel_commands(wheel_bench) == [0.0, 0.0]


async def test_command_with_stamp_of_other_clock_expires(wheel_bench):
    controller = wheel_bench.start(DiffDriveController, CONTROLLER_NAME, **PARAMETERS)
    publish_command(wheel_bench, 1.0, time_ns=1_700_000_000_000_000_000)
    await wheel_bench.step(controller)
    assert wheel_commands(wheel_bench) == pytest.approx([10.0, 10.0])
    await wheel_bench.step(controller, count=51)
    assert wheel_commands(wheel_bench) == [0.0, 0.0]


async def test_outdated_command_is_ignored_and_reported(wheel_bench):
    controller = wheel_bench.start(DiffDriveController, CONTROLLER_NAME, **PARAMETERS)
    await wheel_bench.step(controller, count=100)
    publish_command(wheel_bench, 1.0, time_ns=100_000_000)
    await wheel_bench.step(controller)
    assert wheel_commands(wheel_bench) == [0.0, 0.0]
    (text,) = logged_warnings(wheel_bench)
    assert text == (
        "Ignoring the received message (timestamp 0.100) because it is older than the current time by 0.910 seconds, "
        "which exceeds the allowed timeout (0.500)"
    )


async def test_command_is_dropped_when_time_resets(wheel_bench):
    controller = wheel_bench.start(DiffDriveController, CONTROLLER_NAME, **PARAMETERS)
    await wheel_bench.step(controller, count=100)
    publish_command(wheel_bench, 1.0)
    await wheel_bench.step(controller)
    wheel_bench.time_ns = 0
    await wheel_bench.step(controller)
    assert wheel_commands(wheel_bench) == [0.0, 0.0]


@pytest.mark.parametrize("value", [nan, inf])
async def test_command_that_is_not_a_number_stops_robot(wheel_bench, value):
    controller = wheel_bench.start(DiffDriveController, CONTROLLER_NAME, **PARAMETERS)
    publish_command(wheel_bench, 1.0, time_ns=1)
    await wheel_bench.step(controller)
    publish_command(wheel_bench, 1.0, value, time_ns=2)
    await wheel_bench.step(controller)
    assert wheel_commands(wheel_bench) == [0.0, 0.0]
    assert logged_warnings(wheel_bench) == [
        "a velocity command that is not a finite number is rejected, and the drive stops"
    ]


async def test_humble_accepts_unstamped_commands(wheel_bench):
    controller = wheel_bench.start(DiffDriveController, CONTROLLER_NAME, **PARAMETERS, use_stamped_vel=False)
    wheel_bench.publish("geometry_msgs/msg/Twist", f"/{CONTROLLER_NAME}/cmd_vel_unstamped", twist(1.0))
    await wheel_bench.step(controller)
    assert wheel_commands(wheel_bench) == pytest.approx([10.0, 10.0])
    publish_command(wheel_bench, 0.5, time_ns=wheel_bench.time_ns)
    await wheel_bench.step(controller)
    assert wheel_commands(wheel_bench) == pytest.approx([5.0, 5.0])
    assert not logged_warnings(wheel_bench)


LIMITS = {
    "linear": {"x": {"max_velocity": 1.0, "min_velocity": -0.5, "max_acceleration": 2.0, "min_acceleration": -4.0}},
    "angular": {"z": {"max_velocity": 1.5, "max_acceleration": 3.0, "max_jerk": 50.0}},
}


async def test_limits_are_respected_and_limited_command_published(wheel_bench):
    controller = wheel_bench.start(
        DiffDriveController, CONTROLLER_NAME, **PARAMETERS, **LIMITS, publish_limited_velocity=True
    )
    commands = wheel_bench.record("geometry_msgs/msg/TwistStamped", f"/{CONTROLLER_NAME}/cmd_vel_out")
    for number in range(200):
        publish_command(wheel_bench, *((9.0, -9.0), (-9.0, 9.0), (0.3, 0.1))[number // 15 % 3])
        await wheel_bench.step(controller, STEP_S)
    forward = [0.0, *(message.twist.linear.x for message in commands)]
    yaw_rates = [0.0, *(message.twist.angular.z for message in commands)]
    assert len(forward) == 201
    assert all(-0.5 <= speed <= 1.0 for speed in forward)
    assert all(-4.0 - 1e-9 <= (later - earlier) / STEP_S <= 2.0 + 1e-9 for earlier, later in pairwise(forward))
    assert all(abs(speed) <= 1.5 for speed in yaw_rates)
    assert all(abs(later - earlier) / STEP_S <= 3.0 + 1e-9 for earlier, later in pairwise(yaw_rates))
    assert controller.commands[0].value == pytest.approx((forward[-1] - yaw_rates[-1] * 0.2) / 0.1)


async def test_disabled_humble_limits_are_ignored(wheel_bench):
    disabled = {"has_velocity_limits": False, "max_velocity": 0.1, "has_jerk_limits": False, "max_jerk": 0.0}
    controller = wheel_bench.start(
        DiffDriveController, CONTROLLER_NAME, **PARAMETERS, linear={"x": disabled | {"max_acceleration": 0.0}}
    )
    publish_command(wheel_bench, 1.0)
    await wheel_bench.step(controller)
    assert wheel_commands(wheel_bench) == pytest.approx([10.0, 10.0])


async def test_jazzy_limits_differ_by_direction(wheel_bench):
    limits = {
        "max_acceleration": 2.0,
        "max_deceleration": -4.0,
        "max_acceleration_reverse": -8.0,
        "max_deceleration_reverse": 10.0,
    }
    controller = wheel_bench.start(
        DiffDriveController, CONTROLLER_NAME, **PARAMETERS, linear={"x": limits}, cmd_vel_timeout=9.0
    )
    for target, expected in ((9.0, 0.2), (-9.0, -0.2), (-9.0, -1.0), (9.0, 0.0), (9.0, 0.2)):
        publish_command(wheel_bench, target)
        await wheel_bench.step(controller, 0.1)
        assert wheel_commands(wheel_bench)[0] * 0.1 == pytest.approx(expected, abs=1e-9)


async def test_chained_mode_accepts_reference_interfaces(wheel_bench):
    controller = wheel_bench.start(DiffDriveController, CONTROLLER_NAME, **PARAMETERS)
    assert [reference.name for reference in controller.references] == ["base/linear/velocity", "base/angular/velocity"]
    controller.is_chained = True
    await wheel_bench.step(controller)
    assert wheel_commands(wheel_bench) == [0.0, 0.0]
    controller.references[0].value, controller.references[1].value = 1.0, 0.5
    await wheel_bench.step(controller, count=100)
    assert wheel_commands(wheel_bench) == pytest.approx([9.0, 11.0])


async def test_deactivation_stops_wheels(wheel_bench):
    controller = wheel_bench.start(DiffDriveController, CONTROLLER_NAME, **PARAMETERS)
    publish_command(wheel_bench, 1.0, time_ns=1)
    await wheel_bench.step(controller)
    controller.on_deactivate()
    assert wheel_commands(wheel_bench) == [0.0, 0.0]
    publish_command(wheel_bench, 1.0)
    await wheel_bench.graph.settle()
    wheel_bench.exchange.run_commands()
    assert logged_warnings(wheel_bench) == ["Can't accept new commands. subscriber is inactive"]
    controller.on_activate()
    await wheel_bench.step(controller)
    assert wheel_commands(wheel_bench) == [0.0, 0.0]


async def test_odometry_has_publish_rate_and_covariances(wheel_bench):
    diagonal = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]
    parameters = {"publish_rate": 20.0, "pose_covariance_diagonal": diagonal, "enable_odom_tf": False}
    controller = wheel_bench.start(DiffDriveController, CONTROLLER_NAME, **PARAMETERS, **parameters)
    odometry = wheel_bench.record("nav_msgs/msg/Odometry", f"/{CONTROLLER_NAME}/odom")
    transforms = wheel_bench.record("tf2_msgs/msg/TFMessage", "/tf")
    await wheel_bench.step(controller, count=100)
    times = [message.header.stamp.nanoseconds for message in odometry]
    assert times == list(range(10_000_000, 1_000_000_001, 50_000_000))
    assert list(odometry[0].pose.covariance[::7]) == diagonal
    assert not any(odometry[0].twist.covariance)
    assert not transforms


@pytest.mark.parametrize(
    ("name", "parameters", "frame"),
    [
        ("base", {}, "odom"),
        ("/robot/base", {}, "robot/odom"),
        ("/robot/base", {"tf_frame_prefix_enable": False}, "odom"),
        ("/robot/base", {"tf_frame_prefix": "/left/"}, "left/odom"),
        ("/a/b/base", {"tf_frame_prefix": "~/c"}, "a/b/c/odom"),
    ],
)
async def test_frame_ids_have_requested_prefix(wheel_bench, name, parameters, frame):
    controller = wheel_bench.start(DiffDriveController, name, **PARAMETERS, **parameters)
    odometry = wheel_bench.record("nav_msgs/msg/Odometry", f"{name if name[0] == '/' else '/' + name}/odom")
    await wheel_bench.step(controller)
    assert odometry[0].header.frame_id == frame


async def test_set_odometry_service_sets_pose(wheel_bench):
    controller = wheel_bench.start(DiffDriveController, CONTROLLER_NAME, **PARAMETERS, publish_rate=100.0)
    odometry = wheel_bench.record("nav_msgs/msg/Odometry", f"/{CONTROLLER_NAME}/odom")
    client = wheel_bench.node.create_client("control_msgs/srv/SetOdometry", f"/{CONTROLLER_NAME}/set_odometry")
    request = client.srv_type.Request(x=1.0, y=2.0, yaw=0.0)
    response = client.call_async(request)
    await wheel_bench.step(controller)
    await wheel_bench.graph.settle()
    assert response.result().success
    assert (odometry[-1].pose.pose.position.x, odometry[-1].pose.pose.position.y) == (1.0, 2.0)


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        (
            {"left_wheel_names": [], "right_wheel_names": []},
            "Wheel names parameters are empty!",
        ),
        (
            {"left_wheel_names": ["left", "other"]},
            "The number of left wheels [2] and the number of right wheels [1] are different",
        ),
        ({"wheel_radius": 0.0}, "Parameter 'wheel_radius' with the value 0 must be above 0"),
        ({"wheel_separation": -1.0}, "Parameter 'wheel_separation' with the value -1 must be above 0"),
        ({"pose_covariance_diagonal": [1.0]}, "'pose_covariance_diagonal' must have 6 numbers, but it has 1"),
        (
            {"linear": {"x": {"has_velocity_limits": True}}},
            "Error configuring linear.x speed limiter: Cannot apply velocity limits if max_velocity is not specified",
        ),
        (
            {"angular": {"z": {"max_velocity": 1.0, "min_velocity": 2.0}}},
            "the minimum velocity of 'angular.z' (2) is greater than the maximum (1)",
        ),
    ],
)
def test_invalid_parameters_fail_configuration(wheel_bench, parameters, message):
    with pytest.raises(ControllerError) as error:
        wheel_bench.start(DiffDriveController, CONTROLLER_NAME, **PARAMETERS | parameters)
    assert message in str(error.value)


async def test_wheel_state_that_is_not_a_number_is_reported(wheel_bench):
    controller = wheel_bench.start(DiffDriveController, CONTROLLER_NAME, **PARAMETERS)
    wheel_bench.states["right/position"].value = nan
    await wheel_bench.step(controller)
    publish_command(wheel_bench, 1.0)
    with pytest.raises(LinkwrightError, match="Either the left or right wheel position is invalid for index"):
        await wheel_bench.step(controller)


def test_unknown_parameter_is_reported(wheel_bench):
    wheel_bench.start(DiffDriveController, CONTROLLER_NAME, **PARAMETERS, open_lop=True)
    assert logged_warnings(wheel_bench) == [
        "'open_lop' is not a parameter of this controller; did you mean 'open_loop'?"
    ]
