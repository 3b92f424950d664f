"""Estimation of a body's orientation from its gyroscope, accelerometer and magnetometer.

Orientations are unit quaternions x y z w that rotate vectors from the body to the world. Sources: S. Madgwick, "An
efficient orientation filter for inertial and inertial/magnetic sensor arrays", 2010; R. Valenti, I. Dryanovski and
J. Xiao, "Keeping a Good Attitude", Sensors 2015.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from math import atan2, cos, hypot, sin, sqrt

import numpy as np

from linkwright.geometry.arrays import quaternion_from_matrix
from linkwright.geometry.single import (
    Quaternion,
    Vector3,
    cross,
    normalized,
    quaternion_from_rpy,
    quaternion_inverse,
    quaternion_multiply,
    rotate,
    rotation_from_z,
    scaled,
)

GRAVITY = 9.80665
_FREE_FALL = 1e-3
"""m/s2, or the same fraction of any field: a smaller vector has no usable direction."""
_NONE: Quaternion = (0.0, 0.0, 0.0, 1.0)


class World(Enum):
    """The directions of the world's x, y and z axes: east, north, west, south, up, down."""

    ENU = "enu"
    NWU = "nwu"
    NED = "ned"

    @property
    def up(self) -> float:
        """1 if z points up, else -1."""
        return -1.0 if self is World.NED else 1.0


def attitude(acceleration: Vector3, magnetic: Vector3 | None, world: World) -> Quaternion | None:
    """Return the orientation of a body at rest.

    Args:
        acceleration: the reading of the accelerometer, which points away from the earth.
        magnetic: the reading of the magnetometer, in any unit; None for an orientation without yaw.
        world: the axes of the world.

    Returns:
        The orientation; None if the measurements have no usable direction.
    """
    x, y, z = (value * world.up for value in acceleration)
    if hypot(x, y, z) < _FREE_FALL:
        return None
    if magnetic is None:
        return quaternion_from_rpy((atan2(y, z), atan2(-x, hypot(y, z)), 0.0))
    up = _unit(acceleration)
    east = cross(magnetic, up)
    if hypot(*east) < _FREE_FALL * hypot(*magnetic) or not hypot(*magnetic):
        return None
    east = _unit(east)
    north = cross(up, east)
    axes = {
        World.ENU: (east, north, up),
        World.NWU: (north, scaled(east, -1.0), up),
        World.NED: (north, east, scaled(up, -1.0)),
    }[world]
    qx, qy, qz, qw = quaternion_from_matrix(np.array(axes)).tolist()
    return qx, qy, qz, qw


@dataclass(slots=True)
class MadgwickFilter:
    """Integrates the gyroscope, and corrects by gradient descent towards accelerometer and magnetometer (Madgwick).

    Attributes:
        gain: the step of the gradient descent per second, in rad/s.
        zeta: the rate at which the gyroscope's drift is learnt, in rad/s per second.
        world: the axes of the world.
        orientation: the orientation of the body in the world.
        drift: the drift of the gyroscope, in rad/s.
    """

    gain: float = 0.1
    zeta: float = 0.0
    world: World = World.ENU
    orientation: Quaternion = _NONE
    drift: Vector3 = (0.0, 0.0, 0.0)

    def update(self, rates: Vector3, acceleration: Vector3, magnetic: Vector3 | None, seconds: float) -> None:
        """Update the orientation by a measurement.

        Args:
            rates: the angular velocity, in rad/s.
            acceleration: the acceleration, in m/s2.
            magnetic: the magnetic field, in any unit; None if it is not measured.
            seconds: the seconds since the last call.
        """
        slope = self._slope(acceleration, magnetic)
        if self.zeta and slope is not None:
            x, y, z, _ = quaternion_multiply(quaternion_inverse(self.orientation), slope)
            self.drift = _sum(self.drift, (x, y, z), 2.0 * self.zeta * seconds)
        rates = _sum(rates, self.drift, -1.0)
        change = _scaled4(quaternion_multiply(self.orientation, (*rates, 0.0)), 0.5)
        if slope is not None:
            change = _sum4(change, slope, -self.gain)
        self.orientation = normalized(*_sum4(self.orientation, change, seconds))

    def _slope(self, acceleration: Vector3, magnetic: Vector3 | None) -> Quaternion | None:
        """Return the direction in which the error grows.

        Returns None if the error is zero or there is no reference.
        """
        if hypot(*acceleration) < _FREE_FALL:
            return None
        slope = self._slope_of((0.0, 0.0, self.world.up), _unit(acceleration))
        if magnetic is not None and hypot(*magnetic) > 0.0:
            seen = _unit(magnetic)
            x, y, z = rotate(self.orientation, seen)
            level = hypot(x, y)
            north = (0.0, level, z) if self.world is World.ENU else (level, 0.0, z)
            slope = _sum4(slope, self._slope_of(north, seen), 1.0)
        length = sqrt(sum(value * value for value in slope))
        return _scaled4(slope, 1.0 / length) if length > 1e-12 else None

    def _slope_of(self, direction: Vector3, seen: Vector3) -> Quaternion:
        """Return the gradient of half the squared difference between a world direction in the body frame and `seen`.

        A small change of the orientation q by dq changes the predicted reading, q* d q, by dq* d q + q* d dq; its
        product with the difference e is that of dq with -2 d q e.
        """
        x, y, z = rotate(quaternion_inverse(self.orientation), direction)
        difference = (x - seen[0], y - seen[1], z - seen[2], 0.0)
        return _scaled4(quaternion_multiply(quaternion_multiply((*direction, 0.0), self.orientation), difference), -2.0)


@dataclass(slots=True)
class ComplementaryFilter:
    """Integrates the gyroscope, and corrects by a fraction of the error.

    The world axes are north, west, up.

    Attributes:
        gain_acc: the fraction of the error that the accelerometer corrects.
        gain_mag: the fraction of the error that the magnetometer corrects.
        bias_alpha: the rate at which the gyroscope's bias is learnt at rest.
        do_bias_estimation: whether the bias is learnt.
        do_adaptive_gain: whether the accelerometer has less weight while the body accelerates.
        orientation: the orientation of the body in the world.
        bias: the bias of the gyroscope, in rad/s.
    """

    gain_acc: float = 0.01
    gain_mag: float = 0.01
    bias_alpha: float = 0.01
    do_bias_estimation: bool = True
    do_adaptive_gain: bool = True
    orientation: Quaternion = _NONE
    bias: Vector3 = (0.0, 0.0, 0.0)
    _last_rates: Vector3 = (0.0, 0.0, 0.0)

    def update(self, rates: Vector3, acceleration: Vector3, magnetic: Vector3 | None, seconds: float) -> None:
        """Update the orientation by a measurement; see `MadgwickFilter.update`."""
        if self.do_bias_estimation and self._rests(rates, acceleration):
            self.bias = _sum(self.bias, _sum(rates, self.bias, -1.0), self.bias_alpha)
        self._last_rates = rates
        turn = scaled(_sum(rates, self.bias, -1.0), seconds)
        self.orientation = quaternion_multiply(self.orientation, _rotation(turn))
        length = hypot(*acceleration)
        if length >= _FREE_FALL:
            up = rotate(self.orientation, _unit(acceleration))
            gain = self.gain_acc * (_trust(length) if self.do_adaptive_gain else 1.0)
            # Rotates the measured up direction to the true one.
            back = quaternion_inverse(rotation_from_z(up))
            self.orientation = quaternion_multiply(_part(back, gain), self.orientation)
        if magnetic is not None and hypot(*magnetic) > 0.0:
            x, y, _ = rotate(self.orientation, magnetic)
            if hypot(x, y) > 0.0:
                self.orientation = quaternion_multiply(
                    _rotation((0.0, 0.0, -self.gain_mag * atan2(y, x))), self.orientation
                )
        self.orientation = normalized(*self.orientation)

    def _rests(self, rates: Vector3, acceleration: Vector3) -> bool:
        return (
            abs(hypot(*acceleration) - GRAVITY) <= 0.1
            and all(abs(now - before) <= 0.01 for now, before in zip(rates, self._last_rates, strict=True))
            and all(abs(now - bias) <= 0.2 for now, bias in zip(rates, self.bias, strict=True))
        )


def _trust(length: float) -> float:
    """Return the weight of an acceleration: 1 if its length is within 10 % of gravity, 0 beyond 20 %."""
    error = abs(length - GRAVITY) / GRAVITY
    return min(1.0, max(0.0, 2.0 - error / 0.1))


def _rotation(turn: Vector3) -> Quaternion:
    """Return the rotation given by a rotation vector in rad."""
    angle = hypot(*turn)
    scale = sin(angle / 2.0) / angle if angle > 0.0 else 0.5
    return turn[0] * scale, turn[1] * scale, turn[2] * scale, cos(angle / 2.0)


def _part(rotation: Quaternion, share: float) -> Quaternion:
    """Return a rotation by a fraction of the angle about the same axis."""
    x, y, z, w = rotation if rotation[3] >= 0.0 else _scaled4(rotation, -1.0)
    sine = hypot(x, y, z)
    if sine == 0.0:
        return _NONE
    angle = 2.0 * atan2(sine, w) * share
    return _rotation((x / sine * angle, y / sine * angle, z / sine * angle))


def _unit(vector: Vector3) -> Vector3:
    return scaled(vector, 1.0 / hypot(*vector))


def _sum(first: Vector3, second: Vector3, factor: float) -> Vector3:
    return first[0] + second[0] * factor, first[1] + second[1] * factor, first[2] + second[2] * factor


def _scaled4(quaternion: Quaternion, factor: float) -> Quaternion:
    x, y, z, w = quaternion
    return x * factor, y * factor, z * factor, w * factor


def _sum4(first: Quaternion, second: Quaternion, factor: float) -> Quaternion:
    return (
        first[0] + second[0] * factor,
        first[1] + second[1] * factor,
        first[2] + second[2] * factor,
        first[3] + second[3] * factor,
    )
