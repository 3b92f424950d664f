"""Smoothing velocities by limits of speed and acceleration, all axes together, as nav2's velocity smoother."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Limits:
    """The limits of one axis, in m/s and m/s2, or rad/s and rad/s2.

    Attributes:
        least: the lowest velocity, 0 or less.
        most: the highest velocity, 0 or more.
        acceleration: by how much it may get faster in a second, 0 or more.
        deceleration: by how much it may get slower in a second, 0 or less.
        deadband: slower velocities than this are 0.
    """

    least: float
    most: float
    acceleration: float
    deceleration: float
    deadband: float = 0.0

    def clamped(self, velocity: float) -> float:
        """The velocity within the limits of speed."""
        return min(max(velocity, self.least), self.most)

    def change(self, now: float, wanted: float, seconds: float) -> float:
        """The change of the velocity in a cycle, towards the requested one.

        It accelerates where it gets faster in the direction that it has, else it decelerates.
        """
        faster = abs(wanted) >= abs(now) and now * wanted >= 0.0
        return (self.acceleration if faster else -self.deceleration) * seconds

    def quiet(self, velocity: float) -> float:
        """The velocity, or 0 within the deadband."""
        return 0.0 if abs(velocity) < self.deadband else velocity


def smoothed(
    limits: Sequence[Limits], now: Sequence[float], wanted: Sequence[float], seconds: float, *, scaled: bool
) -> list[float]:
    """The velocities of the next cycle, before deadbands.

    Args:
        limits: of each axis.
        now: the velocities of the moment.
        wanted: the requested velocities.
        seconds: until the next ones.
        scaled: whether all axes are slowed down as much as the one that needs it most, so that the direction stays.
    """
    goals = [axis.clamped(velocity) for axis, velocity in zip(limits, wanted, strict=True)]
    ways = [goal - velocity for goal, velocity in zip(goals, now, strict=True)]
    changes = [axis.change(velocity, goal, seconds) for axis, velocity, goal in zip(limits, now, goals, strict=True)]
    part = 1.0
    if scaled:
        # One that may not change at all would hold back all others.
        part = min([1.0, *(most / abs(way) for way, most in zip(ways, changes, strict=True) if abs(way) > most > 0.0)])
    return [
        velocity + min(max(part * way, -most), most) for velocity, way, most in zip(now, ways, changes, strict=True)
    ]
