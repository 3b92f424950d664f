"""Roll, pitch and yaw to quaternions and back, as urdfdom computes them."""

from __future__ import annotations

from math import copysign, pi

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.urdf import Pose
from linkwright.urdf.rotation import quaternion_from_rpy, quaternion_of, rpy_from_quaternion

angles = st.floats(-pi, pi)


@given(angles, angles, angles)
def test_back_and_forth_is_the_same_rotation(roll, pitch, yaw):
    quaternion = quaternion_from_rpy((roll, pitch, yaw))
    again = quaternion_from_rpy(rpy_from_quaternion(quaternion))
    cosine = abs(sum(a * b for a, b in zip(quaternion, again, strict=True)))
    # Near pitch = +-90 degrees urdfdom sets the roll to zero, which is off by up to 0.26 degrees.
    assert cosine > 1 - 1e-5


@pytest.mark.parametrize(
    ("rpy", "expected"),
    [
        ((0, pi / 2, 0.3), (0, pi / 2, 0.3)),
        ((0.2, -pi / 2, 0.3), (0, -pi / 2, 0.5)),
        ((0.2, pi / 2, 0.3), (0, pi / 2, 0.1)),
    ],
)
def test_gimbal_lock_takes_the_roll_into_the_yaw(rpy, expected):
    assert rpy_from_quaternion(quaternion_from_rpy(rpy)) == pytest.approx(expected, abs=1e-9)


def test_the_pitch_of_no_rotation_has_the_sign_urdfdom_prints():
    _, pitch, _ = rpy_from_quaternion(quaternion_from_rpy((0, 0, 0)))
    assert copysign(1, pitch) == -1


def test_a_poses_own_quaternion_counts():
    assert quaternion_of(Pose(quaternion=(1, 0, 0, 0))) == (1, 0, 0, 0)
    assert quaternion_of(Pose(rpy=(pi, 0, 0))) == pytest.approx((1, 0, 0, 0))
