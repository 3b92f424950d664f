"""The base class of path followers, the input of a control cycle, and shared geometry."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.costmaps.costmap import Costmap
from linkwright.navigation.costmaps.footprints import Footprint

Pose = tuple[float, float, float]
"""x, y (meters) and yaw (radians)."""


class Velocity(NamedTuple):
    """A planar velocity of the robot, in the robot's frame.

    Attributes:
        x: the forward velocity, in m/s.
        y: the velocity to the left, in m/s.
        yaw: the counterclockwise angular velocity, in rad/s.
    """

    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0


ZERO_VELOCITY: Final = Velocity()
"""No motion."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ControlInput:
    """The input of a control cycle, in the frame of the costmap.

    Attributes:
        pose: the pose of the robot.
        velocity: the current velocity of the robot.
        path: the remaining path, of shape (poses, 3): x, y (meters) and yaw (radians); at least two poses.
        costmap: the costmap around the robot.
        footprint: the footprint in the frame of the robot.
        period: the period of the cycles, in seconds.
        xy_tolerance: the distance from the end within which the path counts as completed, in meters.
    """

    pose: Pose
    velocity: Velocity
    path: NDArray[np.float64]
    costmap: Costmap
    footprint: Footprint
    period: float
    xy_tolerance: float = 0.25


class FollowingError(Exception):
    """Raised when there is no valid velocity.

    The message gives the reason.
    """


class Follower(ABC):
    """The base class of controllers that compute velocities to drive a robot along a path."""

    def reset(self) -> None:  # noqa: B027  # Most followers keep no data of the previous path.
        """Reset for a new path."""

    @abstractmethod
    def compute_velocity(self, control_input: ControlInput) -> Velocity:
        """Return the velocity for the next cycle.

        Raises:
            FollowingError: there is no valid velocity.
        """

    @abstractmethod
    def limit_speed(self, speed: float, *, is_percentage: bool = False) -> None:
        """Limit the speed, or remove the limit.

        Args:
            speed: the limit in m/s, or in percent of the maximum speed; 0 for no limit.
            is_percentage: whether `speed` is in percent.
        """


def apply_speed_limit(max_speed: float, speed: float, *, is_percentage: bool) -> float:
    """Return a maximum speed, in m/s, reduced to the limit of `Follower.limit_speed`."""
    if not speed > 0.0:
        return max_speed
    return max_speed * min(speed, 100.0) / 100.0 if is_percentage else min(max_speed, speed)


def wrap_angle(angle: float) -> float:
    """Return an angle in radians, wrapped to (-pi, pi]."""
    return float(np.arctan2(np.sin(angle), np.cos(angle)))


def to_robot_frame(pose: Pose, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Transform points of shape (..., 2) to the frame of a robot at a pose.

    In this frame, x points forward and y points to the left.
    """
    x, y, yaw = pose
    cosine, sine = np.cos(yaw), np.sin(yaw)
    dx, dy = points[..., 0] - x, points[..., 1] - y
    robot_points: NDArray[np.float64] = np.stack((cosine * dx + sine * dy, cosine * dy - sine * dx), axis=-1)
    return robot_points


def compute_distances_along(path: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the distance along a path to each of its poses, in meters, of shape (poses,)."""
    steps = np.hypot(*np.diff(path[:, :2], axis=0).T)
    lengths: NDArray[np.float64] = np.concatenate(([0.0], np.cumsum(steps)))
    return lengths


def predict_poses(pose: Pose, velocities: NDArray[np.float64], times: NDArray[Any]) -> NDArray[np.float64]:
    """Return the poses of a robot that moves at constant velocities, on circular arcs.

    Args:
        pose: the initial pose.
        velocities: the velocities along x and y (m/s) and about z (rad/s) in the robot's frame, of shape (velocities,
            3).
        times: the times in seconds, of shape (times,).

    Returns:
        Poses, of shape (velocities, times, 3).
    """
    x, y, yaw = pose
    vx, vy, yaw_rate = (velocities[:, axis, None] for axis in range(3))
    yaw_changes = yaw_rate * times
    forward_factors = np.sinc(yaw_changes / np.pi) * times  # sin(wt) / w, also for w = 0.
    half_angles = 0.5 * yaw_changes
    sideways_factors = np.sinc(half_angles / np.pi) * np.sin(half_angles) * times  # (1 - cos(wt)) / w, also for w = 0.
    dx, dy = vx * forward_factors - vy * sideways_factors, vx * sideways_factors + vy * forward_factors
    cosine, sine = np.cos(yaw), np.sin(yaw)
    poses: NDArray[np.float64] = np.stack(
        (x + cosine * dx - sine * dy, y + sine * dx + cosine * dy, yaw + yaw_changes), axis=-1
    )
    return poses
