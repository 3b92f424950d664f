"""Poses in a plane, and their change by motions."""

from __future__ import annotations

from math import cos, sin

from linkwright.geometry.single import Transform
from linkwright.loading.lean_dataclasses import dataclass

_MIN_ARC_ANGLE = 1e-6
"""The angle in rad below which an arc counts as a straight line, because division by it would lose digits."""


@dataclass(slots=True)
class PlanarPose:
    """A pose in a plane: a position in m and a heading in rad."""

    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0

    def advance(self, forward: float, sideways: float, turn: float) -> None:
        """Move straight, at the middle heading of a rotation by an angle in rad.

        `forward` and `sideways` (to the left) are distances in m. Source: the second-order Runge-Kutta method, as in
        gazebo_ros_diff_drive.
        """
        middle_yaw = self.yaw + turn / 2.0
        self.x += forward * cos(middle_yaw) - sideways * sin(middle_yaw)
        self.y += forward * sin(middle_yaw) + sideways * cos(middle_yaw)
        self.yaw += turn

    def follow_arc(self, forward: float, sideways: float, turn: float) -> None:
        """Move forward and to the left, by distances in m, while rotating by an angle in rad.

        The path is a circular arc, without integration error. Source: diff_drive_controller, which does so only for
        forward motion.
        """
        if abs(turn) < _MIN_ARC_ANGLE:
            self.advance(forward, sideways, turn)
            return
        yaw = self.yaw + turn
        along, across = (sin(yaw) - sin(self.yaw)) / turn, (cos(yaw) - cos(self.yaw)) / turn
        self.x += forward * along + sideways * across
        self.y += sideways * along - forward * across
        self.yaw = yaw

    @property
    def transform(self) -> Transform:
        """The pose in space, at height 0."""
        half = self.yaw / 2.0
        return self.x, self.y, 0.0, 0.0, 0.0, sin(half), cos(half)
