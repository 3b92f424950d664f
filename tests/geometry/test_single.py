"""The conversion of roll, pitch and yaw to quaternions and back, as in urdfdom."""

from __future__ import annotations

from math import copysign, cos, pi, sin

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from linkwright.geometry import arrays
from linkwright.geometry.single import (
    axis_and_angle,
    length,
    normalized,
    pose_quaternion,
    quaternion_from_rpy,
    quaternion_inverse,
    quaternion_multiply,
    rotate,
    rotation_from_z,
    rpy_from_quaternion,
    scaled,
)
from linkwright.urdf import Pose

angles = st.floats(-pi, pi)


@given(angles, angles, angles)
def test_rpy_round_trip_keeps_rotation(roll, pitch, yaw):
    quaternion = quaternion_from_rpy((roll, pitch, yaw))
    round_trip = quaternion_from_rpy(rpy_from_quaternion(quaternion))
    cosine = abs(sum(a * b for a, b in zip(quaternion, round_trip, strict=True)))
    # Near a pitch of +-90 degrees, urdfdom sets the roll to zero, which causes an error of up to 0.26 degrees.
    assert cosine > 1 - 1e-5


@pytest.mark.parametrize(
    ("rpy", "expected"),
    [
        ((0, pi / 2, 0.3), (0, pi / 2, 0.3)),
        ((0.2, -pi / 2, 0.3), (0, -pi / 2, 0.5)),
        ((0.2, pi / 2, 0.3), (0, pi / 2, 0.1)),
    ],
)
def test_gimbal_lock_adds_roll_to_yaw(rpy, expected):
    assert rpy_from_quaternion(quaternion_from_rpy(rpy)) == pytest.approx(expected, abs=1e-9)


def test_pitch_of_identity_is_negative_zero_as_in_urdfdom():
    _, pitch, _ = rpy_from_quaternion(quaternion_from_rpy((0, 0, 0)))
    assert copysign(1, pitch) == -1


def test_quaternion_of_pose_overrides_rpy():
    assert pose_quaternion(Pose(quaternion=(1, 0, 0, 0))) == (1, 0, 0, 0)
    assert pose_quaternion(Pose(rpy=(pi, 0, 0))) == pytest.approx((1, 0, 0, 0))


@given(angles, angles, angles)
def test_axis_and_angle_describe_rotation(roll, pitch, yaw):
    quaternion = quaternion_from_rpy((roll, pitch, yaw))
    axis, angle = axis_and_angle(quaternion)
    assume(length(quaternion[:3]) > 1.1e-6)  # below 1e-6, which is half the angle, the axis is x by definition
    assert rotate(quaternion, axis) == pytest.approx(axis, abs=1e-6)
    assert length(axis) == pytest.approx(1)
    half = (*scaled(axis, sin(angle / 2)), cos(angle / 2))
    assert half == pytest.approx(quaternion, abs=1e-6)


@given(*[st.floats(-5e-7, 5e-7)] * 3)
def test_axis_of_tiny_rotation_is_x(roll, pitch, yaw):
    axis, angle = axis_and_angle(quaternion_from_rpy((roll, pitch, yaw)))
    assert axis == (1.0, 0.0, 0.0)
    assert angle == pytest.approx(0.0, abs=2e-6)


@given(angles, angles, angles)
def test_rotation_and_inverse_cancel(roll, pitch, yaw):
    quaternion = quaternion_from_rpy((roll, pitch, yaw))
    assert quaternion_multiply(quaternion, quaternion_inverse(quaternion)) == pytest.approx((0, 0, 0, 1))


@pytest.mark.parametrize("axis", [(0, 0, 1), (0, 0, -2), (1, 0, 0), (0.3, -4, 0.2), (1e-7, 0, -1)])
def test_rotation_from_z_maps_z_to_axis(axis):
    turned = rotate(rotation_from_z(axis), (0, 0, 1))
    assert turned == pytest.approx(scaled(axis, 1 / length(axis)), abs=1e-6)


def test_zero_quaternion_normalizes_to_identity():
    assert normalized(0, 0, 0, 0) == (0, 0, 0, 1)
    assert normalized(0, 1e-9, 0, 0, min_squared_norm=1e-16) == (0, 0, 0, 1)
    assert normalized(0, 3, 0, 4) == (0, 0.6, 0, 0.8)


@given(angles, angles, st.floats(0, 1))
def test_slerp_interpolates_along_shorter_arc(first, last, ratio):
    begin, end = quaternion_from_rpy((0, 0, first)), quaternion_from_rpy((0, 0, last))
    (interpolated,) = arrays.slerp(begin, end, [ratio])
    difference = (last - first + pi) % (2 * pi) - pi
    if abs(abs(difference) - pi) > 1e-3:  # the arcs of half a turn have equal lengths
        expected = quaternion_from_rpy((0, 0, first + ratio * difference))
        assert abs(interpolated @ expected) == pytest.approx(1, abs=1e-6)
