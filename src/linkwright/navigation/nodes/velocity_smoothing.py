"""Smoothing of velocities by limits of speed and acceleration, as in nav2's velocity smoother."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Limits:
    """The limits of one axis, in m/s and m/s2, or rad/s and rad/s2.

    Attributes:
        least: the minimum velocity, 0 or less.
        most: the maximum velocity, 0 or more.
        acceleration: the maximum acceleration, 0 or more.
        deceleration: the negated maximum deceleration, 0 or less.
        deadband: velocities with a smaller magnitude become 0.
    """

    least: float
    most: float
    acceleration: float
    deceleration: float
    deadband: float = 0.0

    def clamped(self, velocity: float) -> float:
        """Return a velocity clamped to the minimum and maximum velocity."""
        return min(max(velocity, self.least), self.most)

    def change(self, now: float, wanted: float, seconds: float) -> float:
        """Return the maximum magnitude of the velocity change in a cycle of some seconds.

        The acceleration limit applies when the speed increases without changing direction, otherwise the deceleration
        limit.
        """
        faster = abs(wanted) >= abs(now) and now * wanted >= 0.0
        return (self.acceleration if faster else -self.deceleration) * seconds

    def apply_deadband(self, velocity: float) -> float:
        """Return a velocity, or 0 if it is within the deadband."""
        return 0.0 if abs(velocity) < self.deadband else velocity


def smooth_velocities(
    limits: Sequence[Limits], now: Sequence[float], wanted: Sequence[float], seconds: float, *, scaled: bool
) -> list[float]:
    """Return the velocities of the next cycle, before deadbands are applied.

    Args:
        limits: the limits of each axis.
        now: the current velocities.
        wanted: the requested velocities.
        seconds: the period of the cycle.
        scaled: whether all changes are reduced by the factor of the most limited axis, to keep the direction.
    """
    goals = [axis.clamped(velocity) for axis, velocity in zip(limits, wanted, strict=True)]
    ways = [goal - velocity for goal, velocity in zip(goals, now, strict=True)]
    changes = [axis.change(velocity, goal, seconds) for axis, velocity, goal in zip(limits, now, goals, strict=True)]
    part = 1.0
    if scaled:
        # Ignore an axis whose velocity may not change; otherwise no axis could change.
        part = min([1.0, *(most / abs(way) for way, most in zip(ways, changes, strict=True) if abs(way) > most > 0.0)])
    return [
        velocity + min(max(part * way, -most), most) for velocity, way, most in zip(now, ways, changes, strict=True)
    ]
