"""A path follower that samples velocities, simulates their motions and commands the best.

This follower replaces both of nav2's sampling controllers, DWB and MPPI. Limits and times come from the parameters of
either; the scoring of the sampled motions is Linkwright's own.

Source: Fox, Burgard, Thrun, "The Dynamic Window Approach to Collision Avoidance" (1997).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import atan2, hypot

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.costmaps.costmap import INSCRIBED, UNKNOWN
from linkwright.navigation.following.follower import (
    ControlInput,
    Follower,
    FollowingError,
    Velocity,
    apply_speed_limit,
    compute_distances_along,
    predict_poses,
    to_robot_frame,
    wrap_angle,
)
from linkwright.navigation.following.pure_pursuit import compute_rotation_speed, is_free

_MIN_VELOCITY, _MAX_VELOCITY, _MAX_ACCELERATION = (
    Velocity(0.0, 0.0, -1.0),
    Velocity(0.26, 0.0, 1.0),
    Velocity(2.5, 0.0, 3.2),
)


@dataclass(frozen=True, kw_only=True)
class VelocityLimits:
    """Limits of velocity and acceleration, in m/s, rad/s, m/s^2 and rad/s^2.

    Attributes:
        min_velocity: the minimum velocities along x, along y and about z.
        max_velocity: the maximum velocities along x, along y and about z.
        acceleration: the maximum acceleration of each velocity.
        deceleration: the maximum deceleration of each velocity; positive.
    """

    min_velocity: Velocity = _MIN_VELOCITY
    max_velocity: Velocity = _MAX_VELOCITY
    acceleration: Velocity = _MAX_ACCELERATION
    deceleration: Velocity = _MAX_ACCELERATION


@dataclass(frozen=True, kw_only=True)
class SamplingParameters:
    """Settings of the sampling.

    Attributes:
        limits: the limits of the robot.
        sample_counts: the number of velocities sampled along x, along y and about z.
        simulated_seconds: how long each motion is simulated.
        step_count: the number of simulation steps.
        path_weight: the cost of each meter of distance from the path, as an equivalent length of path in meters.
        heading_weight: the cost of each radian of deviation from the path's direction, as a length of path in meters.
        obstacle_weight: the weight of the highest costmap cost along the motion.
        min_turn_angle: the angle to the path above which the robot turns in place, in radians.
    """

    limits: VelocityLimits = field(default_factory=VelocityLimits)
    sample_counts: tuple[int, int, int] = (7, 5, 15)
    simulated_seconds: float = 1.7
    step_count: int = 12
    path_weight: float = 1.0
    heading_weight: float = 0.12
    obstacle_weight: float = 0.4
    min_turn_angle: float = 1.2


_MAX_CHECKED_FOOTPRINTS = 60
"""The maximum number of velocities that are checked with the footprint, best first. This check is slow."""
_LOOK_AHEAD_M = 0.35
"""The distance from a motion's end to the point ahead on the path that the robot should face, in meters."""


class SamplingFollower(Follower):
    """A path follower that samples velocities."""

    def __init__(self, parameters: SamplingParameters | None = None) -> None:
        self.parameters = parameters or SamplingParameters()
        self._max_speed = self.parameters.limits.max_velocity.x
        self._is_turning = False

    def reset(self) -> None:
        """Reset for a new path."""
        self._is_turning = False

    def limit_speed(self, speed: float, *, is_percentage: bool = False) -> None:
        """Limit the speed as described in `Follower.limit_speed`."""
        self._max_speed = apply_speed_limit(self.parameters.limits.max_velocity.x, speed, is_percentage=is_percentage)

    def compute_velocity(self, control_input: ControlInput) -> Velocity:
        """Return the velocity for the next cycle, as described in `Follower.compute_velocity`."""
        x, y, yaw = control_input.pose
        goal = control_input.path[-1]
        if hypot(goal[0] - x, goal[1] - y) < control_input.xy_tolerance:
            return self._compute_turn_velocity(wrap_angle(float(goal[2]) - yaw), control_input)
        angle = self._find_angle_to_path(control_input)
        self._is_turning = abs(angle) > (
            self.parameters.min_turn_angle / 3.0 if self._is_turning else self.parameters.min_turn_angle
        )
        if self._is_turning and self.parameters.limits.max_velocity.y <= 0.0:
            return self._compute_turn_velocity(angle, control_input)
        return self._choose_velocity(control_input)

    def _find_angle_to_path(self, control_input: ControlInput) -> float:
        points = to_robot_frame(control_input.pose, control_input.path[:, :2])
        index = min(int(np.searchsorted(compute_distances_along(control_input.path), _LOOK_AHEAD_M)), len(points) - 1)
        return atan2(float(points[index, 1]), float(points[index, 0]))

    def _compute_turn_velocity(self, angle: float, control_input: ControlInput) -> Velocity:
        """Return the velocity to rotate in place by an angle, after a check for collisions.

        Raises:
            FollowingError: the rotation leads to a collision.
        """
        limits, current = self.parameters.limits, control_input.velocity
        command = Velocity(
            _brake(current.x, limits.deceleration.x, control_input.period),
            _brake(current.y, limits.deceleration.y, control_input.period),
            compute_rotation_speed(
                angle, current.yaw, control_input.period, limits.max_velocity.yaw, limits.acceleration.yaw
            ),
        )
        yaw_rate = abs(command.yaw)
        seconds = min(self.parameters.simulated_seconds, abs(angle) / yaw_rate) if yaw_rate > 0.0 else 0.0
        if not is_free(control_input, command, seconds):
            raise FollowingError("there is an obstacle where the robot would turn")
        return command

    def _choose_velocity(self, control_input: ControlInput) -> Velocity:
        """Return the next cycle's velocity towards the best collision-free candidate.

        Footprints are checked in the order of the scores, best first.

        Raises:
            FollowingError: every candidate that was checked leads to a collision.
        """
        parameters = self.parameters
        candidates = self._sample_candidates(control_input)
        motions = predict_poses(
            control_input.pose,
            candidates,
            np.linspace(0.0, parameters.simulated_seconds, parameters.step_count + 1)[1:],
        )
        costs = control_input.costmap.cost_at(motions[..., :2]).astype(np.float64)
        costs[costs == UNKNOWN] = 0.0
        max_costs: NDArray[np.float64] = costs.max(axis=1)
        free_indices = np.flatnonzero(max_costs < INSCRIBED)
        motion_costs = self._rate_motions(motions[free_indices], max_costs[free_indices] / INSCRIBED, control_input)
        for index in free_indices[np.argsort(motion_costs)][:_MAX_CHECKED_FOOTPRINTS]:
            candidate = Velocity(*map(float, candidates[index]))
            if max_costs[index] <= 0.0 or is_free(control_input, candidate, parameters.simulated_seconds):
                return self._limit_change(candidate, control_input)
        raise FollowingError("every sampled velocity leads to a collision")

    def _sample_candidates(self, control_input: ControlInput) -> NDArray[np.float64]:
        """Return velocities that are reachable within the simulated time, of shape (candidates, 3)."""
        parameters, limits = self.parameters, self.parameters.limits
        max_velocity = (min(limits.max_velocity.x, self._max_speed), limits.max_velocity.y, limits.max_velocity.yaw)
        axes = []
        for axis, count in enumerate(parameters.sample_counts):
            current, max_change = control_input.velocity[axis], limits.acceleration[axis] * parameters.simulated_seconds
            low, high = (
                max(limits.min_velocity[axis], current - max_change),
                min(max_velocity[axis], current + max_change),
            )
            values = np.linspace(low, max(low, high), count if high > low else 1)
            axes.append(np.append(values, 0.0) if low < 0.0 < high else values)
        mesh = np.meshgrid(*axes, indexing="ij")
        candidates: NDArray[np.float64] = np.stack([axis_samples.ravel() for axis_samples in mesh], axis=-1)
        return candidates

    def _limit_change(self, target: Velocity, control_input: ControlInput) -> Velocity:
        """Return the velocity nearest to a target that the robot can reach in the next cycle.

        All components complete the same fraction of their change.
        """
        limits, current, period = self.parameters.limits, control_input.velocity, control_input.period
        fraction = 1.0
        for old_speed, new_speed, acceleration, deceleration in zip(
            current, target, limits.acceleration, limits.deceleration, strict=True
        ):
            max_change = (deceleration if abs(new_speed) < abs(old_speed) else acceleration) * period
            if abs(new_speed - old_speed) > max_change:
                fraction = min(fraction, max_change / abs(new_speed - old_speed))
        return Velocity(
            *(
                old_value + fraction * (new_value - old_value)
                for old_value, new_value in zip(current, target, strict=True)
            )
        )

    def _rate_motions(
        self, motions: NDArray[np.float64], costs: NDArray[np.float64], control_input: ControlInput
    ) -> NDArray[np.float64]:
        """Return the costs of motions, in meters of the path, of shape (motions,).

        `motions` are the predicted poses, and `costs` are the highest costs in the costmap, from 0 to 1.
        """
        parameters = self.parameters
        path = control_input.path
        lengths = compute_distances_along(path)
        checked_points = motions[:, [parameters.step_count // 2, -1], :2]
        squared = ((checked_points[:, :, None] - path[None, None, :, :2]) ** 2).sum(axis=-1)
        nearest = squared.argmin(axis=-1)
        path_distances = np.sqrt(np.take_along_axis(squared, nearest[..., None], axis=-1))[..., 0].sum(axis=1)
        ends = nearest[:, 1]
        remaining = lengths[-1] - lengths[ends]
        end_distances = np.hypot(*(motions[:, -1, :2] - path[-1, :2]).T)
        remaining = np.where(ends == len(path) - 1, end_distances, remaining)
        ahead_indices = np.minimum(np.searchsorted(lengths, lengths[ends] + _LOOK_AHEAD_M), len(path) - 1)
        directions = path[ahead_indices, :2] - motions[:, -1, :2]
        heading_errors = np.arctan2(directions[:, 1], directions[:, 0]) - motions[:, -1, 2]
        heading_errors = np.abs(np.arctan2(np.sin(heading_errors), np.cos(heading_errors)))
        heading_errors[np.hypot(directions[:, 0], directions[:, 1]) < _MIN_DIRECTION_DISTANCE] = 0.0
        total_costs: NDArray[np.float64] = (
            remaining
            + parameters.path_weight * path_distances
            + parameters.heading_weight * heading_errors
            + parameters.obstacle_weight * costs
        )
        return total_costs


def _brake(speed: float, deceleration: float, period: float) -> float:
    """Return the speed after one cycle of braking, in m/s."""
    return float(np.sign(speed)) * max(0.0, abs(speed) - deceleration * period)


_MIN_DIRECTION_DISTANCE = 0.05
"""The minimum distance to a point for its direction to be used, in meters."""
