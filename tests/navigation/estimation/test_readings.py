"""Measurements from sensor messages: frames, axes and relative poses."""

from __future__ import annotations

from math import inf, nan, pi

import numpy as np
import pytest

from linkwright.geometry.single import IDENTITY, compose, quaternion_from_rpy, quaternion_multiply
from linkwright.navigation.estimation.motion_model import ANGLES, POSITION, RATES, STATE_SIZE, TWIST, VELOCITY, State
from linkwright.navigation.estimation.readings import (
    GRAVITY,
    PoseReader,
    read_acceleration,
    read_twist,
    subtract_gravity,
)

SECOND_NS = 1_000_000_000
ALL_MEASURED = (True,) * STATE_SIZE
COVARIANCE = np.diag([1.0, 2.0, 3.0, 4.0, 5.0, 6.0])


def make_pose(x=0.0, y=0.0, z=0.0, rpy=(0.0, 0.0, 0.0)):
    return (x, y, z, *quaternion_from_rpy(rpy))


def select_axes(*names):
    return tuple(State(index).name in names for index in range(STATE_SIZE))


def measured_names(measured):
    return {State(index).name for index, is_used in enumerate(measured) if is_used}


def test_pose_and_covariance_are_transformed_to_world():
    reader = PoseReader(select_axes("X", "YAW"))
    reading = reader.read(make_pose(1.0, 2.0, rpy=(0, 0, 0.3)), COVARIANCE, make_pose(10.0, rpy=(0, 0, pi / 2)), 0)
    assert reading.values[POSITION] == pytest.approx([8.0, 1.0, 0.0])
    assert reading.values[State.YAW] == pytest.approx(0.3 + pi / 2)
    assert measured_names(reading.used) == {"Y", "YAW"}
    assert np.diag(reading.covariance)[:6] == pytest.approx([2.0, 1.0, 3.0, 5.0, 4.0, 6.0])


def test_relative_poses_start_at_first_pose():
    reader = PoseReader(ALL_MEASURED, relative=True)
    first = reader.read(make_pose(5.0, 1.0, rpy=(0, 0, pi / 2)), COVARIANCE, IDENTITY, 0)
    assert first.values == pytest.approx(np.zeros(STATE_SIZE))
    second = reader.read(make_pose(5.0, 3.0, rpy=(0, 0, pi / 2)), COVARIANCE, IDENTITY, SECOND_NS)
    assert second.values[POSITION] == pytest.approx([2.0, 0.0, 0.0])
    reader.reset()
    assert reader.read(make_pose(9.0), COVARIANCE, IDENTITY, 0).values == pytest.approx(np.zeros(STATE_SIZE))


def test_differential_poses_give_velocities():
    reader = PoseReader(select_axes("X", "Y", "YAW"), differential=True)
    assert reader.read(make_pose(1.0, rpy=(0, 0, pi / 2)), COVARIANCE, IDENTITY, 0) is None
    reading = reader.read(make_pose(1.0, 1.0, rpy=(0, 0, pi / 2 + 0.1)), COVARIANCE, IDENTITY, SECOND_NS // 2)
    assert reading.values[VELOCITY] == pytest.approx([2.0, 0.0, 0.0])
    assert reading.values[State.VYAW] == pytest.approx(0.2)
    assert measured_names(reading.used) == {"VX", "VY", "VYAW"}
    assert np.diag(reading.covariance)[TWIST] == pytest.approx(np.diag(COVARIANCE) * 2.0 * 0.5)
    assert reader.read(make_pose(), COVARIANCE, IDENTITY, SECOND_NS // 2) is None


def test_two_d_mode_fixes_remaining_states_to_zero():
    reading = PoseReader(select_axes("X"), two_d=True).read(
        make_pose(1.0, 2.0, 3.0, (0.1, 0.2, 0.3)), COVARIANCE, IDENTITY, 0
    )
    assert measured_names(reading.used) == {"X", "Z", "ROLL", "PITCH", "VZ", "VROLL", "VPITCH", "AZ"}
    assert reading.values[State.Z] == reading.values[State.ROLL] == 0.0
    assert reading.covariance[State.AZ, State.AZ] == 1e-6


@pytest.mark.parametrize("mounting", [(pi, 0, 0), (0, 0, pi / 2), (0.2, -0.7, 2.0)])
def test_orientation_of_rotated_imu_gives_body_attitude(mounting):
    body, mounted = quaternion_from_rpy((0.1, 0.2, 0.3)), quaternion_from_rpy(mounting)
    imu = quaternion_multiply(body, mounted)
    reading = PoseReader(select_axes("ROLL", "PITCH", "YAW")).read_orientation(
        imu, COVARIANCE, (0.5, 0, 0, *mounted), 0
    )
    assert reading.values[ANGLES] == pytest.approx([0.1, 0.2, 0.3])
    assert reading.values[POSITION] == pytest.approx([0.0, 0.0, 0.0])


def test_roll_of_rotated_imu_is_pitch_of_body():
    mounting = make_pose(rpy=(0, 0, pi / 2))
    reading = PoseReader(select_axes("ROLL")).read_orientation(mounting[3:], COVARIANCE, mounting, 0)
    assert measured_names(reading.used) == {"PITCH"}
    assert reading.covariance[State.PITCH, State.PITCH] == pytest.approx(4.0)


def test_twist_is_corrected_for_lever_arm_of_sensor():
    mounting, rates = make_pose(1.0, rpy=(0, 0, pi / 2)), np.array([0.0, 0.0, 2.0])
    # The rotation moves the sensor to the left at 2 m/s, which is the sensor's x direction.
    reading = read_twist(np.array([2.0, 0.0, 0.0]), rates, COVARIANCE, mounting, rates, ALL_MEASURED, two_d=False)
    assert reading.values[VELOCITY] == pytest.approx([0.0, 0.0, 0.0])
    assert reading.values[RATES] == pytest.approx([0.0, 0.0, 2.0])
    assert np.diag(reading.covariance)[TWIST] == pytest.approx([2.0, 1.0, 3.0, 5.0, 4.0, 6.0])
    assert measured_names(reading.used) == {"VX", "VY", "VZ", "VROLL", "VPITCH", "VYAW"}


def test_gravity_is_subtracted_from_resting_accelerometer():
    orientation = quaternion_from_rpy((0.3, -0.4, 1.0))
    upwards = compose((0.0, 0.0, 0.0, *_inverse(orientation)), (0.0, 0.0, GRAVITY, 0.0, 0.0, 0.0, 1.0))[:3]
    assert subtract_gravity(np.array(upwards), orientation) == pytest.approx([0.0, 0.0, 0.0], abs=1e-12)


def test_acceleration_is_rotated_into_body_frame():
    mounting = make_pose(rpy=(0, 0, pi / 2))
    reading = read_acceleration(np.array([1.0, 0.0, 0.0]), np.eye(3), mounting, select_axes("AX"), two_d=False)
    assert reading.values[12:] == pytest.approx([0.0, 1.0, 0.0])
    assert measured_names(reading.used) == {"AY"}


def test_nonfinite_values_are_ignored_and_others_are_used():
    reading = PoseReader(select_axes("X", "Y", "YAW")).read(
        (1.0, nan, nan, nan, 0.0, 0.0, 1.0), COVARIANCE, IDENTITY, 0
    )
    assert measured_names(reading.used) == {"X"}
    assert reading.values[State.X] == 1.0
    assert np.isfinite(reading.values).all()
    twist = read_twist(
        np.array([1.0, nan, 0.0]),
        np.array([inf, 0.0, 2.0]),
        COVARIANCE,
        IDENTITY,
        np.zeros(3),
        ALL_MEASURED,
        two_d=False,
    )
    assert measured_names(twist.used) == {"VX", "VZ", "VPITCH", "VYAW"}
    acceleration = read_acceleration(np.array([nan, 2.0, 3.0]), np.eye(3), IDENTITY, ALL_MEASURED, two_d=False)
    assert measured_names(acceleration.used) == {"AY", "AZ"}
    rotated_acceleration = read_acceleration(
        np.array([nan, 2.0, 3.0]), np.eye(3), make_pose(rpy=(0, 0, 0.7)), ALL_MEASURED, two_d=False
    )
    assert measured_names(rotated_acceleration.used) == {"AZ"}


def test_relative_poses_start_at_first_finite_pose():
    reader = PoseReader(select_axes("X"), relative=True)
    assert reader.read((nan, nan, nan, nan, nan, nan, nan), COVARIANCE, IDENTITY, 0) is None
    assert reader.read(make_pose(5.0), COVARIANCE, IDENTITY, 1).values[State.X] == 0.0
    assert reader.read(make_pose(7.0), COVARIANCE, IDENTITY, 2).values[State.X] == 2.0


def _inverse(quaternion):
    x, y, z, w = quaternion
    return -x, -y, -z, w
