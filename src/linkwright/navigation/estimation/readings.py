"""Convert sensor poses, twists and accelerations to measurements of the robot's body.

Source of the rules: robot_localization. Two computations that are approximate there are exact here: the orientation of
a rotated IMU, and the attitude that is used to remove gravity if the IMU provides no orientation.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import rotation_matrix
from linkwright.geometry.single import (
    IDENTITY,
    Quaternion,
    Transform,
    compose,
    invert,
    quaternion_inverse,
    quaternion_multiply,
    rpy_from_quaternion,
)
from linkwright.navigation.estimation.motion_model import (
    ACCELERATION,
    ANGLES,
    POSE,
    POSITION,
    RATES,
    STATE_SIZE,
    TWIST,
    VELOCITY,
    Matrix,
    State,
    Vector,
    rotation,
)

GRAVITY = 9.80665
"""The standard acceleration of gravity in m/s2."""
_PLANAR_ZEROS = (State.Z, State.ROLL, State.PITCH, State.VZ, State.VROLL, State.VPITCH, State.AZ)
"""The quantities that are zero for a body on a plane."""
_PLANAR_VARIANCE = 1e-6
_MIN_INFLUENCE = 1e-6

UsedFlags = tuple[bool, ...]


class Reading(NamedTuple):
    """A measurement in the form of the state.

    Attributes:
        values: the values, of shape (15,).
        covariance: the covariance of the values, of shape (15, 15).
        used: whether each of the 15 values was measured.
    """

    values: Vector
    covariance: Matrix
    used: UsedFlags


@dataclass(slots=True)
class PoseReader:
    """A converter from the poses of one sensor to readings of the body.

    Args:
        used: whether the sensor provides each of the 15 values of the state; only the first six flags count.
        differential: whether the velocity between successive poses is used instead of the poses.
        relative: whether poses are relative to the first pose.
        two_d: whether the body moves on a plane.
    """

    used: UsedFlags
    differential: bool = False
    relative: bool = False
    two_d: bool = False
    _first: Transform | None = None
    _previous: tuple[Transform, Matrix, int] | None = None

    def reset(self) -> None:
        """Treat the next pose as the first pose."""
        self._first = self._previous = None

    def read(self, pose: Transform, covariance: Matrix, sensor: Transform, time_ns: int) -> Reading | None:
        """Convert a pose.

        Args:
            pose: the pose of the body in the sensor's world.
            covariance: the covariance of the pose, shape (6, 6).
            sensor: the pose of the sensor's world in the filter's world.
            time_ns: the time of the measurement.

        Returns:
            The reading of the finite values; None for a pose without a finite value, and for a differential sensor's
            first pose or a pose that is not newer than the previous one.
        """
        rotation_to_world = rotation_matrix(sensor[3:])
        return self._read(pose, covariance, sensor, rotation_to_world, time_ns)

    def read_orientation(
        self, orientation: Quaternion, covariance: Matrix, mounting: Transform, time_ns: int
    ) -> Reading | None:
        """Convert the orientation of an IMU to a reading, or return None if no value is usable.

        The result is the same as for `read`.

        Args:
            orientation: the orientation of the IMU in the world.
            covariance: the covariance of the pose, shape (6, 6).
            mounting: the pose of the IMU in the body.
            time_ns: the time of the measurement.
        """
        body = quaternion_multiply(orientation, quaternion_inverse(mounting[3:]))
        _, _, yaw = rpy_from_quaternion(mounting[3:])
        return self._read((0.0, 0.0, 0.0, *body), covariance, IDENTITY, rotation(0.0, 0.0, yaw), time_ns)

    def _read(
        self, pose: Transform, covariance: Matrix, sensor: Transform, rotation_to_world: Matrix, time_ns: int
    ) -> Reading | None:
        pose, finite_flags = _replace_non_finite(pose, self.used)
        if not any(finite_flags):
            return None
        used = (
            *_rotate_flags(self.used, finite_flags, rotation_to_world, POSITION),
            *_rotate_flags(self.used, finite_flags, rotation_to_world, ANGLES),
        )
        block_rotation = _make_block_diagonal(rotation_to_world)
        rotated_covariance = block_rotation @ covariance @ block_rotation.T
        if self.differential:
            previous, self._previous = self._previous, (pose, rotated_covariance, time_ns)
            if previous is None or time_ns <= previous[2]:
                return None
            return self._make_velocity_reading(previous, sensor, used)
        if self.relative:
            if self._first is None:
                self._first = pose
            pose = compose(invert(self._first), pose)
        pose = compose(sensor, pose)
        reading = _make_empty_reading()
        reading.values[POSITION] = pose[:3]
        reading.values[ANGLES] = rpy_from_quaternion(pose[3:])
        reading.covariance[POSE, POSE] = rotated_covariance
        return _with_flags(reading, (*used, *([False] * 9)), two_d=self.two_d)

    def _make_velocity_reading(
        self, previous: tuple[Transform, Matrix, int], sensor: Transform, used: UsedFlags
    ) -> Reading:
        assert self._previous is not None
        pose, covariance, time_ns = self._previous
        seconds = (time_ns - previous[2]) / 1e9
        motion = compose((0.0, 0.0, 0.0, *sensor[3:]), compose(invert(previous[0]), pose))
        reading = _make_empty_reading()
        reading.values[VELOCITY] = np.array(motion[:3]) / seconds
        reading.values[RATES] = np.array(rpy_from_quaternion(motion[3:])) / seconds
        reading.covariance[TWIST, TWIST] = (covariance + previous[1]) * seconds
        return _with_flags(reading, (*([False] * 6), *used, *([False] * 3)), two_d=self.two_d)


def read_twist(
    linear: Vector,
    angular: Vector,
    covariance: Matrix,
    mounting: Transform,
    rates: Vector,
    used: UsedFlags,
    *,
    two_d: bool,
) -> Reading:
    """Convert a twist in a sensor's frame to a reading of the body's velocities.

    Args:
        linear: the linear velocity in the sensor's frame, in m/s.
        angular: the angular velocity in the sensor's frame, in rad/s.
        covariance: the covariance of the twist, shape (6, 6).
        mounting: the pose of the sensor in the body.
        rates: the estimated angular velocity of the body, in rad/s; it corrects for the offset of the sensor.
        used: whether the sensor provides each of the 15 values; only the velocities count.
        two_d: whether the body moves on a plane.
    """
    rotation_to_body = rotation_matrix(mounting[3:])
    block_rotation = _make_block_diagonal(rotation_to_body)
    finite_flags = _clear_non_finite_flags(_clear_non_finite_flags(used, VELOCITY, linear), RATES, angular)
    linear, angular = _finite_or_zero(linear), _finite_or_zero(angular)
    reading = _make_empty_reading()
    x, y, z = mounting[:3]
    roll, pitch, yaw = rates.tolist()
    reading.values[VELOCITY] = rotation_to_body @ linear + (
        y * yaw - z * pitch,
        z * roll - x * yaw,
        x * pitch - y * roll,
    )
    reading.values[RATES] = rotation_to_body @ angular
    reading.covariance[TWIST, TWIST] = block_rotation @ covariance @ block_rotation.T
    mask = (
        *([False] * 6),
        *_rotate_flags(used, finite_flags, rotation_to_body, VELOCITY),
        *_rotate_flags(used, finite_flags, rotation_to_body, RATES),
        *([False] * 3),
    )
    return _with_flags(reading, mask, two_d=two_d)


def read_acceleration(
    acceleration: Vector, covariance: Matrix, mounting: Transform, used: UsedFlags, *, two_d: bool
) -> Reading:
    """Convert an acceleration in a sensor's frame to a reading of the body's acceleration.

    Args:
        acceleration: the acceleration in the sensor's frame, with gravity already subtracted, in m/s2.
        covariance: the covariance of the acceleration, shape (3, 3).
        mounting: the pose of the sensor in the body; only its rotation is used.
        used: whether the sensor provides each of the 15 values; only the accelerations count.
        two_d: whether the body moves on a plane.
    """
    rotation_to_body = rotation_matrix(mounting[3:])
    finite_flags = _clear_non_finite_flags(used, ACCELERATION, acceleration)
    reading = _make_empty_reading()
    reading.values[ACCELERATION] = rotation_to_body @ _finite_or_zero(acceleration)
    reading.covariance[ACCELERATION, ACCELERATION] = rotation_to_body @ covariance @ rotation_to_body.T
    return _with_flags(
        reading,
        (*([False] * 12), *_rotate_flags(used, finite_flags, rotation_to_body, ACCELERATION)),
        two_d=two_d,
    )


def subtract_gravity(acceleration: Vector, orientation: Quaternion, gravity: float = GRAVITY) -> Vector:
    """Subtract gravity from a measured acceleration.

    Args:
        acceleration: the measured acceleration in the sensor's frame, in m/s2.
        orientation: the orientation of the sensor in the world.
        gravity: the gravitational acceleration, in m/s2.
    """
    remaining: Vector = acceleration - rotation_matrix(orientation)[2] * gravity
    return remaining


def _make_empty_reading() -> Reading:
    return Reading(np.zeros(STATE_SIZE), np.zeros((STATE_SIZE, STATE_SIZE)), ())


def _with_flags(reading: Reading, used: UsedFlags, *, two_d: bool) -> Reading:
    if two_d:
        used = tuple(flag or index in _PLANAR_ZEROS for index, flag in enumerate(used))
        for index in _PLANAR_ZEROS:
            reading.values[index] = 0.0
            reading.covariance[index, index] = _PLANAR_VARIANCE
    return reading._replace(used=used)


def _replace_non_finite(pose: Transform, used: UsedFlags) -> tuple[Transform, UsedFlags]:
    """Return a pose without non-finite values, and flags of the used values that are finite.

    A non-finite coordinate becomes 0, and a non-finite orientation becomes the identity.
    """
    x, y, z = (value if isfinite(value) else 0.0 for value in pose[:3])
    finite_flags = _clear_non_finite_flags(used, POSITION, np.array(pose[:3]))
    if all(isfinite(value) for value in pose[3:]):
        return (x, y, z, *pose[3:]), finite_flags
    return (x, y, z, *IDENTITY[3:]), tuple(flag and not 3 <= index < 6 for index, flag in enumerate(finite_flags))


def _clear_non_finite_flags(used: UsedFlags, section: slice, values: Vector) -> UsedFlags:
    """Return the flags, with the flags of non-finite values in a section of the state cleared."""
    flags = list(used)
    flags[section] = [bool(value) for value in np.array(used[section]) & np.isfinite(values)]
    return tuple(flags)


def _finite_or_zero(values: Vector) -> Vector:
    numbers: Vector = np.where(np.isfinite(values), values, 0.0)
    return numbers


def _rotate_flags(used: UsedFlags, finite_flags: UsedFlags, rotation_to_body: Matrix, section: slice) -> UsedFlags:
    """Return flags of the body's components that depend only on finite sensor components."""
    lost_flags = tuple(used_flag and not finite_flag for used_flag, finite_flag in zip(used, finite_flags, strict=True))
    return tuple(
        bool(is_affected and not depends_on_lost)
        for is_affected, depends_on_lost in zip(
            _find_affected_components(finite_flags, rotation_to_body, section),
            _find_affected_components(lost_flags, rotation_to_body, section),
            strict=True,
        )
    )


def _find_affected_components(flags: UsedFlags, rotation_to_body: Matrix, section: slice) -> NDArray[np.bool_]:
    """Return a mask of the body's components that depend on a flagged sensor component."""
    columns = rotation_to_body[:, np.array(flags[section], dtype=bool)]
    is_affected: NDArray[np.bool_] = np.sum(columns * columns, axis=1) >= _MIN_INFLUENCE * _MIN_INFLUENCE
    return is_affected


def _make_block_diagonal(rotation_matrix_3d: Matrix) -> Matrix:
    matrix = np.zeros((6, 6))
    matrix[:3, :3] = matrix[3:, 3:] = rotation_matrix_3d
    return matrix
