"""A path follower that turns the robot towards a new path before another follower drives.

Source: nav2_rotation_shim_controller, with its parameters.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2

import numpy as np

from linkwright.navigation.following.follower import (
    ControlInput,
    Follower,
    FollowingError,
    Velocity,
    compute_distances_along,
    to_robot_frame,
)
from linkwright.navigation.following.pure_pursuit import compute_rotation_speed, is_free


@dataclass(frozen=True, kw_only=True)
class RotationShimParameters:
    """Parameters of `RotationShim`, with nav2's names and defaults.

    Units are meters, seconds and radians.
    """

    angular_dist_threshold: float = 0.785
    angular_disengage_threshold: float = 0.3925
    forward_sampling_distance: float = 0.5
    rotate_to_heading_angular_vel: float = 1.8
    max_angular_accel: float = 3.2
    simulate_ahead_time: float = 1.0


class RotationShim(Follower):
    """A path follower that first turns the robot, and then delegates to another follower.

    Args:
        primary: the other follower.
        parameters: the parameters; see `RotationShimParameters`.
    """

    def __init__(self, primary: Follower, parameters: RotationShimParameters | None = None) -> None:
        self._primary = primary
        self._parameters = parameters or RotationShimParameters()
        self._is_new_path = True
        self._is_turning = False

    def reset(self) -> None:
        """Reset for a new path."""
        self._is_new_path = True
        self._primary.reset()

    def limit_speed(self, speed: float, *, is_percentage: bool = False) -> None:
        """Limit the speed as described in `Follower.limit_speed`."""
        self._primary.limit_speed(speed, is_percentage=is_percentage)

    def compute_velocity(self, control_input: ControlInput) -> Velocity:
        """Return the velocity for the next cycle, as described in `Follower.compute_velocity`."""
        parameters = self._parameters
        points = to_robot_frame(control_input.pose, control_input.path[:, :2])
        lengths = compute_distances_along(control_input.path)
        index = min(int(np.searchsorted(lengths, parameters.forward_sampling_distance)), len(points) - 1)
        angle = atan2(float(points[index, 1]), float(points[index, 0]))
        if self._is_new_path:
            self._is_turning = abs(angle) > parameters.angular_dist_threshold
            self._is_new_path = False
        elif abs(angle) <= parameters.angular_disengage_threshold:
            self._is_turning = False
        if not self._is_turning:
            return self._primary.compute_velocity(control_input)
        command = Velocity(
            yaw=compute_rotation_speed(
                angle,
                control_input.velocity.yaw,
                control_input.period,
                parameters.rotate_to_heading_angular_vel,
                parameters.max_angular_accel,
            )
        )
        if not is_free(control_input, command, parameters.simulate_ahead_time):
            raise FollowingError("there is an obstacle where the robot would turn")
        return command
