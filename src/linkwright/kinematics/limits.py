"""Limits of velocity, acceleration and jerk."""

from __future__ import annotations

from math import inf

Bounds = tuple[float, float]
"""The minimum and the maximum of a value."""

UNBOUNDED: Bounds = (-inf, inf)


class SpeedLimiter:
    """A limiter of a velocity and its first two derivatives.

    The second derivative is limited first, then the first derivative, then the velocity itself.

    Args:
        velocity: the limits in m/s or rad/s.
        acceleration: the limits while the velocity is positive, in m/s2 or rad/s2: for braking, and for speeding up.
        jerk: the limits in m/s3 or rad/s3.
        reverse_acceleration: the limits while the velocity is negative: for speeding up backward, and for braking; by
            default equal to `acceleration`. At standstill, each direction has the limit of speeding up in that
            direction.
        brakes_freely: whether the jerk is limited only while the acceleration grows in the direction of the requested
            change, as in control_toolbox's RateLimiter.

    Attributes:
        speed: the current velocity.

    Source: gz-math's SpeedLimiter, and the RateLimiter of diff_drive_controller and of control_toolbox, which differ
    only in the arguments.
    """

    def __init__(
        self,
        velocity: Bounds = UNBOUNDED,
        acceleration: Bounds = UNBOUNDED,
        jerk: Bounds = UNBOUNDED,
        *,
        reverse_acceleration: Bounds | None = None,
        brakes_freely: bool = False,
    ) -> None:
        reverse = acceleration if reverse_acceleration is None else reverse_acceleration
        self._velocity = velocity
        self._accelerations = (reverse, (reverse[0], acceleration[1]), acceleration)
        self._jerk = jerk
        self._brakes_freely = brakes_freely
        self.restart()

    def restart(self) -> None:
        """Reset the velocity and the acceleration to zero."""
        self.speed = self._previous_speed = 0.0

    def approach(self, target: float, seconds: float) -> float:
        """Return the next velocity on the way to a target, `seconds` after the last call."""
        speed = self.speed
        change, last_change = target - speed, speed - self._previous_speed
        if not self._brakes_freely or (change - last_change) * change > 0.0:
            change = last_change + _clamp(self._jerk, change - last_change, seconds * seconds)
        direction = (speed > 0.0) - (speed < 0.0)
        change = _clamp(self._accelerations[direction + 1], change, seconds)
        self.speed, self._previous_speed = _clamp(self._velocity, speed + change), speed
        return self.speed


def _clamp(bounds: Bounds, value: float, factor: float = 1.0) -> float:
    return min(max(value, bounds[0] * factor), bounds[1] * factor)
