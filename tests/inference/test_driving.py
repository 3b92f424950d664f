"""Driving a robot without physics: the inferred physics, without plugins and nodes."""

from __future__ import annotations

from math import atan2, pi

import pytest

from linkwright.geometry.single import Transform
from linkwright.inference import Drive
from linkwright.inference.completion import complete_description
from linkwright.sdf.from_urdf import model_from_robot
from linkwright.simulation.actuators import Motor
from linkwright.simulation.simulation import Simulation
from linkwright.urdf import read
from tests.inference.test_robots import CASES, read_and_inferred
from tests.simulation.worlds import GROUND, make_simulation

pytestmark = pytest.mark.extra("sim")

SECOND_NS = 1_000_000_000
ROBOTS = {case[0]: case[1] for case in CASES}
MOTOR = (20.0, 1.5)
"""The gain in N m s/rad, and the maximum torque in N m."""


def standing(title: str) -> tuple[Simulation, Drive]:
    """Return a robot on the ground, and its drive."""
    document, inference = read_and_inferred(ROBOTS[title])
    robot = read(complete_description(document, inference)).robot
    assert robot is not None
    assert inference.drive is not None
    simulation = make_simulation(GROUND)
    model = model_from_robot(robot, lump_fixed_joints=True).model
    simulation.spawn(model, "r", (0.0, 0.0, -inference.ground_z, 0.0, 0.0, 0.0, 1.0))
    return simulation, inference.drive


def motors(simulation: Simulation, drive: Drive) -> tuple[list[Motor], list[Motor]]:
    """Return motors on the left and on the right."""
    left, right = (
        [simulation.add_velocity_motor(f"r::{wheel.joint}", *MOTOR) for wheel in side]
        for side in (drive.left, drive.right)
    )
    return left, right


def drive_straight(simulation: Simulation, sides: tuple[list[Motor], list[Motor]], left: float, right: float) -> None:
    """Accelerate the wheels to velocities in rad/s within a second.

    This is slow enough to avoid slip.
    """
    for hundredth in range(1, 101):
        for motor in sides[0]:
            motor.target = left * hundredth / 100
        for motor in sides[1]:
            motor.target = right * hundredth / 100
        simulation.advance(SECOND_NS // 100)


def yaw(pose: Transform) -> float:
    """Return the rotation about z in rad of an upright pose."""
    _, _, _, x, y, z, w = pose
    return atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


TWO_WHEELS = "Visuals only, two wheels and two balls"


def test_robot_with_visuals_only_drives_one_meter_straight():
    simulation, drive = standing(TWO_WHEELS)
    sides = motors(simulation, drive)
    drive_straight(simulation, sides, 0.5 / drive.radius, 0.5 / drive.radius)
    start = simulation.model_pose("r")
    simulation.advance(2 * SECOND_NS)
    end = simulation.model_pose("r")
    assert end[0] - start[0] == pytest.approx(1.0, abs=1e-3)
    assert end[1] == pytest.approx(0.0, abs=1e-3)
    assert end[2] == pytest.approx(0.11, abs=1e-3)


def test_turn_in_place_follows_wheel_separation():
    simulation, drive = standing(TWO_WHEELS)
    sides = motors(simulation, drive)
    rate = 1.0 * drive.separation / 2 / drive.radius
    drive_straight(simulation, sides, -rate, rate)
    start = yaw(simulation.model_pose("r"))
    simulation.advance(SECOND_NS)
    assert (yaw(simulation.model_pose("r")) - start) % (2 * pi) == pytest.approx(1.0, abs=0.01)


@pytest.mark.parametrize("title", ["Four wheels", "Axes that point to the right, on one side and as a default"])
def test_equal_wheel_velocities_drive_forward(title):
    simulation, drive = standing(title)
    sides = motors(simulation, drive)
    drive_straight(simulation, sides, 0.3 / drive.radius, 0.3 / drive.radius)
    x, y = simulation.model_pose("r")[:2]
    assert x > 0.1
    assert y == pytest.approx(0.0, abs=1e-3)


def test_robot_stands_still_on_inferred_wheels():
    simulation, _ = standing(TWO_WHEELS)
    simulation.advance(2 * SECOND_NS)
    x, y, z = simulation.model_pose("r")[:3]
    assert (x, y) == pytest.approx((0.0, 0.0), abs=1e-4)
    assert z == pytest.approx(0.11, abs=1e-3)
