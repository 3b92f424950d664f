"""Controllers of steered vehicles, compared with the geometry of wheels that roll around one point."""

from __future__ import annotations

from math import atan, cos, isnan, nan, sin, tan
from typing import Any

import pytest

from linkwright.control.controllers.ackermann_steering_controller import AckermannSteeringController
from linkwright.control.controllers.bicycle_steering_controller import BicycleSteeringController
from linkwright.control.controllers.controller import ControllerError
from linkwright.control.controllers.registry import controller_class
from linkwright.control.controllers.tricycle_steering_controller import TricycleSteeringController
from tests.control.controllers.driving import roll, stamped_twist, twist, warnings

NAME = "car"
BASE, TRACK, RADIUS = 1.2, 0.8, 0.1

TWO = {"traction_joints_names": ["right", "left"], "steering_joints_names": ["steer_right", "steer_left"]}
ACKERMANN = TWO | {"wheelbase": BASE, "traction_track_width": TRACK, "traction_wheels_radius": RADIUS}
TRICYCLE = ACKERMANN | {"steering_joints_names": ["steer"]}
BICYCLE = {
    "traction_joints_names": ["wheel"],
    "steering_joints_names": ["steer"],
    "wheelbase": BASE,
    "traction_wheel_radius": RADIUS,
}
ALL = [
    (AckermannSteeringController, ACKERMANN),
    (TricycleSteeringController, TRICYCLE),
    (BicycleSteeringController, BICYCLE),
]
EACH = pytest.mark.parametrize(("kind", "sizes"), ALL, ids=["ackermann", "tricycle", "bicycle"])


def vehicle(bench, kind, sizes, **parameters) -> Any:
    """Return a controller whose joints follow their commands."""
    for joint in sizes["traction_joints_names"]:
        bench.joint(joint, commands=("velocity",), position=0.0, velocity=0.0)
    for joint in sizes["steering_joints_names"]:
        bench.joint(joint, commands=("position",), position=0.0)
    return bench.start(kind, NAME, **sizes | parameters)


def command(bench, *velocity: float, time_ns: int = 0) -> None:
    bench.publish("geometry_msgs/msg/TwistStamped", f"/{NAME}/reference", stamped_twist(time_ns, *velocity))


def joint_commands(bench, *joints: str) -> list[float]:
    return [
        next(interface.value for name, interface in bench.commands.items() if name.startswith(f"{joint}/"))
        for joint in joints
    ]


def test_controllers_are_found_by_type():
    for kind, _ in ALL:
        package = kind.__module__.rpartition(".")[2]
        assert controller_class(f"{package}/{kind.__name__}") is kind


async def test_ackermann_wheels_roll_about_one_point(bench):
    controller = vehicle(bench, AckermannSteeringController, ACKERMANN)
    for _ in range(3):
        command(bench, 1.0, 0.5)
        await roll(bench, controller)
    circle = 1.0 / 0.5
    left, right = joint_commands(bench, "steer_left", "steer_right")
    assert (left, right) == pytest.approx((atan(BASE / (circle - TRACK / 2)), atan(BASE / (circle + TRACK / 2))))
    left, right = joint_commands(bench, "left", "right")
    assert (left, right) == pytest.approx((0.5 * (circle - TRACK / 2) / RADIUS, 0.5 * (circle + TRACK / 2) / RADIUS))


async def test_steering_track_width_can_differ(bench):
    controller = vehicle(bench, AckermannSteeringController, ACKERMANN, steering_track_width=0.4)
    command(bench, 1.0, 0.5)
    await bench.step(controller)
    assert joint_commands(bench, "steer_left") == pytest.approx([atan(BASE / (2.0 - 0.2))])


async def test_tricycle_wheel_commands(bench):
    controller = vehicle(bench, TricycleSteeringController, TRICYCLE, open_loop=True)
    command(bench, 1.0, 0.5)
    await bench.step(controller)
    assert joint_commands(bench, "right", "left", "steer") == pytest.approx([12.0, 8.0, atan(0.6)])


async def test_bicycle_wheel_commands(bench):
    controller = vehicle(bench, BicycleSteeringController, BICYCLE)
    command(bench, 1.0, 0.5)
    await bench.step(controller)
    assert joint_commands(bench, "wheel", "steer") == pytest.approx([10.0, atan(0.6)])


@EACH
@pytest.mark.parametrize(
    "how", [{}, {"position_feedback": True}, {"open_loop": True}], ids=["velocity", "position", "open"]
)
async def test_odometry_matches_driven_arc(bench, kind, sizes, how):
    controller = vehicle(bench, kind, sizes, reference_timeout=60.0, **how)
    odometry = bench.record("nav_msgs/msg/Odometry", f"/{NAME}/odometry")
    transforms = bench.record("tf2_msgs/msg/TFMessage", f"/{NAME}/tf_odometry")
    command(bench, 0.5, 0.2)
    await roll(bench, controller, 20)
    begin = odometry[-1].pose.pose
    await roll(bench, controller, 500)
    end, velocity = odometry[-1].pose.pose, odometry[-1].twist.twist
    yaw = 2.0 * atan(begin.orientation.z / begin.orientation.w)
    assert end.position.x - begin.position.x == pytest.approx(2.5 * (sin(yaw + 1.0) - sin(yaw)), abs=1e-9)
    assert end.position.y - begin.position.y == pytest.approx(2.5 * (cos(yaw) - cos(yaw + 1.0)), abs=1e-9)
    assert (velocity.linear.x, velocity.angular.z) == pytest.approx((0.5, 0.2))
    assert transforms[-1].transforms[0].transform.translation.x == end.position.x
    assert list(odometry[-1].pose.covariance[::7]) == [0.0, 7.0, 14.0, 21.0, 28.0, 35.0]


@EACH
async def test_command_expires_after_timeout(bench, kind, sizes):
    controller = vehicle(bench, kind, sizes, reference_timeout=0.1)
    command(bench, 1.0, 0.5)
    await bench.step(controller, 0.001, count=101)
    angle = joint_commands(bench, sizes["steering_joints_names"][0])
    assert joint_commands(bench, sizes["traction_joints_names"][0])[0] > 0.0
    await bench.step(controller, 0.001)
    assert joint_commands(bench, *sizes["traction_joints_names"]) == [0.0] * len(sizes["traction_joints_names"])
    assert joint_commands(bench, sizes["steering_joints_names"][0]) == angle


async def test_command_holds_for_one_update_without_timeout(bench):
    controller = vehicle(bench, BicycleSteeringController, BICYCLE, reference_timeout=0.0)
    command(bench, 1.0)
    await bench.step(controller)
    assert joint_commands(bench, "wheel") == [10.0]
    await bench.step(controller)
    assert joint_commands(bench, "wheel") == [0.0]


async def test_humble_accepts_unstamped_commands(bench):
    controller = vehicle(bench, BicycleSteeringController, BICYCLE, use_stamped_vel=False)
    bench.publish("geometry_msgs/msg/Twist", f"/{NAME}/reference_unstamped", twist(1.0))
    await bench.step(controller)
    assert joint_commands(bench, "wheel") == [10.0]


async def test_humble_accepts_older_parameter_names(bench):
    older = {
        "front_steering": True,
        "rear_wheels_names": ["right", "left"],
        "front_wheels_names": ["steer_right", "steer_left"],
        "wheelbase": BASE,
        "front_wheel_track": 0.4,
        "rear_wheel_track": TRACK,
        "front_wheels_radius": 0.3,
        "rear_wheels_radius": RADIUS,
    }
    for joint in ("right", "left"):
        bench.joint(joint, commands=("velocity",), velocity=0.0)
        bench.joint(f"steer_{joint}", commands=("position",), position=0.0)
    controller = bench.start(AckermannSteeringController, NAME, **older)
    command(bench, 1.0, 0.5)
    await bench.step(controller)
    assert joint_commands(bench, "left", "steer_left") == pytest.approx([10.0, atan(BASE / 1.8)])
    assert not [warning for warning in warnings(bench) if "not a parameter" in warning]


async def test_wheel_speed_can_be_reduced_until_steering_is_reached(bench):
    controller = vehicle(bench, BicycleSteeringController, BICYCLE, reduce_wheel_speed_until_steering_reached=True)
    command(bench, 1.0, tan(1.0) / BASE)
    await bench.step(controller)
    assert joint_commands(bench, "wheel") == pytest.approx([10.0 * cos(1.0) / cos(0.5235987755982988)])
    bench.states["steer/position"].value = 1.0
    await bench.step(controller)
    assert joint_commands(bench, "wheel") == pytest.approx([10.0])


async def test_chained_mode_accepts_reference_interfaces(bench):
    controller = vehicle(bench, BicycleSteeringController, BICYCLE)
    assert [reference.name for reference in controller.references] == ["car/linear/velocity", "car/angular/velocity"]
    controller.is_chained = True
    controller.references[0].value, controller.references[1].value = 1.0, 0.0
    await bench.step(controller)
    assert joint_commands(bench, "wheel") == [10.0]
    assert all(isnan(reference.value) for reference in controller.references)
    await bench.step(controller)
    assert joint_commands(bench, "wheel") == [0.0]


async def test_controller_state_is_published(bench):
    controller = vehicle(bench, BicycleSteeringController, BICYCLE)
    statuses = bench.record("control_msgs/msg/SteeringControllerStatus", f"/{NAME}/controller_state")
    command(bench, 1.0, 0.5)
    await roll(bench, controller, 2)
    last = statuses[-1]
    assert (list(last.traction_wheels_velocity), list(last.linear_velocity_command)) == ([10.0], [10.0])
    assert list(last.steer_positions) == list(last.steering_angle_command) == [atan(0.6)]


async def test_deactivation_or_nan_command_stops_vehicle(bench):
    controller = vehicle(bench, BicycleSteeringController, BICYCLE)
    command(bench, 1.0)
    await bench.step(controller)
    command(bench, nan)
    await bench.step(controller)
    assert joint_commands(bench, "wheel") == [0.0]
    command(bench, 1.0)
    await bench.step(controller)
    controller.on_deactivate()
    assert joint_commands(bench, "wheel") == [0.0]


@pytest.mark.parametrize(
    ("kind", "sizes", "message"),
    [
        (
            AckermannSteeringController,
            ACKERMANN | {"traction_joints_names": ["right"]},
            "Ackermann configuration requires exactly 2 traction joint(s), but 1 were provided",
        ),
        (BicycleSteeringController, {"wheelbase": 1.0}, "requires exactly 1 traction joint(s), but 0 were provided"),
        (BicycleSteeringController, BICYCLE | {"wheelbase": 0.0}, "'wheelbase' with the value 0 must be above 0"),
    ],
)
def test_invalid_parameters_fail_configuration(bench, kind, sizes, message):
    with pytest.raises(ControllerError) as error:
        bench.start(kind, NAME, **sizes)
    assert message in str(error.value)
