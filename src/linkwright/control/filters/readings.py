"""What poses, twists and accelerations that sensors give mean for the state of a body, wherever the sensor is mounted.

Source of the rules: robot_localization. Two are exact here that are approximate there: the orientation of an IMU that
is mounted turned, and the attitude by which gravity is taken away where the IMU has none.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from linkwright.control.filters.motion_model import (
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

GRAVITY = 9.80665
_FLAT = (State.Z, State.ROLL, State.PITCH, State.VZ, State.VROLL, State.VPITCH, State.AZ)
"""What is zero for a body on a plane."""
_FLAT_VARIANCE = 1e-6
_LEAST = 1e-6

Used = tuple[bool, ...]


class Reading(NamedTuple):
    """Values of the state, their covariance, and which of them were measured: shapes (15,), (15, 15) and 15."""

    values: Vector
    covariance: Matrix
    used: Used


@dataclass(slots=True)
class PoseReader:
    """Reads poses of one sensor.

    Args:
        used: which of the 15 values of the state it gives; all but the first six are left out.
        differential: whether the difference of two poses is taken, as a velocity.
        relative: whether poses count from the first one.
        two_d: whether the body moves on a plane.
    """

    used: Used
    differential: bool = False
    relative: bool = False
    two_d: bool = False
    _first: Transform | None = None
    _last: tuple[Transform, Matrix, int] | None = None

    def forget(self) -> None:
        """Take the next pose as the first one."""
        self._first = self._last = None

    def read(self, pose: Transform, covariance: Matrix, sensor: Transform, time_ns: int) -> Reading | None:
        """What a pose tells.

        Args:
            pose: of the body in the sensor's world.
            covariance: shape (6, 6).
            sensor: the pose of the sensor's world in ours.
            time_ns: when it was measured.

        Returns:
            The reading, or None for the first pose of a differential sensor.
        """
        turn = rotation_matrix(sensor[3:])
        return self._read(pose, covariance, sensor, turn, time_ns)

    def read_orientation(
        self, orientation: Quaternion, covariance: Matrix, mounting: Transform, time_ns: int
    ) -> Reading | None:
        """What the orientation of an IMU tells.

        Args:
            orientation: of the IMU in the world.
            covariance: shape (6, 6).
            mounting: the pose of the IMU in the body.
            time_ns: when it was measured.
        """
        body = quaternion_multiply(orientation, quaternion_inverse(mounting[3:]))
        _, _, yaw = rpy_from_quaternion(mounting[3:])
        return self._read((0.0, 0.0, 0.0, *body), covariance, IDENTITY, rotation(0.0, 0.0, yaw), time_ns)

    def _read(
        self, pose: Transform, covariance: Matrix, sensor: Transform, turn: Matrix, time_ns: int
    ) -> Reading | None:
        used = (*_turned(self.used, turn, POSITION), *_turned(self.used, turn, ANGLES))
        both = _twice(turn)
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
        reading = _empty()
        reading.values[POSITION] = pose[:3]
        reading.values[ANGLES] = rpy_from_quaternion(pose[3:])
        reading.covariance[POSE, POSE] = turned
        return _finished(reading, (*used, *([False] * 9)), self.two_d)

    def _difference(self, before: tuple[Transform, Matrix, int], sensor: Transform, used: Used) -> Reading:
        assert self._last is not None
        pose, covariance, time_ns = self._last
        seconds = (time_ns - before[2]) / 1e9
        moved = compose((0.0, 0.0, 0.0, *sensor[3:]), compose(invert(before[0]), pose))
        reading = _empty()
        reading.values[VELOCITY] = np.array(moved[:3]) / seconds
        reading.values[RATES] = np.array(rpy_from_quaternion(moved[3:])) / seconds
        reading.covariance[TWIST, TWIST] = (covariance + before[1]) * seconds
        return _finished(reading, (*([False] * 6), *used, *([False] * 3)), self.two_d)


def read_twist(
    linear: Vector, angular: Vector, covariance: Matrix, mounting: Transform, rates: Vector, used: Used, *, two_d: bool
) -> Reading:
    """What a twist tells.

    Args:
        linear: m/s, in the sensor's frame.
        angular: rad/s, in the sensor's frame.
        covariance: shape (6, 6).
        mounting: the pose of the sensor in the body.
        rates: angular velocity of the body as it is estimated, which moves a sensor that is not at its origin.
        used: which of the 15 values it gives; all but the velocities are left out.
        two_d: whether the body moves on a plane.
    """
    turn = rotation_matrix(mounting[3:])
    both = _twice(turn)
    reading = _empty()
    x, y, z = mounting[:3]
    roll, pitch, yaw = rates.tolist()
    reading.values[VELOCITY] = turn @ linear + (y * yaw - z * pitch, z * roll - x * yaw, x * pitch - y * roll)
    reading.values[RATES] = turn @ angular
    reading.covariance[TWIST, TWIST] = both @ covariance @ both.T
    mask = (*([False] * 6), *_turned(used, turn, VELOCITY), *_turned(used, turn, RATES), *([False] * 3))
    return _finished(reading, mask, two_d)


def read_acceleration(
    acceleration: Vector, covariance: Matrix, mounting: Transform, used: Used, *, two_d: bool
) -> Reading:
    """What an accelerometer tells.

    Args:
        acceleration: m/s2, in the sensor's frame, without gravity.
        covariance: shape (3, 3).
        mounting: the pose of the sensor in the body; only its rotation counts.
        used: which of the 15 values it gives; all but the accelerations are left out.
        two_d: whether the body moves on a plane.
    """
    turn = rotation_matrix(mounting[3:])
    reading = _empty()
    reading.values[ACCELERATION] = turn @ acceleration
    reading.covariance[ACCELERATION, ACCELERATION] = turn @ covariance @ turn.T
    return _finished(reading, (*([False] * 12), *_turned(used, turn, ACCELERATION)), two_d)


def without_gravity(acceleration: Vector, orientation: Quaternion, gravity: float = GRAVITY) -> Vector:
    """What an accelerometer measures, less what it measures at rest.

    Args:
        acceleration: m/s2, in the sensor's frame.
        orientation: of the sensor in the world.
        gravity: m/s2.
    """
    rest: Vector = acceleration - rotation_matrix(orientation)[2] * gravity
    return rest


def _empty() -> Reading:
    return Reading(np.zeros(SIZE), np.zeros((SIZE, SIZE)), ())


def _finished(reading: Reading, used: Used, two_d: bool) -> Reading:
    if two_d:
        used = tuple(each or index in _FLAT for index, each in enumerate(used))
        for index in _FLAT:
            reading.values[index] = 0.0
            reading.covariance[index, index] = _FLAT_VARIANCE
    return reading._replace(used=used)


def _turned(used: Used, turn: Matrix, part: slice) -> Used:
    """Which components are known of a vector in our axes when some are known in the sensor's."""
    known = turn[:, np.array(used[part], dtype=bool)]
    return tuple(bool(each) for each in np.sum(known * known, axis=1) >= _LEAST * _LEAST)


def _twice(turn: Matrix) -> Matrix:
    both = np.zeros((6, 6))
    both[:3, :3] = both[3:, 3:] = turn
    return both
