"""Kinematics of drives: from wheel rotation to the robot's motion, and the inverse.

The robot moves forward (x) and to the left (y), and rotates counterclockwise about z. A function of velocities in m/s
and rad/s also works with distances in m and angles in rad, if the steering angles do not change during the motion.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import atan, atan2, copysign, cos, hypot, pi, sin, tan

from linkwright.loading.lean_dataclasses import dataclass

_QUARTER_TURN = pi / 2.0


@dataclass(frozen=True, slots=True)
class DifferentialDrive:
    """A drive of two wheels, or two sides of wheels, on one axle.

    Attributes:
        separation: the distance between the wheels in m.
        left_radius, right_radius: the radii of the wheels in m.
    """

    separation: float
    left_radius: float
    right_radius: float

    def wheel_speeds(self, forward: float, angular: float) -> tuple[float, float]:
        """Return the angular velocities of the left and the right wheel in rad/s."""
        rotation_speed = angular * self.separation / 2.0
        return (forward - rotation_speed) / self.left_radius, (forward + rotation_speed) / self.right_radius

    def motion(self, left_speed: float, right_speed: float) -> tuple[float, float]:
        """Return the forward (m/s) and angular velocity (rad/s) for two wheel speeds in rad/s."""
        left_speed, right_speed = left_speed * self.left_radius, right_speed * self.right_radius
        return (left_speed + right_speed) / 2.0, (right_speed - left_speed) / self.separation


@dataclass(frozen=True, slots=True)
class MecanumDrive:
    """A drive of four wheels with rollers at 45 degrees that form an X, seen from above.

    Attributes:
        arm: half the sum of the wheelbase and the track, in m.
        radius: the radius of the wheels in m.
    """

    arm: float
    radius: float

    def wheel_speeds(self, forward: float, sideways: float, angular: float) -> tuple[float, float, float, float]:
        """Return the angular velocities of the wheels in rad/s.

        The order is front left, front right, rear left, rear right.
        """
        rotation_speed = angular * self.arm
        return (
            (forward - sideways - rotation_speed) / self.radius,
            (forward + sideways + rotation_speed) / self.radius,
            (forward + sideways - rotation_speed) / self.radius,
            (forward - sideways + rotation_speed) / self.radius,
        )

    def motion(
        self, front_left: float, front_right: float, rear_left: float, rear_right: float
    ) -> tuple[float, float, float]:
        """Return the velocities forward, to the left (m/s) and about z (rad/s) for wheel speeds.

        If no motion without sliding has these speeds, the result is the nearest motion (least squares).
        """
        quarter = self.radius / 4.0
        return (
            (front_left + front_right + rear_left + rear_right) * quarter,
            (-front_left + front_right + rear_left - rear_right) * quarter,
            (-front_left + front_right - rear_left + rear_right) * quarter / self.arm,
        )


@dataclass(frozen=True, slots=True)
class OmniDrive:
    """A drive of three or more omni wheels at equal angles on a circle.

    Attributes:
        count: the number of wheels, at least 3.
        robot_radius: the distance between the center and the wheels in m.
        wheel_radius: the radius of the wheels in m.
        offset: the angle of the first wheel from x in rad. The others follow counterclockwise.

    Source: omni_wheel_drive_controller of ros2_controllers.
    """

    count: int
    robot_radius: float
    wheel_radius: float
    offset: float = 0.0

    def wheel_speeds(self, forward: float, sideways: float, angular: float) -> list[float]:
        """Return the angular velocities of the wheels in rad/s."""
        return [
            (sin(angle) * forward - cos(angle) * sideways - self.robot_radius * angular) / self.wheel_radius
            for angle in self._list_angles()
        ]

    def motion(self, speeds: Sequence[float]) -> tuple[float, float, float]:
        """Return the velocities forward, to the left (m/s) and about z (rad/s) for wheel speeds.

        If no motion without sliding has these speeds, the result is the nearest motion (least squares). With equal
        angles between the wheels, the columns of the equations are orthogonal, so that each velocity is a sum.
        """
        rims = [speed * self.wheel_radius for speed in speeds]
        pairs = list(zip(self._list_angles(), rims, strict=True))
        half = self.count / 2.0
        return (
            sum(sin(angle) * rim for angle, rim in pairs) / half,
            -sum(cos(angle) * rim for angle, rim in pairs) / half,
            -sum(rims) / self.count / self.robot_radius,
        )

    def _list_angles(self) -> list[float]:
        return [self.offset + 2.0 * pi * index / self.count for index in range(self.count)]


@dataclass(frozen=True, slots=True)
class CarDrive:
    """A drive with a driven axle and a steered axle.

    Its frame is in the middle of the driven axle.

    Attributes:
        wheelbase: the distance between the axles in m, positive.
        traction_track: the distance between the driven wheels in m; 0 for one wheel.
        steering_track: the distance between the steered wheels in m; 0 for one wheel.
        radius: the radius of the driven wheels in m.
    """

    wheelbase: float
    traction_track: float
    steering_track: float
    radius: float

    def steering_angle(self, forward: float, angular: float) -> float:
        """Return the angle, in rad, of a virtual wheel in the middle of the steered axle.

        The angle is 0 at rest.
        """
        return 0.0 if forward == 0.0 else atan(angular * self.wheelbase / forward)

    def steering_angles(self, angle: float) -> tuple[float, float]:
        """Return the angles of the left and right steered wheel in rad.

        `angle` is the angle of a virtual wheel in the middle, in rad.
        """
        slope = tan(angle)
        return ackermann_angles(slope, self.steering_track * slope / self.wheelbase)

    def middle_angle(self, left_angle: float, right_angle: float) -> float:
        """Return the angle of a virtual wheel in the middle, in rad, for the angles of both wheels.

        The result is the mean of the angles that correspond to the left and to the right wheel.
        """
        half_track = self.steering_track / 2.0
        angle_from_left = atan2(
            self.wheelbase * sin(left_angle), self.wheelbase * cos(left_angle) + half_track * sin(left_angle)
        )
        angle_from_right = atan2(
            self.wheelbase * sin(right_angle), self.wheelbase * cos(right_angle) - half_track * sin(right_angle)
        )
        return (angle_from_left + angle_from_right) / 2.0

    def wheel_speeds(self, forward: float, angle: float) -> tuple[float, float]:
        """Return the angular velocities of the left and right driven wheel in rad/s.

        `angle` is the steering angle in rad.
        """
        speed, difference = forward / self.radius, self._wheel_speed_difference(angle)
        return speed * (1.0 - difference), speed * (1.0 + difference)

    def motion(self, left_speed: float, right_speed: float, angle: float) -> tuple[float, float]:
        """Return the forward (m/s) and angular velocity (rad/s) for two wheel speeds in rad/s.

        `angle` is the steering angle in rad. The forward velocity is the mean of the values for both wheels.
        """
        difference = self._wheel_speed_difference(angle)
        forward = (left_speed / (1.0 - difference) + right_speed / (1.0 + difference)) * self.radius / 2.0
        return forward, forward * tan(angle) / self.wheelbase

    def _wheel_speed_difference(self, angle: float) -> float:
        """Return the fraction by which the right wheel is faster, and the left one slower."""
        return self.traction_track / 2.0 * tan(angle) / self.wheelbase


def ackermann_angles(slope: float, track: float) -> tuple[float, float]:
    """Return the angles in rad at which both steered wheels roll about a common point.

    Args:
        slope: the tangent of the angle of a virtual wheel in the middle; positive to the left.
        track: the distance between the wheels, divided by the radius of the circle on which the middle of the other
            axle moves.
    """
    return atan2(slope, 1.0 - track / 2.0), atan2(slope, 1.0 + track / 2.0)


@dataclass(frozen=True, slots=True)
class TricycleDrive:
    """A drive with a driven and steered front wheel and two passive rear wheels.

    The robot's frame is in the middle of the rear axle.

    Attributes:
        wheelbase: the distance from the front wheel to the rear axle in m.
        radius: the radius of the front wheel in m.
    """

    wheelbase: float
    radius: float

    def wheel_command(self, forward: float, angular: float) -> tuple[float, float]:
        """Return the angular velocity of the wheel in rad/s, and its steering angle in rad.

        To rotate in place, the angle is a right angle.
        """
        lateral_speed = angular * self.wheelbase
        wheel_speed = hypot(forward, lateral_speed)
        if forward == 0.0:
            return wheel_speed / self.radius, copysign(_QUARTER_TURN, angular) if angular else 0.0
        return copysign(wheel_speed, forward) / self.radius, atan(lateral_speed / forward)

    def motion(self, speed: float, angle: float) -> tuple[float, float]:
        """Return the forward velocity in m/s and the angular velocity in rad/s.

        Args:
            speed: the angular velocity of the wheel, in rad/s.
            angle: the steering angle, in rad.
        """
        wheel_speed = speed * self.radius
        return wheel_speed * cos(angle), wheel_speed * sin(angle) / self.wheelbase
