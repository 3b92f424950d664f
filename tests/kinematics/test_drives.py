"""Drives, compared with the geometry of wheels that roll without sliding."""

from __future__ import annotations

from math import atan, hypot, pi, tan

import pytest
from hypothesis import given
from hypothesis import strategies as some

from linkwright.kinematics.drives import CarDrive, DifferentialDrive, MecanumDrive, TricycleDrive

SPEEDS = some.floats(-3.0, 3.0)
ANGLES = some.floats(-1.0, 1.0)


@given(SPEEDS, SPEEDS)
def test_differential_drive_round_trip_keeps_motion(forward, turning):
    drive = DifferentialDrive(0.38, 0.06, 0.061)
    assert drive.motion(*drive.wheel_speeds(forward, turning)) == pytest.approx((forward, turning), abs=1e-12)


def test_differential_drive_wheel_speeds_match_ground_speed():
    left, right = DifferentialDrive(0.4, 0.1, 0.2).wheel_speeds(1.0, 2.0)
    assert (left, right) == pytest.approx(((1.0 - 2.0 * 0.2) / 0.1, (1.0 + 2.0 * 0.2) / 0.2))


@given(SPEEDS, SPEEDS, SPEEDS)
def test_mecanum_drive_round_trip_keeps_motion(forward, sideways, turning):
    drive = MecanumDrive(0.5, 0.1)
    result = drive.wheel_speeds(forward, sideways, turning)
    assert drive.motion(*result) == pytest.approx((forward, sideways, turning), abs=1e-12)


@given(SPEEDS, SPEEDS, SPEEDS)
def test_mecanum_wheel_speeds_match_roller_geometry(forward, sideways, turning):
    """A wheel at (x, y) moves with (forward - turning y, sideways + turning x).

    Its roller absorbs the rest.
    """
    speeds = MecanumDrive(0.3 + 0.2, 0.1).wheel_speeds(forward, sideways, turning)
    for (x, y), speed in zip(((0.3, 0.2), (0.3, -0.2), (-0.3, 0.2), (-0.3, -0.2)), speeds, strict=True):
        speed_along, speed_across = forward - turning * y, sideways + turning * x
        assert speed * 0.1 == pytest.approx(
            speed_along - speed_across if x * y > 0 else speed_along + speed_across, abs=1e-9
        )


CAR = CarDrive(wheelbase=1.2, traction_track=0.8, steering_track=0.7, radius=0.15)


@given(some.floats(0.1, 3.0), some.floats(-1.0, 1.0))
def test_ackermann_drive_round_trip_keeps_motion(forward, turning):
    angle = CAR.steering_angle(forward, turning)
    measured = CAR.middle_angle(*CAR.steering_angles(angle))
    assert measured == pytest.approx(angle, abs=1e-12)
    if abs(CAR.wheelbase / tan(angle) if angle else 9.0) > 0.5:
        left, right = CAR.wheel_speeds(forward, angle)
        assert CAR.motion(left, right, measured) == pytest.approx((forward, turning), abs=1e-9)


@given(ANGLES)
def test_ackermann_wheel_axes_meet_in_one_point(angle):
    left, right = CAR.steering_angles(angle)
    curvature = tan(angle) / CAR.wheelbase
    for wheel, y in ((left, 0.35), (right, -0.35)):
        assert tan(wheel) * (1.0 - y * curvature) == pytest.approx(CAR.wheelbase * curvature, abs=1e-9)


@given(SPEEDS, ANGLES)
def test_ackermann_wheels_roll_on_concentric_circles(forward, angle):
    left, right = CAR.wheel_speeds(forward, angle)
    turning = forward * tan(angle) / CAR.wheelbase
    assert (left * 0.15, right * 0.15) == pytest.approx((forward - turning * 0.4, forward + turning * 0.4), abs=1e-9)


def test_stationary_ackermann_drive_steers_straight():
    assert CAR.steering_angle(0.0, 1.0) == 0.0


@given(SPEEDS, SPEEDS)
def test_tricycle_drive_round_trip_keeps_motion(forward, turning):
    drive = TricycleDrive(1.3, 0.2)
    speed, angle = drive.wheel_command(forward, turning)
    assert drive.motion(speed, angle) == pytest.approx((forward, turning), abs=1e-9)
    assert abs(speed) * 0.2 == pytest.approx(hypot(forward, turning * 1.3), abs=1e-9)


def test_tricycle_turns_in_place_with_wheel_sideways():
    assert TricycleDrive(1.3, 0.2).wheel_command(0.0, -1.0) == pytest.approx((1.3 / 0.2, -pi / 2.0))
    assert TricycleDrive(1.3, 0.2).wheel_command(1.0, 1.0)[1] == pytest.approx(atan(1.3))
