"""A control law that drives to a pose on a smooth curve.

Source: Park and Kuipers, "A Smooth Control Law for Graceful Motion of Differential Wheeled Mobile Robots in 2D
Environment", ICRA 2011; the names of the settings are those of nav2's graceful controller.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan, atan2, hypot, pi, sin


@dataclass(frozen=True, slots=True, kw_only=True)
class SmoothControl:
    """The settings of the control law.

    Attributes:
        k_phi: how fast the heading becomes that of the curve; larger values turn to the target earlier.
        k_delta: how fast the error of the heading decreases.
        beta: how much a curve slows the robot down.
        lambda_: how sharply the speed falls with the curvature.
        v_linear_min: the lowest speed, in m/s.
        v_linear_max: the highest speed, in m/s.
        v_angular_max: the highest rate of rotation, in rad/s.
        slowdown_radius: the distance in meters from the target at which the robot slows down.
    """

    k_phi: float = 3.0
    k_delta: float = 2.0
    beta: float = 0.4
    lambda_: float = 2.0
    v_linear_min: float = 0.1
    v_linear_max: float = 0.25
    v_angular_max: float = 0.75
    slowdown_radius: float = 0.25

    def find_velocity(self, target: tuple[float, float, float], *, backward: bool = False) -> tuple[float, float]:
        """Return the linear and the angular velocity towards a target in the frame of the robot.

        Args:
            target: x and y in meters, and the yaw at the target.
            backward: whether to drive backward.
        """
        x, y, yaw = target
        distance = max(hypot(x, y), 1e-6)
        line_of_sight = atan2(-y, x) + (pi if backward else 0.0)
        phi, delta = _wrap(yaw + line_of_sight), _wrap(line_of_sight)
        proportional = self.k_delta * (delta - atan(-self.k_phi * phi))
        feedback = (1.0 + self.k_phi / (1.0 + (self.k_phi * phi) ** 2)) * sin(delta)
        curvature = -(proportional + feedback) / distance
        if backward:
            curvature = -curvature
        speed = self.v_linear_max / (1.0 + self.beta * abs(curvature) ** self.lambda_)
        speed = min(self.v_linear_max * distance / self.slowdown_radius, speed)
        speed = min(max(speed, self.v_linear_min), self.v_linear_max)
        if backward:
            speed = -speed
        rotation = min(max(curvature * speed, -self.v_angular_max), self.v_angular_max)
        return (rotation / curvature if curvature else speed), rotation


def _wrap(angle: float) -> float:
    return (angle + pi) % (2 * pi) - pi
