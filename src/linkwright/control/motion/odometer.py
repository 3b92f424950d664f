"""Odometry of a robot from its velocities."""

from __future__ import annotations

from collections import deque

from linkwright.kinematics.planar import PlanarPose

Velocity = tuple[float, float, float]
"""Forward and to the left in m/s, around z in rad/s."""

_STANDING: Velocity = (0.0, 0.0, 0.0)


class Odometer:
    """An integrator of velocities to a pose, which also smooths the velocities.

    Args:
        window: the number of velocities in the rolling mean; at least 1.

    Attributes:
        place: the robot's pose relative to its start.
        velocity: the robot's smoothed velocity.

    Source: the odometry of ros2_controllers (exact arcs, rolling means).
    """

    def __init__(self, window: int = 1) -> None:
        self._last: deque[Velocity] = deque(maxlen=window)
        self.reset()

    def reset(self, x: float = 0.0, y: float = 0.0, yaw: float = 0.0) -> None:
        """Set the pose, in m and rad, and the velocity to zero."""
        self.place = PlanarPose(x, y, yaw)
        self.reset_velocity()

    def reset_velocity(self) -> None:
        """Set the velocity to zero, and keep the pose."""
        self._last.clear()
        self.velocity = _STANDING

    def measure(self, velocity: Velocity, seconds: float) -> None:
        """Integrate a measured velocity over a duration, and update the rolling mean."""
        self._go(velocity, seconds)
        last = self._last
        last.append(velocity)
        count = len(last)
        forward, sideways, angular = map(sum, zip(*last, strict=True))
        self.velocity = forward / count, sideways / count, angular / count

    def add_commanded(self, velocity: Velocity, seconds: float) -> None:
        """Integrate a commanded velocity over a duration; it becomes the velocity without smoothing."""
        self._go(velocity, seconds)
        self.velocity = velocity

    def _go(self, velocity: Velocity, seconds: float) -> None:
        forward, sideways, angular = velocity
        self.place.follow_arc(forward * seconds, sideways * seconds, angular * seconds)
