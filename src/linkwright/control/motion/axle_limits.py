"""Limits of a driven and steered wheel for velocity, steering angle and their derivatives, in both directions.

Source: the limiters of tricycle_controller. Two things differ: a minimum never makes a wheel move that is at rest, and
the bound of a second difference is not doubled.
"""

from __future__ import annotations

from math import copysign, inf

from linkwright.kinematics.limits import UNBOUNDED, Bounds

ANY: Bounds = (0.0, inf)
"""No bound of a magnitude."""


class TractionLimiter:
    """A limiter of a wheel's speed and its derivatives.

    Args:
        velocity: the bounds of the speed's magnitude, in rad/s.
        acceleration: the bounds of the rate at which the speed increases, in rad/s2.
        deceleration: the bounds of the rate at which the speed decreases, in rad/s2.
        jerk: the bounds of the rate at which the acceleration changes, in rad/s3.

    Attributes:
        speed: the current speed.
    """

    def __init__(
        self, velocity: Bounds = ANY, acceleration: Bounds = ANY, deceleration: Bounds = ANY, jerk: Bounds = ANY
    ) -> None:
        self._velocity = velocity
        self._acceleration = acceleration
        self._deceleration = deceleration
        self._jerk = jerk
        self.restart()

    def restart(self) -> None:
        """Reset the speed and the acceleration to zero."""
        self.speed = self._before = 0.0

    def follow(self, wanted: float, seconds: float) -> float:
        """Return the next speed towards a wanted one, `seconds` after the last call."""
        speed = self.speed
        wanted = _limit_second_difference(speed, self._before, wanted, self._jerk, seconds)
        bounds = self._acceleration if abs(wanted) >= abs(speed) else self._deceleration
        reached = speed + _within(bounds, wanted - speed, seconds)
        self.speed, self._before = _within(self._velocity, reached), speed
        return self.speed


class SteeringLimiter:
    """A limiter of a steering angle and its derivatives.

    Args:
        position: the minimum and maximum angle, in rad.
        velocity: the bounds of the rate at which the angle changes, in rad/s.
        acceleration: the bounds of the rate at which that velocity changes, in rad/s2.

    Attributes:
        angle: the current angle.
    """

    def __init__(self, position: Bounds = UNBOUNDED, velocity: Bounds = ANY, acceleration: Bounds = ANY) -> None:
        self._position = position
        self._velocity = velocity
        self._acceleration = acceleration
        self.restart()

    def restart(self, angle: float = 0.0) -> None:
        """Reset the angle to a value, at rest."""
        self.angle = self._before = angle

    def follow(self, wanted: float, seconds: float) -> float:
        """Return the next angle towards a wanted one, `seconds` after the last call."""
        angle = self.angle
        wanted = _limit_second_difference(angle, self._before, wanted, self._acceleration, seconds)
        reached = angle + _within(self._velocity, wanted - angle, seconds)
        self.angle, self._before = min(max(reached, self._position[0]), self._position[1]), angle
        return self.angle


def _limit_second_difference(now: float, before: float, wanted: float, bounds: Bounds, seconds: float) -> float:
    """Return the wanted value, limited so that the second difference is within bounds.

    `now` and `before` are the last two values; `seconds` is the time between values.
    """
    straight = now + now - before
    return straight + _within(bounds, wanted - straight, seconds * seconds)


def _within(bounds: Bounds, value: float, factor: float = 1.0) -> float:
    """Return a value with its magnitude limited to bounds times a factor; 0 stays 0."""
    if value == 0.0:
        return value
    return copysign(min(max(abs(value), bounds[0] * factor), bounds[1] * factor), value)
