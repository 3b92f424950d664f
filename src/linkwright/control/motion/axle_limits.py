"""Limits of a driven and steered wheel: velocity, steering angle and their derivatives.

The limits apply in both directions.

Source: the limiters of tricycle_controller. Deliberate differences: a minimum never moves a wheel that is at rest, and
the bound of a second difference is not doubled.
"""

from __future__ import annotations

from math import copysign, inf

from linkwright.kinematics.limits import UNBOUNDED, Bounds

UNLIMITED: Bounds = (0.0, inf)
"""The bounds of a magnitude without a limit."""


class TractionLimiter:
    """A limiter of a wheel's speed and its derivatives.

    Args:
        velocity: the bounds of the speed's magnitude, in rad/s.
        acceleration: the bounds of the rate at which the speed increases, in rad/s2.
        deceleration: the bounds of the rate at which the speed decreases, in rad/s2.
        jerk: the bounds of the rate at which the acceleration changes, in rad/s3.

    Attributes:
        speed: the current speed, in rad/s.
    """

    def __init__(
        self,
        velocity: Bounds = UNLIMITED,
        acceleration: Bounds = UNLIMITED,
        deceleration: Bounds = UNLIMITED,
        jerk: Bounds = UNLIMITED,
    ) -> None:
        self._velocity = velocity
        self._acceleration = acceleration
        self._deceleration = deceleration
        self._jerk = jerk
        self.reset()

    def reset(self) -> None:
        """Reset the speed and the acceleration to zero."""
        self.speed = self._previous_speed = 0.0

    def approach(self, target: float, duration_s: float) -> float:
        """Return the next speed towards a target, both in rad/s, `duration_s` after the last call."""
        speed = self.speed
        target = _limit_second_difference(speed, self._previous_speed, target, self._jerk, duration_s)
        bounds = self._acceleration if abs(target) >= abs(speed) else self._deceleration
        new_speed = speed + _limit_magnitude(bounds, target - speed, duration_s)
        self.speed, self._previous_speed = _limit_magnitude(self._velocity, new_speed), speed
        return self.speed


class SteeringLimiter:
    """A limiter of a steering angle and its derivatives.

    Args:
        position: the minimum and maximum angle, in rad.
        velocity: the bounds of the rate at which the angle changes, in rad/s.
        acceleration: the bounds of the rate at which that velocity changes, in rad/s2.

    Attributes:
        angle: the current angle, in rad.
    """

    def __init__(
        self, position: Bounds = UNBOUNDED, velocity: Bounds = UNLIMITED, acceleration: Bounds = UNLIMITED
    ) -> None:
        self._position = position
        self._velocity = velocity
        self._acceleration = acceleration
        self.reset()

    def reset(self, angle: float = 0.0) -> None:
        """Reset the steering angle to a value in rad, and its velocity to zero."""
        self.angle = self._previous_angle = angle

    def approach(self, target: float, duration_s: float) -> float:
        """Return the next angle towards a target, both in rad, `duration_s` after the last call."""
        angle = self.angle
        target = _limit_second_difference(angle, self._previous_angle, target, self._acceleration, duration_s)
        new_angle = angle + _limit_magnitude(self._velocity, target - angle, duration_s)
        self.angle, self._previous_angle = min(max(new_angle, self._position[0]), self._position[1]), angle
        return self.angle


def _limit_second_difference(
    current: float, previous: float, target: float, bounds: Bounds, duration_s: float
) -> float:
    """Return the target, limited so that the second difference is within bounds.

    `current` and `previous` are the last two values; `duration_s` is the time between values.
    """
    extrapolated = current + current - previous
    return extrapolated + _limit_magnitude(bounds, target - extrapolated, duration_s * duration_s)


def _limit_magnitude(bounds: Bounds, value: float, factor: float = 1.0) -> float:
    """Return a value with its magnitude limited to bounds times a factor.

    A value of 0 stays 0.
    """
    if value == 0.0:
        return value
    return copysign(min(max(abs(value), bounds[0] * factor), bounds[1] * factor), value)
