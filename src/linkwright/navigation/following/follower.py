"""The base class of path followers, their input in each cycle, and geometry that they share."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.costmaps.costmap import Costmap
from linkwright.navigation.costmaps.footprints import Footprint

Pose = tuple[float, float, float]
"""x, y (metres) and yaw (radians)."""


class Velocity(NamedTuple):
    """A planar velocity of the robot, in its own frame.

    Attributes:
        x: forward, in m/s.
        y: to the left, in m/s.
        yaw: to the left, in rad/s.
    """

    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0


STILL: Final = Velocity()
"""No motion."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Situation:
    """The input of a cycle; all in the frame of the costmap.

    Attributes:
        pose: of the robot.
        velocity: which the robot has.
        path: the remaining path, of shape (poses, 3): x, y (metres) and yaw (radians); two poses at least.
        costmap: around the robot.
        footprint: of the robot, in its own frame.
        period: of the cycles, in seconds.
        xy_tolerance: how close to its end the path counts as driven, in metres.
    """

    pose: Pose
    velocity: Velocity
    path: NDArray[np.float64]
    costmap: Costmap
    footprint: Footprint
    period: float
    xy_tolerance: float = 0.25


class FollowingError(Exception):
    """No valid velocity exists; the message gives the reason."""


class Follower(ABC):
    """Finds velocities that drive a robot along a path."""

    def begin(self) -> None:  # noqa: B027 - most keep nothing from the path before
        """Reset for another path."""

    @abstractmethod
    def velocity(self, situation: Situation) -> Velocity:
        """The velocity for the next cycle.

        Raises:
            FollowingError: none can be driven.
        """

    @abstractmethod
    def limit_speed(self, speed: float, *, is_percentage: bool = False) -> None:
        """Limit the speed; 0 removes the limit.

        Args:
            speed: in m/s, or in per cent of the highest.
            is_percentage: which of both.
        """


def limited(highest: float, speed: float, *, is_percentage: bool) -> float:
    """The greatest speed under a limit; see `Follower.limit_speed`."""
    if not speed > 0.0:
        return highest
    return highest * min(speed, 100.0) / 100.0 if is_percentage else min(highest, speed)


def wrapped(angle: float) -> float:
    """An angle in (-pi, pi]."""
    return float(np.arctan2(np.sin(angle), np.cos(angle)))


def in_frame_of(pose: Pose, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Points, of shape (..., 2), in the frame of a robot at a pose: x forward, y to the left."""
    x, y, yaw = pose
    cosine, sine = np.cos(yaw), np.sin(yaw)
    dx, dy = points[..., 0] - x, points[..., 1] - y
    seen: NDArray[np.float64] = np.stack((cosine * dx + sine * dy, cosine * dy - sine * dx), axis=-1)
    return seen


def lengths_along(path: NDArray[np.float64]) -> NDArray[np.float64]:
    """The distance along a path of each pose from its beginning, in metres; of shape (poses,)."""
    steps = np.hypot(*np.diff(path[:, :2], axis=0).T)
    lengths: NDArray[np.float64] = np.concatenate(([0.0], np.cumsum(steps)))
    return lengths


def motions(pose: Pose, velocities: NDArray[np.float64], times: NDArray[Any]) -> NDArray[np.float64]:
    """The poses of a robot with a constant velocity: exactly, on circles.

    Args:
        pose: at the beginning.
        velocities: along x and y (m/s) and about z (rad/s) in the robot's frame, of shape (velocities, 3).
        times: the times in seconds, of shape (times,).

    Returns:
        Poses, of shape (velocities, times, 3).
    """
    x, y, yaw = pose
    vx, vy, turning = (velocities[:, axis, None] for axis in range(3))
    turned = turning * times
    along = np.sinc(turned / np.pi) * times  # sin(wt)/w
    half = 0.5 * turned
    across = np.sinc(half / np.pi) * np.sin(half) * times  # (1 - cos(wt))/w
    dx, dy = vx * along - vy * across, vx * across + vy * along
    cosine, sine = np.cos(yaw), np.sin(yaw)
    poses: NDArray[np.float64] = np.stack(
        (x + cosine * dx - sine * dy, y + sine * dx + cosine * dy, yaw + turned), axis=-1
    )
    return poses
