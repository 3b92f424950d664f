"""Estimate a body's orientation from its gyroscope, accelerometer and magnetometer.

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
"""The standard acceleration of gravity in m/s2."""
_MIN_LENGTH = 1e-3
"""The minimum length of a vector with a usable direction, in m/s2 or as a fraction of a field."""
_IDENTITY: Quaternion = (0.0, 0.0, 0.0, 1.0)


class WorldFrame(Enum):
    """The directions of the world's x, y and z axes: east, north, west, south, up, down."""

    ENU = "enu"
    NWU = "nwu"
    NED = "ned"

    @property
    def up(self) -> float:
        """The z component of the up direction: 1, or -1 for NED."""
        return -1.0 if self is WorldFrame.NED else 1.0


def compute_attitude_at_rest(acceleration: Vector3, magnetic: Vector3 | None, world: WorldFrame) -> Quaternion | None:
    """Return the orientation of a body at rest.

    Args:
        acceleration: the reading of the accelerometer at rest, which points up.
        magnetic: the reading of the magnetometer, in any unit; None for an orientation without yaw.
        world: the axes of the world.

    Returns:
        The orientation of the body in the world; None if the readings have no usable direction.
    """
    x, y, z = (value * world.up for value in acceleration)
    if hypot(x, y, z) < _MIN_LENGTH:
        return None
    if magnetic is None:
        return quaternion_from_rpy((atan2(y, z), atan2(-x, hypot(y, z)), 0.0))
    up = _normalize(acceleration)
    east = cross(magnetic, up)
    if hypot(*east) < _MIN_LENGTH * hypot(*magnetic) or not hypot(*magnetic):
        return None
    east = _normalize(east)
    north = cross(up, east)
    axes = {
        WorldFrame.ENU: (east, north, up),
        WorldFrame.NWU: (north, scaled(east, -1.0), up),
        WorldFrame.NED: (north, east, scaled(up, -1.0)),
    }[world]
    qx, qy, qz, qw = quaternion_from_matrix(np.array(axes)).tolist()
    return qx, qy, qz, qw


@dataclass(slots=True)
class MadgwickFilter:
    """A Madgwick filter: integrates the gyroscope, and corrects the result by gradient descent.

    Attributes:
        gain: the size of the correction, in rad/s.
        zeta: the rate at which the gyroscope's drift is estimated, in rad/s per second.
        world: the axes of the world.
        orientation: the orientation of the body in the world.
        drift: the drift of the gyroscope, in rad/s.
    """

    gain: float = 0.1
    zeta: float = 0.0
    world: WorldFrame = WorldFrame.ENU
    orientation: Quaternion = _IDENTITY
    drift: Vector3 = (0.0, 0.0, 0.0)

    def update(self, rates: Vector3, acceleration: Vector3, magnetic: Vector3 | None, seconds: float) -> None:
        """Update the orientation with a measurement.

        Args:
            rates: the angular velocity, in rad/s.
            acceleration: the acceleration, in m/s2.
            magnetic: the magnetic field, in any unit; None if it is not measured.
            seconds: the seconds since the previous measurement.
        """
        gradient = self._compute_gradient(acceleration, magnetic)
        if self.zeta and gradient is not None:
            x, y, z, _ = quaternion_multiply(quaternion_inverse(self.orientation), gradient)
            self.drift = _add_scaled(self.drift, (x, y, z), 2.0 * self.zeta * seconds)
        rates = _add_scaled(rates, self.drift, -1.0)
        change = _scale_quaternion(quaternion_multiply(self.orientation, (*rates, 0.0)), 0.5)
        if gradient is not None:
            change = _add_scaled_quaternion(change, gradient, -self.gain)
        self.orientation = normalized(*_add_scaled_quaternion(self.orientation, change, seconds))

    def _compute_gradient(self, acceleration: Vector3, magnetic: Vector3 | None) -> Quaternion | None:
        """Return the normalized gradient of the error of the orientation.

        Return None if the error is zero or the acceleration has no usable direction.
        """
        if hypot(*acceleration) < _MIN_LENGTH:
            return None
        gradient = self._compute_direction_gradient((0.0, 0.0, self.world.up), _normalize(acceleration))
        if magnetic is not None and hypot(*magnetic) > 0.0:
            reading = _normalize(magnetic)
            x, y, z = rotate(self.orientation, reading)
            horizontal = hypot(x, y)
            north = (0.0, horizontal, z) if self.world is WorldFrame.ENU else (horizontal, 0.0, z)
            gradient = _add_scaled_quaternion(gradient, self._compute_direction_gradient(north, reading), 1.0)
        norm = sqrt(sum(value * value for value in gradient))
        return _scale_quaternion(gradient, 1.0 / norm) if norm > 1e-12 else None

    def _compute_direction_gradient(self, direction: Vector3, reading: Vector3) -> Quaternion:
        """Return the gradient of half the squared error of a predicted reading.

        The prediction is a world direction d, rotated to the body frame. A small change of the orientation q by dq
        changes the prediction, q* d q, by dq* d q + q* d dq. The product of this change with the error e is the product
        of dq with -2 d q e.
        """
        x, y, z = rotate(quaternion_inverse(self.orientation), direction)
        difference = (x - reading[0], y - reading[1], z - reading[2], 0.0)
        return _scale_quaternion(
            quaternion_multiply(quaternion_multiply((*direction, 0.0), self.orientation), difference), -2.0
        )


@dataclass(slots=True)
class ComplementaryFilter:
    """A complementary filter: integrates the gyroscope, and corrects it with the other sensors.

    Each measurement corrects a fraction of the error. The world axes are north, west, up.

    Attributes:
        gain_acc: the fraction of the error that the accelerometer corrects at each measurement, 0 to 1.
        gain_mag: the fraction of the error that the magnetometer corrects at each measurement, 0 to 1.
        bias_alpha: the fraction of the difference by which the bias is updated at each measurement at rest, 0 to 1.
        do_bias_estimation: whether the bias is estimated.
        do_adaptive_gain: whether the accelerometer has less weight while the body accelerates.
        orientation: the orientation of the body in the world.
        bias: the bias of the gyroscope, in rad/s.
    """

    gain_acc: float = 0.01
    gain_mag: float = 0.01
    bias_alpha: float = 0.01
    do_bias_estimation: bool = True
    do_adaptive_gain: bool = True
    orientation: Quaternion = _IDENTITY
    bias: Vector3 = (0.0, 0.0, 0.0)
    _last_rates: Vector3 = (0.0, 0.0, 0.0)

    def update(self, rates: Vector3, acceleration: Vector3, magnetic: Vector3 | None, seconds: float) -> None:
        """Update the orientation with a measurement. See `MadgwickFilter.update`."""
        if self.do_bias_estimation and self._is_at_rest(rates, acceleration):
            self.bias = _add_scaled(self.bias, _add_scaled(rates, self.bias, -1.0), self.bias_alpha)
        self._last_rates = rates
        rotation_vector = scaled(_add_scaled(rates, self.bias, -1.0), seconds)
        self.orientation = quaternion_multiply(self.orientation, _rotation_from_vector(rotation_vector))
        length = hypot(*acceleration)
        if length >= _MIN_LENGTH:
            up = rotate(self.orientation, _normalize(acceleration))
            gain = self.gain_acc * (_compute_acceleration_weight(length) if self.do_adaptive_gain else 1.0)
            # Rotate the measured up direction to the true one.
            correction = quaternion_inverse(rotation_from_z(up))
            self.orientation = quaternion_multiply(_scale_rotation(correction, gain), self.orientation)
        if magnetic is not None and hypot(*magnetic) > 0.0:
            x, y, _ = rotate(self.orientation, magnetic)
            if hypot(x, y) > 0.0:
                self.orientation = quaternion_multiply(
                    _rotation_from_vector((0.0, 0.0, -self.gain_mag * atan2(y, x))), self.orientation
                )
        self.orientation = normalized(*self.orientation)

    def _is_at_rest(self, rates: Vector3, acceleration: Vector3) -> bool:
        return (
            abs(hypot(*acceleration) - GRAVITY) <= 0.1
            and all(abs(rate - last_rate) <= 0.01 for rate, last_rate in zip(rates, self._last_rates, strict=True))
            and all(abs(now - bias) <= 0.2 for now, bias in zip(rates, self.bias, strict=True))
        )


def _compute_acceleration_weight(length: float) -> float:
    """Return an acceleration's weight: 1 within 10 % of gravity, falling to 0 at 20 %."""
    error = abs(length - GRAVITY) / GRAVITY
    return min(1.0, max(0.0, 2.0 - error / 0.1))


def _rotation_from_vector(rotation_vector: Vector3) -> Quaternion:
    """Return the rotation that a rotation vector in rad describes."""
    angle = hypot(*rotation_vector)
    scale = sin(angle / 2.0) / angle if angle > 0.0 else 0.5
    return rotation_vector[0] * scale, rotation_vector[1] * scale, rotation_vector[2] * scale, cos(angle / 2.0)


def _scale_rotation(rotation: Quaternion, fraction: float) -> Quaternion:
    """Return a rotation about the same axis by a fraction of the angle."""
    x, y, z, w = rotation if rotation[3] >= 0.0 else _scale_quaternion(rotation, -1.0)
    sine = hypot(x, y, z)
    if sine == 0.0:
        return _IDENTITY
    angle = 2.0 * atan2(sine, w) * fraction
    return _rotation_from_vector((x / sine * angle, y / sine * angle, z / sine * angle))


def _normalize(vector: Vector3) -> Vector3:
    return scaled(vector, 1.0 / hypot(*vector))


def _add_scaled(first: Vector3, second: Vector3, factor: float) -> Vector3:
    return first[0] + second[0] * factor, first[1] + second[1] * factor, first[2] + second[2] * factor


def _scale_quaternion(quaternion: Quaternion, factor: float) -> Quaternion:
    x, y, z, w = quaternion
    return x * factor, y * factor, z * factor, w * factor


def _add_scaled_quaternion(first: Quaternion, second: Quaternion, factor: float) -> Quaternion:
    return (
        first[0] + second[0] * factor,
        first[1] + second[1] * factor,
        first[2] + second[2] * factor,
        first[3] + second[3] * factor,
    )
