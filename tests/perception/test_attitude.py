"""Attitude from accelerometers, gyroscopes and magnetometers."""

from __future__ import annotations

from math import atan2, cos, pi, sin

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from linkwright.geometry.single import (
    quaternion_from_rpy,
    quaternion_inverse,
    quaternion_multiply,
    rotate,
    rpy_from_quaternion,
)
from linkwright.perception.attitude import (
    GRAVITY,
    ComplementaryFilter,
    MadgwickFilter,
    WorldFrame,
    compute_attitude_at_rest,
)

angles = st.floats(-1.4, 1.4)
MAGNETIC_DIP_RAD = 1.0
"""The angle of the magnetic field below the horizon, in rad."""


def acceleration_at_rest(orientation, world=WorldFrame.ENU):
    """Return the reading of an accelerometer at rest."""
    return rotate(quaternion_inverse(orientation), (0.0, 0.0, GRAVITY * world.up))


def magnetic_field_reading(orientation, world=WorldFrame.ENU):
    """Return the reading of a magnetometer."""
    level, vertical = cos(MAGNETIC_DIP_RAD), -sin(MAGNETIC_DIP_RAD) * world.up
    return rotate(
        quaternion_inverse(orientation), (0.0, level, vertical) if world is WorldFrame.ENU else (level, 0.0, vertical)
    )


def angle_between(first, second):
    """The angle between two orientations."""
    x, y, z, w = quaternion_multiply(quaternion_inverse(first), second)
    return 2.0 * atan2((x * x + y * y + z * z) ** 0.5, abs(w))


@settings(max_examples=50)
@given(angles, angles, angles, st.sampled_from(WorldFrame))
def test_attitude_at_rest_matches_orientation(roll, pitch, yaw, world):
    orientation = quaternion_from_rpy((roll, pitch, yaw))
    assert (
        angle_between(
            compute_attitude_at_rest(
                acceleration_at_rest(orientation, world), magnetic_field_reading(orientation, world), world
            ),
            orientation,
        )
        < 1e-6
    )
    rpy_without_field = rpy_from_quaternion(
        compute_attitude_at_rest(acceleration_at_rest(orientation, world), None, world)
    )
    assert rpy_without_field == pytest.approx((roll, pitch, 0.0), abs=1e-9)


def test_attitude_at_rest_without_direction_is_none():
    assert compute_attitude_at_rest((0.0, 0.0, 0.0), None, WorldFrame.ENU) is None
    assert compute_attitude_at_rest((0.0, 0.0, 9.8), (0.0, 0.0, 1.0), WorldFrame.ENU) is None
    assert compute_attitude_at_rest((0.0, 0.0, 9.8), (0.0, 0.0, 0.0), WorldFrame.ENU) is None


@pytest.mark.parametrize("world", WorldFrame)
def test_madgwick_converges_from_large_error(world):
    orientation = quaternion_from_rpy((0.4, -0.3, 1.0))
    attitude_filter = MadgwickFilter(gain=0.5, world=world)
    for _ in range(1000):
        attitude_filter.update(
            (0.0, 0.0, 0.0), acceleration_at_rest(orientation, world), magnetic_field_reading(orientation, world), 0.01
        )
    assert angle_between(attitude_filter.orientation, orientation) < 0.01


def test_madgwick_without_magnetometer_finds_roll_and_pitch():
    orientation = quaternion_from_rpy((0.4, -0.3, 0.0))
    attitude_filter = MadgwickFilter(gain=0.5)
    for _ in range(500):
        attitude_filter.update((0.0, 0.0, 0.0), acceleration_at_rest(orientation), None, 0.01)
    assert rpy_from_quaternion(attitude_filter.orientation)[:2] == pytest.approx((0.4, -0.3), abs=0.01)


FILTERS = pytest.mark.parametrize("kind", [MadgwickFilter, ComplementaryFilter])


@FILTERS
def test_gyroscope_rotates_attitude(kind):
    attitude_filter = kind()
    for _ in range(1000):
        attitude_filter.update((0.0, 0.0, 0.5), (0.0, 0.0, GRAVITY), None, 0.002)
    assert rpy_from_quaternion(attitude_filter.orientation) == pytest.approx((0.0, 0.0, 1.0), abs=1e-3)


def test_madgwick_estimates_gyroscope_drift():
    attitude_filter = MadgwickFilter(gain=0.2, zeta=0.1)
    for _ in range(6000):
        attitude_filter.update((0.1, 0.0, 0.0), (0.0, 0.0, GRAVITY), None, 0.01)
    assert attitude_filter.drift[0] == pytest.approx(0.1, abs=0.02)
    assert abs(rpy_from_quaternion(attitude_filter.orientation)[0]) < 0.05


def test_complementary_filter_finds_attitude_and_north():
    orientation = quaternion_from_rpy((0.3, -0.2, 0.8))
    attitude_filter = ComplementaryFilter(gain_acc=0.05, gain_mag=0.05)
    for _ in range(500):
        attitude_filter.update(
            (0.0, 0.0, 0.0),
            acceleration_at_rest(orientation, WorldFrame.NWU),
            magnetic_field_reading(orientation, WorldFrame.NWU),
            0.01,
        )
    assert angle_between(attitude_filter.orientation, orientation) < 0.01


def test_complementary_filter_estimates_bias_at_rest():
    attitude_filter = ComplementaryFilter()
    for _ in range(1500):
        attitude_filter.update((0.0, 0.0, 0.05), (0.0, 0.0, GRAVITY), None, 0.01)
    assert attitude_filter.bias[2] == pytest.approx(0.05, abs=1e-3)
    without_estimation = ComplementaryFilter(do_bias_estimation=False)
    without_estimation.update((0.0, 0.0, 0.05), (0.0, 0.0, GRAVITY), None, 0.01)
    assert without_estimation.bias == (0.0, 0.0, 0.0)


def test_adaptive_gain_ignores_linear_acceleration():
    fixed_gain, adaptive_gain = (
        ComplementaryFilter(gain_acc=0.05),
        ComplementaryFilter(gain_acc=0.05, do_adaptive_gain=False),
    )
    for _ in range(100):
        for attitude_filter in (fixed_gain, adaptive_gain):
            attitude_filter.update((0.0, 0.0, 0.0), (8.0, 0.0, GRAVITY), None, 0.01)
    assert abs(rpy_from_quaternion(fixed_gain.orientation)[1]) < 1e-9
    assert abs(rpy_from_quaternion(adaptive_gain.orientation)[1]) > 0.5


def test_madgwick_converges_from_half_turn():
    attitude_filter = MadgwickFilter(gain=1.0, orientation=quaternion_from_rpy((pi - 0.1, 0.0, 0.0)))
    for _ in range(2000):
        attitude_filter.update((0.0, 0.0, 0.0), (0.0, 0.0, GRAVITY), None, 0.005)
    assert abs(rpy_from_quaternion(attitude_filter.orientation)[0]) < 0.02
