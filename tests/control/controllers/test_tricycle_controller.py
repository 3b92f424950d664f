"""The tricycle controller: steering, traction, odometry and timeouts."""

from __future__ import annotations

from itertools import pairwise
from math import atan, cos, nan, pi, sin

import pytest

from linkwright.control.controllers.controller import ControllerError
from linkwright.control.controllers.registry import controller_class
from linkwright.control.controllers.tricycle_controller import TricycleController
from tests.control.controllers.driving import STEP_S, roll_wheels, stamped_twist, twist

CONTROLLER_NAME = "fork"
PARAMETERS = {"traction_joint_name": "wheel", "steering_joint_name": "steer", "wheelbase": 1.2, "wheel_radius": 0.1}


@pytest.fixture
def wheel_bench(bench):
    """Return a test bench with a driven and steered wheel."""
    bench.joint("wheel", commands=("velocity",), position=0.0, velocity=0.0)
    bench.joint("steer", commands=("position",), position=0.0)
    return bench


def publish_command(bench, *velocity: float) -> None:
    bench.publish("geometry_msgs/msg/TwistStamped", f"/{CONTROLLER_NAME}/cmd_vel", stamped_twist(0, *velocity))


def wheel_command(bench) -> list[float]:
    return [command.value for command in bench.commands.values()]


def test_controller_is_found_by_type():
    assert controller_class("tricycle_controller/TricycleController") is TricycleController


async def test_wheel_speed_matches_command_once_steered(wheel_bench):
    controller = wheel_bench.start(TricycleController, CONTROLLER_NAME, **PARAMETERS)
    publish_command(wheel_bench, 1.0, 0.8)
    await roll_wheels(wheel_bench, controller, 2)
    angle = atan(0.96)
    assert wheel_command(wheel_bench) == pytest.approx([10.0 / cos(angle), angle])


async def test_wheel_is_slow_while_steering_angle_is_off(wheel_bench):
    controller = wheel_bench.start(TricycleController, CONTROLLER_NAME, **PARAMETERS)
    wheel_bench.states["steer/position"].value = -0.2
    publish_command(wheel_bench, 0.0, 1.0)
    await wheel_bench.step(controller)
    assert wheel_command(wheel_bench) == pytest.approx([12.0 * 0.01, pi / 2.0])
    wheel_bench.states["steer/position"].value = pi / 2.0 - 1.0
    await wheel_bench.step(controller)
    assert wheel_command(wheel_bench)[0] == pytest.approx(12.0 * cos(1.0))


@pytest.mark.parametrize("open_loop", [True, False])
async def test_odometry_matches_driven_arc(wheel_bench, open_loop):
    controller = wheel_bench.start(
        TricycleController,
        CONTROLLER_NAME,
        **PARAMETERS,
        open_loop=open_loop,
        cmd_vel_timeout=60000,
        enable_odom_tf=True,
    )
    odometry = wheel_bench.record("nav_msgs/msg/Odometry", f"/{CONTROLLER_NAME}/odom")
    transforms = wheel_bench.record("tf2_msgs/msg/TFMessage", "/tf")
    publish_command(wheel_bench, 0.5, 0.2)
    await roll_wheels(wheel_bench, controller, 20)
    begin = odometry[-1].pose.pose
    yaw = 2.0 * atan(begin.orientation.z / begin.orientation.w)
    await roll_wheels(wheel_bench, controller, 500)
    end = odometry[-1].pose.pose
    assert end.position.x - begin.position.x == pytest.approx(2.5 * (sin(yaw + 1.0) - sin(yaw)), abs=1e-9)
    assert end.position.y - begin.position.y == pytest.approx(2.5 * (cos(yaw) - cos(yaw + 1.0)), abs=1e-9)
    assert transforms[-1].transforms[0].transform.translation.x == end.position.x


async def test_odometry_can_contain_twist_only(wheel_bench):
    controller = wheel_bench.start(TricycleController, CONTROLLER_NAME, **PARAMETERS, odom_only_twist=True)
    odometry = wheel_bench.record("nav_msgs/msg/Odometry", f"/{CONTROLLER_NAME}/odom")
    publish_command(wheel_bench, 0.5)
    await roll_wheels(wheel_bench, controller, 30)
    assert odometry[-1].twist.twist.linear.x == pytest.approx(0.5)
    assert (odometry[-1].pose.pose.position.x, odometry[-1].pose.pose.orientation.w) == (0.0, 1.0)


async def test_reset_odometry_service_resets_pose(wheel_bench):
    controller = wheel_bench.start(TricycleController, CONTROLLER_NAME, **PARAMETERS)
    odometry = wheel_bench.record("nav_msgs/msg/Odometry", f"/{CONTROLLER_NAME}/odom")
    publish_command(wheel_bench, 0.5)
    await roll_wheels(wheel_bench, controller, 30)
    client = wheel_bench.node.create_client("std_srvs/srv/Empty", f"/{CONTROLLER_NAME}/reset_odometry")
    client.call_async(client.srv_type.Request())
    await roll_wheels(wheel_bench, controller)
    assert odometry[-2].pose.pose.position.x > 0.1
    assert odometry[-1].pose.pose.position.x == pytest.approx(0.005)


async def test_command_expires_after_timeout_in_milliseconds(wheel_bench):
    controller = wheel_bench.start(TricycleController, CONTROLLER_NAME, **PARAMETERS, cmd_vel_timeout=100)
    publish_command(wheel_bench, 1.0)
    await wheel_bench.step(controller, 0.001, count=101)
    assert wheel_command(wheel_bench)[0] == pytest.approx(10.0)
    await wheel_bench.step(controller, 0.001)
    assert wheel_command(wheel_bench) == [0.0, 0.0]


async def test_humble_accepts_unstamped_commands(wheel_bench):
    controller = wheel_bench.start(TricycleController, CONTROLLER_NAME, **PARAMETERS, use_stamped_vel=False)
    wheel_bench.publish("geometry_msgs/msg/Twist", f"/{CONTROLLER_NAME}/cmd_vel", twist(1.0))
    await wheel_bench.step(controller)
    assert wheel_command(wheel_bench)[0] == pytest.approx(10.0)


async def test_limits_are_respected_and_ackermann_command_published(wheel_bench):
    limits = {
        "traction": {"max_velocity": 8.0, "max_acceleration": 20.0, "max_deceleration": 40.0},
        "steering": {"max_position": 0.5, "max_velocity": 1.0},
    }
    controller = wheel_bench.start(
        TricycleController, CONTROLLER_NAME, **PARAMETERS, **limits, publish_ackermann_command=True
    )
    commands = wheel_bench.record("ackermann_msgs/msg/AckermannDrive", f"/{CONTROLLER_NAME}/cmd_ackermann")
    speeds, angles = [0.0], [0.0]
    for number in range(300):
        publish_command(wheel_bench, *((1.0, 2.0), (-1.0, 1.0), (0.2, 0.0))[number // 50 % 3])
        await roll_wheels(wheel_bench, controller)
        speed, angle = wheel_command(wheel_bench)
        speeds.append(speed)
        angles.append(angle)
    assert max(map(abs, speeds)) == 8.0
    assert max(map(abs, angles)) == 0.5
    for old, new in pairwise(speeds):
        bound = 20.0 if abs(new) >= abs(old) else 40.0
        assert abs(new - old) / STEP_S <= bound + 1e-9
    assert all(abs(new - old) / STEP_S <= 1.0 + 1e-9 for old, new in pairwise(angles))
    assert (commands[-1].speed, commands[-1].steering_angle) == pytest.approx((speeds[-1], angles[-1]))


async def test_deactivation_stops_wheel(wheel_bench):
    controller = wheel_bench.start(TricycleController, CONTROLLER_NAME, **PARAMETERS)
    publish_command(wheel_bench, 1.0, 0.2)
    await roll_wheels(wheel_bench, controller)
    controller.on_deactivate()
    assert wheel_command(wheel_bench) == [0.0, 0.0]


async def test_wheel_state_that_is_not_a_number_raises_error(wheel_bench):
    controller = wheel_bench.start(TricycleController, CONTROLLER_NAME, **PARAMETERS)
    wheel_bench.states["steer/position"].value = nan
    with pytest.raises(ControllerError, match="Could not read feedback value"):
        await wheel_bench.step(controller)


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({"traction_joint_name": ""}, "Parameter 'traction_joint_name' cannot be empty"),
        ({"wheelbase": 0.0}, "Parameter 'wheelbase' with the value 0 must be above 0"),
        ({"traction": {"max_velocity": -1.0}}, "traction limiter: velocity limits cannot be negative"),
        (
            {"traction": {"max_jerk": 1.0, "min_jerk": 2.0}},
            "traction limiter: Min jerk cannot be greater than max jerk",
        ),
        (
            {"steering": {"max_position": 1.0, "min_position": 2.0}},
            "steering limiter: Min position cannot be greater than max position",
        ),
    ],
)
def test_invalid_parameters_fail_configuration(wheel_bench, parameters, message):
    with pytest.raises(ControllerError) as error:
        wheel_bench.start(TricycleController, CONTROLLER_NAME, **PARAMETERS | parameters)
    assert message in str(error.value)
