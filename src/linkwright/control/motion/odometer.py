"""Odometry of a robot from its velocities."""

from __future__ import annotations

from collections import deque

from linkwright.kinematics.planar import PlanarPose

Velocity = tuple[float, float, float]
"""The velocities forward and to the left in m/s, and about z in rad/s."""

_AT_REST: Velocity = (0.0, 0.0, 0.0)


class Odometer:
    """An integrator of velocities to a pose, with smoothing of the velocities.

    Args:
        window: the number of velocities in the rolling mean; at least 1.

    Attributes:
        pose: the robot's pose relative to its start.
        velocity: the robot's smoothed velocity.

    Source: the odometry of ros2_controllers (exact arcs, rolling means).
    """

    def __init__(self, window: int = 1) -> None:
        self._recent_velocities: deque[Velocity] = deque(maxlen=window)
        self.reset()

    def reset(self, x: float = 0.0, y: float = 0.0, yaw: float = 0.0) -> None:
        """Set the pose, in m and rad, and the velocity to zero."""
        self.pose = PlanarPose(x, y, yaw)
        self.reset_velocity()

    def reset_velocity(self) -> None:
        """Set the velocity to zero, and keep the pose."""
        self._recent_velocities.clear()
        self.velocity = _AT_REST

    def measure(self, velocity: Velocity, seconds: float) -> None:
        """Integrate a measured velocity over a duration, and update the rolling mean."""
        self._integrate(velocity, seconds)
        recent = self._recent_velocities
        recent.append(velocity)
        count = len(recent)
        forward, sideways, angular = map(sum, zip(*recent, strict=True))
        self.velocity = forward / count, sideways / count, angular / count

    def integrate_command(self, velocity: Velocity, seconds: float) -> None:
        """Integrate a commanded velocity over a duration.

        The odometer's velocity becomes the commanded velocity, without smoothing.
        """
        self._integrate(velocity, seconds)
        self.velocity = velocity

    def _integrate(self, velocity: Velocity, seconds: float) -> None:
        forward, sideways, angular = velocity
        self.pose.follow_arc(forward * seconds, sideways * seconds, angular * seconds)
