"""Limits of velocity, acceleration and jerk."""

from __future__ import annotations

from math import inf

Bounds = tuple[float, float]
"""The least and the greatest value."""

UNBOUNDED: Bounds = (-inf, inf)


class SpeedLimiter:
    """Limits a velocity: its second derivative first, then its first, then itself.

    Args:
        velocity: in m/s or rad/s.
        acceleration: while the velocity is positive, in m/s2 or rad/s2: braking, and speeding up.
        jerk: in m/s3 or rad/s3.
        reverse_acceleration: while it is negative: speeding up backward, and braking; as `acceleration` where not
            given. From standstill each direction has the bound of speeding up that way.
        brakes_freely: whether the jerk is bounded only while the velocity is brought further the way it changes, as in
            control_toolbox's RateLimiter.

    Attributes:
        speed: the velocity now.

    Source: gz-math's SpeedLimiter, diff_drive_controller's and control_toolbox's RateLimiter: one arithmetic with what
    differs as arguments.
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
        """Restart at zero."""
        self.speed = self._before = 0.0

    def follow(self, wanted: float, seconds: float) -> float:
        """The limited velocity, so many seconds after the last one."""
        speed = self.speed
        change, changed = wanted - speed, speed - self._before
        if not self._brakes_freely or (change - changed) * change > 0.0:
            change = changed + _within(self._jerk, change - changed, seconds * seconds)
        direction = (speed > 0.0) - (speed < 0.0)
        change = _within(self._accelerations[direction + 1], change, seconds)
        self.speed, self._before = _within(self._velocity, speed + change), speed
        return self.speed


def _within(bounds: Bounds, value: float, factor: float = 1.0) -> float:
    return min(max(value, bounds[0] * factor), bounds[1] * factor)
