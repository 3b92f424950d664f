"""Controllers of steered vehicles, compared with the geometry of rolling wheels.

All wheels of a vehicle roll around one point.
"""

from __future__ import annotations

from math import atan, cos, isnan, nan, sin, tan
from typing import Any

import pytest

from linkwright.control.controllers.ackermann_steering_controller import AckermannSteeringController
from linkwright.control.controllers.bicycle_steering_controller import BicycleSteeringController
from linkwright.control.controllers.controller import ControllerError
from linkwright.control.controllers.registry import controller_class
from linkwright.control.controllers.tricycle_steering_controller import TricycleSteeringController
from tests.control.controllers.driving import logged_warnings, roll_wheels, stamped_twist, twist

CONTROLLER_NAME = "car"
WHEELBASE, TRACK_WIDTH, WHEEL_RADIUS = 1.2, 0.8, 0.1

TWO_WHEEL_JOINTS = {"traction_joints_names": ["right", "left"], "steering_joints_names": ["steer_right", "steer_left"]}
ACKERMANN_PARAMETERS = TWO_WHEEL_JOINTS | {
    "wheelbase": WHEELBASE,
    "traction_track_width": TRACK_WIDTH,
    "traction_wheels_radius": WHEEL_RADIUS,
}
TRICYCLE_PARAMETERS = ACKERMANN_PARAMETERS | {"steering_joints_names": ["steer"]}
BICYCLE_PARAMETERS = {
    "traction_joints_names": ["wheel"],
    "steering_joints_names": ["steer"],
    "wheelbase": WHEELBASE,
    "traction_wheel_radius": WHEEL_RADIUS,
}
CONTROLLERS = [
    (AckermannSteeringController, ACKERMANN_PARAMETERS),
    (TricycleSteeringController, TRICYCLE_PARAMETERS),
    (BicycleSteeringController, BICYCLE_PARAMETERS),
]
each_controller = pytest.mark.parametrize(("kind", "sizes"), CONTROLLERS, ids=["ackermann", "tricycle", "bicycle"])


def start_vehicle(bench, kind, sizes, **parameters) -> Any:
    """Return a controller whose joints follow their commands."""
    for joint in sizes["traction_joints_names"]:
        bench.joint(joint, commands=("velocity",), position=0.0, velocity=0.0)
    for joint in sizes["steering_joints_names"]:
        bench.joint(joint, commands=("position",), position=0.0)
    return bench.start(kind, CONTROLLER_NAME, **sizes | parameters)


def publish_command(bench, *velocity: float, time_ns: int = 0) -> None:
    bench.publish("geometry_msgs/msg/TwistStamped", f"/{CONTROLLER_NAME}/reference", stamped_twist(time_ns, *velocity))


def joint_commands(bench, *joints: str) -> list[float]:
    return [
        next(interface.value for name, interface in bench.commands.items() if name.startswith(f"{joint}/"))
        for joint in joints
    ]


def test_controllers_are_found_by_type():
    for kind, _ in CONTROLLERS:
        package = kind.__module__.rpartition(".")[2]
        assert controller_class(f"{package}/{kind.__name__}") is kind


async def test_ackermann_wheels_roll_about_one_point(bench):
    controller = start_vehicle(bench, AckermannSteeringController, ACKERMANN_PARAMETERS)
    for _ in range(3):
        publish_command(bench, 1.0, 0.5)
        await roll_wheels(bench, controller)
    circle = 1.0 / 0.5
    left, right = joint_commands(bench, "steer_left", "steer_right")
    assert (left, right) == pytest.approx(
        (atan(WHEELBASE / (circle - TRACK_WIDTH / 2)), atan(WHEELBASE / (circle + TRACK_WIDTH / 2)))
    )
    left, right = joint_commands(bench, "left", "right")
    assert (left, right) == pytest.approx(
        (0.5 * (circle - TRACK_WIDTH / 2) / WHEEL_RADIUS, 0.5 * (circle + TRACK_WIDTH / 2) / WHEEL_RADIUS)
    )


async def test_steering_track_width_can_differ(bench):
    controller = start_vehicle(bench, AckermannSteeringController, ACKERMANN_PARAMETERS, steering_track_width=0.4)
    publish_command(bench, 1.0, 0.5)
    await bench.step(controller)
    assert joint_commands(bench, "steer_left") == pytest.approx([atan(WHEELBASE / (2.0 - 0.2))])


async def test_tricycle_wheel_commands(bench):
    controller = start_vehicle(bench, TricycleSteeringController, TRICYCLE_PARAMETERS, open_loop=True)
    publish_command(bench, 1.0, 0.5)
    await bench.step(controller)
    assert joint_commands(bench, "right", "left", "steer") == pytest.approx([12.0, 8.0, atan(0.6)])


async def test_bicycle_wheel_commands(bench):
    controller = start_vehicle(bench, BicycleSteeringController, BICYCLE_PARAMETERS)
    publish_command(bench, 1.0, 0.5)
    await bench.step(controller)
    assert joint_commands(bench, "wheel", "steer") == pytest.approx([10.0, atan(0.6)])


@each_controller
@pytest.mark.parametrize(
    "feedback", [{}, {"position_feedback": True}, {"open_loop": True}], ids=["velocity", "position", "open"]
)
async def test_odometry_matches_driven_arc(bench, kind, sizes, feedback):
    controller = start_vehicle(bench, kind, sizes, reference_timeout=60.0, **feedback)
    odometry = bench.record("nav_msgs/msg/Odometry", f"/{CONTROLLER_NAME}/odometry")
    transforms = bench.record("tf2_msgs/msg/TFMessage", f"/{CONTROLLER_NAME}/tf_odometry")
    publish_command(bench, 0.5, 0.2)
    await roll_wheels(bench, controller, 20)
    begin = odometry[-1].pose.pose
    await roll_wheels(bench, controller, 500)
    end, velocity = odometry[-1].pose.pose, odometry[-1].twist.twist
    yaw = 2.0 * atan(begin.orientation.z / begin.orientation.w)
    assert end.position.x - begin.position.x == pytest.approx(2.5 * (sin(yaw + 1.0) - sin(yaw)), abs=1e-9)
    assert end.position.y - begin.position.y == pytest.approx(2.5 * (cos(yaw) - cos(yaw + 1.0)), abs=1e-9)
    assert (velocity.linear.x, velocity.angular.z) == pytest.approx((0.5, 0.2))
    assert transforms[-1].transforms[0].transform.translation.x == end.position.x
    assert list(odometry[-1].pose.covariance[::7]) == [0.0, 7.0, 14.0, 21.0, 28.0, 35.0]


@each_controller
async def test_command_expires_after_timeout(bench, kind, sizes):
    controller = start_vehicle(bench, kind, sizes, reference_timeout=0.1)
    publish_command(bench, 1.0, 0.5)
    await bench.step(controller, 0.001, count=101)
    angle = joint_commands(bench, sizes["steering_joints_names"][0])
    assert joint_commands(bench, sizes["traction_joints_names"][0])[0] > 0.0
    await bench.step(controller, 0.001)
    assert joint_commands(bench, *sizes["traction_joints_names"]) == [0.0] * len(sizes["traction_joints_names"])
    assert joint_commands(bench, sizes["steering_joints_names"][0]) == angle


async def test_command_holds_for_one_update_without_timeout(bench):
    controller = start_vehicle(bench, BicycleSteeringController, BICYCLE_PARAMETERS, reference_timeout=0.0)
    publish_command(bench, 1.0)
    await bench.step(controller)
    assert joint_commands(bench, "wheel") == [10.0]
    await bench.step(controller)
    assert joint_commands(bench, "wheel") == [0.0]


async def test_humble_accepts_unstamped_commands(bench):
    controller = start_vehicle(bench, BicycleSteeringController, BICYCLE_PARAMETERS, use_stamped_vel=False)
    bench.publish("geometry_msgs/msg/Twist", f"/{CONTROLLER_NAME}/reference_unstamped", twist(1.0))
    await bench.step(controller)
    assert joint_commands(bench, "wheel") == [10.0]


async def test_humble_accepts_older_parameter_names(bench):
    older = {
        "front_steering": True,
        "rear_wheels_names": ["right", "left"],
        "front_wheels_names": ["steer_right", "steer_left"],
        "wheelbase": WHEELBASE,
        "front_wheel_track": 0.4,
        "rear_wheel_track": TRACK_WIDTH,
        "front_wheels_radius": 0.3,
        "rear_wheels_radius": WHEEL_RADIUS,
    }
    for joint in ("right", "left"):
        bench.joint(joint, commands=("velocity",), velocity=0.0)
        bench.joint(f"steer_{joint}", commands=("position",), position=0.0)
    controller = bench.start(AckermannSteeringController, CONTROLLER_NAME, **older)
    publish_command(bench, 1.0, 0.5)
    await bench.step(controller)
    assert joint_commands(bench, "left", "steer_left") == pytest.approx([10.0, atan(WHEELBASE / 1.8)])
    assert not [warning for warning in logged_warnings(bench) if "not a parameter" in warning]


async def test_wheel_speed_can_be_reduced_until_steering_is_reached(bench):
    controller = start_vehicle(
        bench, BicycleSteeringController, BICYCLE_PARAMETERS, reduce_wheel_speed_until_steering_reached=True
    )
    publish_command(bench, 1.0, tan(1.0) / WHEELBASE)
    await bench.step(controller)
    assert joint_commands(bench, "wheel") == pytest.approx([10.0 * cos(1.0) / cos(0.5235987755982988)])
    bench.states["steer/position"].value = 1.0
    await bench.step(controller)
    assert joint_commands(bench, "wheel") == pytest.approx([10.0])


async def test_chained_mode_accepts_reference_interfaces(bench):
    controller = start_vehicle(bench, BicycleSteeringController, BICYCLE_PARAMETERS)
    assert [reference.name for reference in controller.references] == ["car/linear/velocity", "car/angular/velocity"]
    controller.is_chained = True
    controller.references[0].value, controller.references[1].value = 1.0, 0.0
    await bench.step(controller)
    assert joint_commands(bench, "wheel") == [10.0]
    assert all(isnan(reference.value) for reference in controller.references)
    await bench.step(controller)
    assert joint_commands(bench, "wheel") == [0.0]


async def test_controller_state_is_published(bench):
    controller = start_vehicle(bench, BicycleSteeringController, BICYCLE_PARAMETERS)
    statuses = bench.record("control_msgs/msg/SteeringControllerStatus", f"/{CONTROLLER_NAME}/controller_state")
    publish_command(bench, 1.0, 0.5)
    await roll_wheels(bench, controller, 2)
    last = statuses[-1]
    assert (list(last.traction_wheels_velocity), list(last.linear_velocity_command)) == ([10.0], [10.0])
    assert list(last.steer_positions) == list(last.steering_angle_command) == [atan(0.6)]


async def test_deactivation_or_nan_command_stops_vehicle(bench):
    controller = start_vehicle(bench, BicycleSteeringController, BICYCLE_PARAMETERS)
    publish_command(bench, 1.0)
    await bench.step(controller)
    publish_command(bench, nan)
    await bench.step(controller)
    assert joint_commands(bench, "wheel") == [0.0]
    publish_command(bench, 1.0)
    await bench.step(controller)
    controller.on_deactivate()
    assert joint_commands(bench, "wheel") == [0.0]


@pytest.mark.parametrize(
    ("kind", "sizes", "message"),
    [
        (
            AckermannSteeringController,
            ACKERMANN_PARAMETERS | {"traction_joints_names": ["right"]},
            "Ackermann configuration requires exactly 2 traction joint(s), but 1 were provided",
        ),
        (BicycleSteeringController, {"wheelbase": 1.0}, "requires exactly 1 traction joint(s), but 0 were provided"),
        (
            BicycleSteeringController,
            BICYCLE_PARAMETERS | {"wheelbase": 0.0},
            "'wheelbase' with the value 0 must be above 0",
        ),
    ],
)
def test_invalid_parameters_fail_configuration(bench, kind, sizes, message):
    with pytest.raises(ControllerError) as error:
        bench.start(kind, CONTROLLER_NAME, **sizes)
    assert message in str(error.value)
