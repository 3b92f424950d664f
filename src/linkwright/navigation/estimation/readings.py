"""Conversion of poses, twists and accelerations of sensors to measurements of the body that carries the sensors.

Source of the rules: robot_localization. Two computations that are approximate there are exact here: the orientation of
an IMU that is mounted rotated, and the attitude with which gravity is removed if the IMU provides no orientation.
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
    SIZE,
    TWIST,
    VELOCITY,
    Matrix,
    State,
    Vector,
    rotation,
)

GRAVITY = 9.80665
_FLAT = (State.Z, State.ROLL, State.PITCH, State.VZ, State.VROLL, State.VPITCH, State.AZ)
"""The quantities that are zero for a body on a plane."""
_FLAT_VARIANCE = 1e-6
_LEAST = 1e-6

Used = tuple[bool, ...]


class Reading(NamedTuple):
    """Values of the state, their covariance, and flags of the measured values.

    The values have shape (15,) and the covariance has shape (15, 15); there are 15 flags.
    """

    values: Vector
    covariance: Matrix
    used: Used


@dataclass(slots=True)
class PoseReader:
    """A converter from the poses of one sensor to readings of the body.

    Args:
        used: which of the 15 values of the state the sensor provides; only the first six count.
        differential: whether the difference of two successive poses is used, as a velocity.
        relative: whether poses are relative to the first one.
        two_d: whether the body moves on a plane.
    """

    used: Used
    differential: bool = False
    relative: bool = False
    two_d: bool = False
    _first: Transform | None = None
    _last: tuple[Transform, Matrix, int] | None = None

    def forget(self) -> None:
        """Treat the next pose as the first one."""
        self._first = self._last = None

    def read(self, pose: Transform, covariance: Matrix, sensor: Transform, time_ns: int) -> Reading | None:
        """Convert a pose.

        Args:
            pose: the pose of the body in the sensor's world.
            covariance: the covariance of the pose, shape (6, 6).
            sensor: the pose of the sensor's world in the filter's world.
            time_ns: the time of the measurement.

        Returns:
            The reading without values that are not finite; None for the first pose of a differential sensor, and for a
            pose without any finite value.
        """
        turn = rotation_matrix(sensor[3:])
        return self._read(pose, covariance, sensor, turn, time_ns)

    def read_orientation(
        self, orientation: Quaternion, covariance: Matrix, mounting: Transform, time_ns: int
    ) -> Reading | None:
        """Convert the orientation of an IMU; see `read` for the result.

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
        self, pose: Transform, covariance: Matrix, sensor: Transform, turn: Matrix, time_ns: int
    ) -> Reading | None:
        pose, known = _known_pose(pose, self.used)
        if not any(known):
            return None
        used = (
            *_rotated_components(self.used, known, turn, POSITION),
            *_rotated_components(self.used, known, turn, ANGLES),
        )
        both = _block_diagonal(turn)
        turned = both @ covariance @ both.T
        if self.differential:
            before, self._last = self._last, (pose, turned, time_ns)
            if before is None or time_ns <= before[2]:
                return None
            return self._difference(before, sensor, used)
        if self.relative:
            if self._first is None:
                self._first = pose
            pose = compose(invert(self._first), pose)
        pose = compose(sensor, pose)
        reading = _empty_reading()
        reading.values[POSITION] = pose[:3]
        reading.values[ANGLES] = rpy_from_quaternion(pose[3:])
        reading.covariance[POSE, POSE] = turned
        return _finished(reading, (*used, *([False] * 9)), two_d=self.two_d)

    def _difference(self, before: tuple[Transform, Matrix, int], sensor: Transform, used: Used) -> Reading:
        assert self._last is not None
        pose, covariance, time_ns = self._last
        seconds = (time_ns - before[2]) / 1e9
        moved = compose((0.0, 0.0, 0.0, *sensor[3:]), compose(invert(before[0]), pose))
        reading = _empty_reading()
        reading.values[VELOCITY] = np.array(moved[:3]) / seconds
        reading.values[RATES] = np.array(rpy_from_quaternion(moved[3:])) / seconds
        reading.covariance[TWIST, TWIST] = (covariance + before[1]) * seconds
        return _finished(reading, (*([False] * 6), *used, *([False] * 3)), two_d=self.two_d)


def read_twist(
    linear: Vector, angular: Vector, covariance: Matrix, mounting: Transform, rates: Vector, used: Used, *, two_d: bool
) -> Reading:
    """Convert a twist in a sensor's frame to a reading of the body's velocities.

    Args:
        linear: the linear velocity in the sensor's frame, in m/s.
        angular: the angular velocity in the sensor's frame, in rad/s.
        covariance: the covariance of the twist, shape (6, 6).
        mounting: the pose of the sensor in the body.
        rates: the estimated angular velocity of the body, which moves a sensor mounted away from the body's origin.
        used: which of the 15 values the sensor provides; only the velocities count.
        two_d: whether the body moves on a plane.
    """
    turn = rotation_matrix(mounting[3:])
    both = _block_diagonal(turn)
    known = _finite(_finite(used, VELOCITY, linear), RATES, angular)
    linear, angular = _numbers(linear), _numbers(angular)
    reading = _empty_reading()
    x, y, z = mounting[:3]
    roll, pitch, yaw = rates.tolist()
    reading.values[VELOCITY] = turn @ linear + (y * yaw - z * pitch, z * roll - x * yaw, x * pitch - y * roll)
    reading.values[RATES] = turn @ angular
    reading.covariance[TWIST, TWIST] = both @ covariance @ both.T
    mask = (
        *([False] * 6),
        *_rotated_components(used, known, turn, VELOCITY),
        *_rotated_components(used, known, turn, RATES),
        *([False] * 3),
    )
    return _finished(reading, mask, two_d=two_d)


def read_acceleration(
    acceleration: Vector, covariance: Matrix, mounting: Transform, used: Used, *, two_d: bool
) -> Reading:
    """Convert an acceleration in a sensor's frame to a reading of the body's acceleration.

    Args:
        acceleration: the acceleration in the sensor's frame without gravity, in m/s2.
        covariance: the covariance of the acceleration, shape (3, 3).
        mounting: the pose of the sensor in the body; only its rotation is used.
        used: which of the 15 values the sensor provides; only the accelerations count.
        two_d: whether the body moves on a plane.
    """
    turn = rotation_matrix(mounting[3:])
    known = _finite(used, ACCELERATION, acceleration)
    reading = _empty_reading()
    reading.values[ACCELERATION] = turn @ _numbers(acceleration)
    reading.covariance[ACCELERATION, ACCELERATION] = turn @ covariance @ turn.T
    return _finished(reading, (*([False] * 12), *_rotated_components(used, known, turn, ACCELERATION)), two_d=two_d)


def subtract_gravity(acceleration: Vector, orientation: Quaternion, gravity: float = GRAVITY) -> Vector:
    """Subtract gravity from a measured acceleration.

    Args:
        acceleration: the measured acceleration in the sensor's frame, in m/s2.
        orientation: the orientation of the sensor in the world.
        gravity: the gravitational acceleration, in m/s2.
    """
    rest: Vector = acceleration - rotation_matrix(orientation)[2] * gravity
    return rest


def _empty_reading() -> Reading:
    return Reading(np.zeros(SIZE), np.zeros((SIZE, SIZE)), ())


def _finished(reading: Reading, used: Used, *, two_d: bool) -> Reading:
    if two_d:
        used = tuple(each or index in _FLAT for index, each in enumerate(used))
        for index in _FLAT:
            reading.values[index] = 0.0
            reading.covariance[index, index] = _FLAT_VARIANCE
    return reading._replace(used=used)


def _known_pose(pose: Transform, used: Used) -> tuple[Transform, Used]:
    """Return a pose with finite values, and the flags of the used values that were finite.

    Parts that are not finite are replaced by the identity.
    """
    x, y, z = (value if isfinite(value) else 0.0 for value in pose[:3])
    known = _finite(used, POSITION, np.array(pose[:3]))
    if all(isfinite(value) for value in pose[3:]):
        return (x, y, z, *pose[3:]), known
    return (x, y, z, *IDENTITY[3:]), tuple(each and not 3 <= index < 6 for index, each in enumerate(known))


def _finite(used: Used, part: slice, values: Vector) -> Used:
    """Return the flags of the used values, with those of non-finite values of a part cleared."""
    flags = list(used)
    flags[part] = [bool(value) for value in np.array(used[part]) & np.isfinite(values)]
    return tuple(flags)


def _numbers(values: Vector) -> Vector:
    numbers: Vector = np.where(np.isfinite(values), values, 0.0)
    return numbers


def _rotated_components(used: Used, known: Used, turn: Matrix, part: slice) -> Used:
    """Return flags of the body's components that depend only on known sensor components."""
    lost = tuple(each and not here for each, here in zip(used, known, strict=True))
    return tuple(
        bool(here and not gone)
        for here, gone in zip(
            _affected_components(known, turn, part), _affected_components(lost, turn, part), strict=True
        )
    )


def _affected_components(flags: Used, turn: Matrix, part: slice) -> NDArray[np.bool_]:
    """Return a mask of the body's components that depend on a flagged sensor component."""
    columns = turn[:, np.array(flags[part], dtype=bool)]
    touched: NDArray[np.bool_] = np.sum(columns * columns, axis=1) >= _LEAST * _LEAST
    return touched


def _block_diagonal(turn: Matrix) -> Matrix:
    both = np.zeros((6, 6))
    both[:3, :3] = both[3:, 3:] = turn
    return both
