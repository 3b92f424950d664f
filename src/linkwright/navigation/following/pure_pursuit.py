"""Regulated pure pursuit, a path follower.

The robot follows an arc to a point on the path ahead, and slows down in curves and near obstacles.

Source: Macenski et al., "Regulated Pure Pursuit for Robot Path Tracking" (2023), and the parameters of
nav2_regulated_pure_pursuit_controller.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, copysign, hypot, log, sqrt

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.costmaps.costmap import FREE, INSCRIBED, LETHAL, UNKNOWN, Costmap
from linkwright.navigation.costmaps.footprints import Footprint, compute_radii
from linkwright.navigation.following.follower import (
    ControlInput,
    Follower,
    FollowingError,
    Pose,
    Velocity,
    apply_speed_limit,
    compute_distances_along,
    predict_poses,
    to_robot_frame,
    wrap_angle,
)


@dataclass(frozen=True, kw_only=True)
class PurePursuitParameters:
    """Parameters of `RegulatedPurePursuit`, with nav2's names and defaults.

    Units are meters, seconds and radians.
    """

    desired_linear_vel: float = 0.5
    lookahead_dist: float = 0.6
    min_lookahead_dist: float = 0.3
    max_lookahead_dist: float = 0.9
    lookahead_time: float = 1.5
    use_velocity_scaled_lookahead_dist: bool = False
    min_approach_linear_velocity: float = 0.05
    approach_velocity_scaling_dist: float = 0.6
    use_collision_detection: bool = True
    max_allowed_time_to_collision_up_to_carrot: float = 1.0
    use_regulated_linear_velocity_scaling: bool = True
    regulated_linear_scaling_min_radius: float = 0.9
    regulated_linear_scaling_min_speed: float = 0.25
    use_cost_regulated_linear_velocity_scaling: bool = True
    cost_scaling_dist: float = 0.6
    cost_scaling_gain: float = 1.0
    inflation_cost_scaling_factor: float = 3.0
    use_fixed_curvature_lookahead: bool = False
    curvature_lookahead_dist: float = 0.6
    use_rotate_to_heading: bool = True
    rotate_to_heading_angular_vel: float = 1.8
    rotate_to_heading_min_angle: float = 0.785
    max_angular_accel: float = 3.2
    allow_reversing: bool = False


class RegulatedPurePursuit(Follower):
    """A path follower that uses regulated pure pursuit."""

    def __init__(self, parameters: PurePursuitParameters | None = None) -> None:
        self.parameters = parameters or PurePursuitParameters()
        self._max_speed = self.parameters.desired_linear_vel

    def limit_speed(self, speed: float, *, is_percentage: bool = False) -> None:
        """Limit the speed as described in `Follower.limit_speed`."""
        self._max_speed = apply_speed_limit(self.parameters.desired_linear_vel, speed, is_percentage=is_percentage)

    def compute_velocity(self, control_input: ControlInput) -> Velocity:
        """Return the velocity for the next cycle, as described in `Follower.compute_velocity`."""
        parameters = self.parameters
        points = to_robot_frame(control_input.pose, control_input.path[:, :2])
        cusp = _find_cusp(points) if parameters.allow_reversing else len(points)
        points = points[: cusp + 1]
        lookahead = self._compute_lookahead_distance(control_input.velocity.x)
        carrot = find_carrot(points, lookahead)
        sign = -1.0 if parameters.allow_reversing and carrot[0] < 0.0 else 1.0
        goal_distance = hypot(*to_robot_frame(control_input.pose, control_input.path[-1, :2]))
        if parameters.use_rotate_to_heading and goal_distance < control_input.xy_tolerance:
            command = self._turn_in_place(wrap_angle(control_input.path[-1, 2] - control_input.pose[2]), control_input)
        elif self._must_turn_in_place(angle := atan2(sign * carrot[1], sign * carrot[0])):
            command = self._turn_in_place(angle, control_input)
        else:
            curvature_point = (
                find_carrot(points, parameters.curvature_lookahead_dist)
                if parameters.use_fixed_curvature_lookahead
                else carrot
            )
            curvature = compute_curvature(curvature_point)
            speed = self._regulate_speed(curvature, points, control_input)
            command = Velocity(sign * speed, 0.0, sign * speed * curvature)
        if parameters.use_collision_detection:
            self._check_for_collision(command, hypot(*carrot), control_input)
        return command

    def _compute_lookahead_distance(self, speed: float) -> float:
        parameters = self.parameters
        if not parameters.use_velocity_scaled_lookahead_dist:
            return parameters.lookahead_dist
        return min(
            max(abs(speed) * parameters.lookahead_time, parameters.min_lookahead_dist), parameters.max_lookahead_dist
        )

    def _must_turn_in_place(self, angle: float) -> bool:
        parameters = self.parameters
        return parameters.use_rotate_to_heading and abs(angle) > parameters.rotate_to_heading_min_angle

    def _turn_in_place(self, angle: float, control_input: ControlInput) -> Velocity:
        parameters = self.parameters
        return Velocity(
            yaw=compute_rotation_speed(
                angle,
                control_input.velocity.yaw,
                control_input.period,
                parameters.rotate_to_heading_angular_vel,
                parameters.max_angular_accel,
            )
        )

    def _regulate_speed(self, curvature: float, points: NDArray[np.float64], control_input: ControlInput) -> float:
        """Return the speed in m/s, reduced in curves, near obstacles and near the path's end."""
        parameters = self.parameters
        speed = self._max_speed
        if parameters.use_regulated_linear_velocity_scaling:
            speed = min(
                speed, limit_speed_in_curve(self._max_speed, curvature, parameters.regulated_linear_scaling_min_radius)
            )
        if parameters.use_cost_regulated_linear_velocity_scaling:
            speed = min(
                speed,
                self._limit_speed_near_obstacles(control_input.pose, control_input.costmap, control_input.footprint),
            )
        speed = min(max(speed, parameters.regulated_linear_scaling_min_speed), self._max_speed)
        remaining_distance = float(compute_distances_along(points)[-1])
        if (
            parameters.approach_velocity_scaling_dist > 0.0
            and remaining_distance < parameters.approach_velocity_scaling_dist
        ):
            approach_speed = speed * remaining_distance / parameters.approach_velocity_scaling_dist
            speed = min(speed, max(approach_speed, parameters.min_approach_linear_velocity))
        return speed

    def _limit_speed_near_obstacles(self, pose: Pose, costmap: Costmap, footprint: Footprint) -> float:
        """Return the speed limit at a pose, in m/s.

        The distance from obstacles is derived from the inflated cost. Beyond `cost_scaling_dist`, the limit is the
        maximum speed.
        """
        parameters = self.parameters
        cost = int(costmap.cost_at(np.array(pose[:2])))
        if cost in (FREE, UNKNOWN):
            return self._max_speed
        inscribed, _ = compute_radii(footprint)
        distance = (
            inscribed - log(min(cost, INSCRIBED - 1) / (INSCRIBED - 1)) / parameters.inflation_cost_scaling_factor
        )
        if distance >= parameters.cost_scaling_dist:
            return self._max_speed
        return self._max_speed * parameters.cost_scaling_gain * distance / parameters.cost_scaling_dist

    def _check_for_collision(self, command: Velocity, carrot_distance: float, control_input: ControlInput) -> None:
        """Check that a velocity does not lead to a collision.

        The footprint is checked within the permitted time to a collision, and not beyond the carrot.

        Raises:
            FollowingError: there is an obstacle ahead.
        """
        limit = self.parameters.max_allowed_time_to_collision_up_to_carrot
        if abs(command.x) > 0.0:
            limit = min(limit, carrot_distance / abs(command.x))
        if not is_free(control_input, command, limit):
            raise FollowingError("there is an obstacle ahead")


def find_carrot(points: NDArray[np.float64], lookahead: float) -> NDArray[np.float64]:
    """Return the interpolated point at which a path first reaches a distance from the robot.

    If all points are nearer, the last point is returned.

    Args:
        points: the points of the path in the robot's frame, of shape (points, 2), in meters.
        lookahead: the distance, in meters.
    """
    distances = np.hypot(points[:, 0], points[:, 1])
    far_indices = np.flatnonzero(distances >= lookahead)
    index = int(far_indices[0]) if len(far_indices) else len(points) - 1
    if index == 0 or not len(far_indices):
        nearest_end: NDArray[np.float64] = points[index]
        return nearest_end
    inner_point, outer_point = points[index - 1], points[index]
    step = outer_point - inner_point
    a, b, c = float(step @ step), float(inner_point @ step), float(inner_point @ inner_point) - lookahead**2
    fraction = (-b + sqrt(max(b * b - a * c, 0.0))) / a if a > 0.0 else 1.0
    point: NDArray[np.float64] = inner_point + min(fraction, 1.0) * step
    return point


def compute_curvature(point: NDArray[np.float64]) -> float:
    """Return the curvature, in 1/m, of the arc from the robot to a point in the robot's frame.

    The robot faces along x, so the curvature is 2 y / (x^2 + y^2).
    """
    squared_distance = float(point @ point)
    return 2.0 * float(point[1]) / squared_distance if squared_distance > _MIN_SQUARED_DISTANCE else 0.0


def limit_speed_in_curve(speed: float, curvature: float, min_radius: float) -> float:
    """Return the speed in a curve, in m/s.

    If the radius of the curve is below `min_radius`, in meters, the speed is reduced in proportion to the radius.
    """
    radius = 1.0 / abs(curvature) if curvature else np.inf
    return speed * min(1.0, float(radius) / min_radius) if min_radius > 0.0 else speed


def compute_rotation_speed(angle: float, current: float, period: float, max_speed: float, acceleration: float) -> float:
    """Return the angular velocity, in rad/s, for the next cycle of a rotation to an angle.

    From this velocity, the rotation can stop at the angle.

    Args:
        angle: the remaining angle, in radians.
        current: the current angular velocity, in rad/s.
        period: the period of the cycles, in seconds.
        max_speed: the maximum angular velocity, in rad/s.
        acceleration: the maximum acceleration and deceleration, in rad/s^2.
    """
    target = copysign(min(max_speed, sqrt(2.0 * acceleration * abs(angle))), angle)
    if abs(target) * period > abs(angle):
        target = angle / period
    max_change = acceleration * period
    return min(max(target, current - max_change), current + max_change)


def is_free(control_input: ControlInput, command: Velocity, seconds: float) -> bool:
    """Return whether the footprint touches no obstacle during a motion at constant velocity.

    `seconds` is the duration of the motion.
    """
    _, circumscribed_radius = compute_radii(control_input.footprint)
    max_point_speed = hypot(command.x, command.y) + abs(command.yaw) * circumscribed_radius
    if max_point_speed <= 0.0:
        return True
    step = control_input.costmap.grid.resolution / max_point_speed
    times = np.arange(step, max(seconds, step) + step, step)
    poses = predict_poses(control_input.pose, np.array([command]), times)
    costs = control_input.costmap.compute_footprint_cost(poses, control_input.footprint)
    return not bool(np.any(costs == LETHAL))


def _find_cusp(points: NDArray[np.float64]) -> int:
    """Return the index of the first point at which the path reverses, or of the last point."""
    steps = np.diff(points, axis=0)
    reversal_indices = np.flatnonzero((steps[:-1] * steps[1:]).sum(axis=1) < 0.0)
    return int(reversal_indices[0]) + 1 if len(reversal_indices) else len(points) - 1


_MIN_SQUARED_DISTANCE = 1e-9
