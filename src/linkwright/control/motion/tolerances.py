"""Tolerances of joints along a trajectory and at its end.

Source: joint_trajectory_controller of ros2_controllers, and control_msgs' ``JointTolerance``.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

UNSPECIFIED, NO_TOLERANCE = 0.0, -1.0
"""Special values of a goal's tolerance: keep the controller's tolerance, or allow any error."""


@dataclass(frozen=True, slots=True)
class StateTolerance:
    """The maximum errors of a joint, where 0 allows any error.

    Attributes:
        position: the maximum position error in rad or m.
        velocity: the maximum velocity error in rad/s or m/s.
        acceleration: the maximum acceleration error in rad/s² or m/s².
    """

    position: float = 0.0
    velocity: float = 0.0
    acceleration: float = 0.0

    def is_within(self, position: float, velocity: float, acceleration: float) -> bool:
        """Return whether all three errors are within the tolerance."""
        return (
            not (self.position > 0.0 and abs(position) > self.position)
            and not (self.velocity > 0.0 and abs(velocity) > self.velocity)
            and not (self.acceleration > 0.0 and abs(acceleration) > self.acceleration)
        )

    def find_violations(
        self, position: float, velocity: float, acceleration: float
    ) -> Iterator[tuple[str, float, float]]:
        """Yield the errors outside the tolerance, as name, error and tolerance."""
        errors = (
            ("Position", position, self.position),
            ("Velocity", velocity, self.velocity),
            ("Acceleration", acceleration, self.acceleration),
        )
        for name, error, limit in errors:
            if limit > 0.0 and abs(error) > limit:
                yield name, error, limit

    def override(self, position: float, velocity: float, acceleration: float) -> StateTolerance:
        """Return a copy with the tolerances of a goal: 0 keeps a tolerance, and -1 removes it.

        Raises:
            ValueError: a value is negative and not -1.
        """
        return StateTolerance(
            resolve_tolerance(self.position, position),
            resolve_tolerance(self.velocity, velocity),
            resolve_tolerance(self.acceleration, acceleration),
        )


@dataclass(frozen=True, slots=True)
class Tolerances:
    """The tolerances of a trajectory.

    Attributes:
        path: the tolerances of each joint along the trajectory.
        goal: the tolerances of each joint at the end.
        goal_time_s: the maximum time from the end of the trajectory until the goal is reached, in seconds; 0 for no
            limit.
    """

    path: tuple[StateTolerance, ...]
    goal: tuple[StateTolerance, ...]
    goal_time_s: float = 0.0

    def with_path(self, joint: int, tolerance: StateTolerance) -> Tolerances:
        """Return a copy with another path tolerance for the joint at index `joint`."""
        return replace(self, path=(*self.path[:joint], tolerance, *self.path[joint + 1 :]))

    def with_goal(self, joint: int, tolerance: StateTolerance) -> Tolerances:
        """Return a copy with another goal tolerance for the joint at index `joint`."""
        return replace(self, goal=(*self.goal[:joint], tolerance, *self.goal[joint + 1 :]))


def resolve_tolerance(default: float, goal_value: float) -> float:
    """Return the tolerance for a goal, or the default if the goal does not specify one.

    Raises:
        ValueError: the goal's value is negative and not -1.
    """
    if goal_value > 0.0:
        return goal_value
    if goal_value == UNSPECIFIED:
        return default
    if goal_value == NO_TOLERANCE:
        return 0.0
    raise ValueError(goal_value)
