"""Smooth velocities within limits of speed and acceleration, as in nav2."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class AxisLimits:
    """The limits of one axis, in m/s and m/s2, or rad/s and rad/s2.

    Attributes:
        min_velocity: the minimum velocity, 0 or less.
        max_velocity: the maximum velocity, 0 or more.
        acceleration: the maximum acceleration, 0 or more.
        deceleration: the negated maximum deceleration, 0 or less.
        deadband: velocities with a smaller magnitude become 0.
    """

    min_velocity: float
    max_velocity: float
    acceleration: float
    deceleration: float
    deadband: float = 0.0

    def clamp(self, velocity: float) -> float:
        """Return a velocity clamped to the minimum and maximum velocity."""
        return min(max(velocity, self.min_velocity), self.max_velocity)

    def compute_max_change(self, current: float, requested: float, seconds: float) -> float:
        """Return the maximum magnitude of the velocity change in a cycle of some seconds.

        The acceleration limit applies if the speed increases or stays equal in the same direction; otherwise the
        deceleration limit applies.
        """
        is_acceleration = abs(requested) >= abs(current) and current * requested >= 0.0
        return (self.acceleration if is_acceleration else -self.deceleration) * seconds

    def apply_deadband(self, velocity: float) -> float:
        """Return a velocity, or 0 if it is within the deadband."""
        return 0.0 if abs(velocity) < self.deadband else velocity


def smooth_velocities(
    limits: Sequence[AxisLimits],
    current: Sequence[float],
    requested: Sequence[float],
    seconds: float,
    *,
    keep_direction: bool,
) -> list[float]:
    """Return the velocities of the next cycle, before deadbands are applied.

    Args:
        limits: the limits of each axis.
        current: the current velocities.
        requested: the requested velocities.
        seconds: the period of the cycle.
        keep_direction: whether all changes are reduced by the factor of the most limited axis.
    """
    targets = [axis.clamp(velocity) for axis, velocity in zip(limits, requested, strict=True)]
    differences = [target - velocity for target, velocity in zip(targets, current, strict=True)]
    max_changes = [
        axis.compute_max_change(velocity, target, seconds)
        for axis, velocity, target in zip(limits, current, targets, strict=True)
    ]
    factor = 1.0
    if keep_direction:
        # An axis with a limit of 0 is ignored; otherwise no axis could change.
        factor = min(
            [
                1.0,
                *(
                    max_change / abs(difference)
                    for difference, max_change in zip(differences, max_changes, strict=True)
                    if abs(difference) > max_change > 0.0
                ),
            ]
        )
    return [
        velocity + min(max(factor * difference, -max_change), max_change)
        for velocity, difference, max_change in zip(current, differences, max_changes, strict=True)
    ]
