"""Behaviors of nav2's behavior_server: spin, drive straight, wait, assisted teleoperation.

Source: nav2_behaviors.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from math import copysign, hypot, sqrt

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.following.follower import ZERO_VELOCITY, Pose, Velocity, predict_poses, wrap_angle

IsFree = Callable[[NDArray[np.float64]], bool]
"""Returns whether the robot touches no obstacle at any of the poses, of shape (poses, 3)."""


class Outcome(Enum):
    """The state of a behavior after a cycle."""

    RUNNING = "running"
    DONE = "done"
    COLLISION = "there is an obstacle ahead"
    TIMEOUT = "the time allowance was exceeded"


@dataclass(frozen=True, slots=True)
class Step:
    """The result of one cycle of a behavior.

    Attributes:
        outcome: whether the behavior is still running, or how it ended.
        velocity: the commanded velocity; zero once the behavior has ended.
        traveled: the distance traveled or the angle turned so far, in meters or radians.
    """

    outcome: Outcome
    velocity: Velocity = ZERO_VELOCITY
    traveled: float = 0.0


class Behavior(ABC):
    """The base class of behaviors.

    Args:
        allowance: the time limit in seconds; 0 for no limit.
    """

    def __init__(self, allowance: float) -> None:
        self._allowance = allowance

    def step(self, pose: Pose, elapsed: float, is_free: IsFree) -> Step:
        """Run one cycle of the behavior.

        Args:
            pose: the pose of the robot.
            elapsed: the time since the behavior began, in seconds.
            is_free: checks poses for collisions, in the frame of `pose`; see `IsFree`.

        Returns:
            The result of the cycle.
        """
        step = self._step(pose, elapsed, is_free)
        if step.outcome is Outcome.RUNNING and 0.0 < self._allowance < elapsed:
            return Step(Outcome.TIMEOUT, traveled=step.traveled)
        return step

    @abstractmethod
    def _step(self, pose: Pose, elapsed: float, is_free: IsFree) -> Step:
        """Run one cycle as `step` does, without checking the time limit."""


@dataclass(frozen=True, kw_only=True)
class SpinParameters:
    """Parameters of `Spin`, with nav2's names and defaults, in rad/s, rad/s^2 and seconds."""

    max_rotational_vel: float = 1.0
    min_rotational_vel: float = 0.4
    rotational_acc_lim: float = 3.2
    simulate_ahead_time: float = 2.0


class Spin(Behavior):
    """A behavior that turns the robot in place.

    Args:
        angle: the angle to turn, in radians; it may exceed a full turn.
        allowance: see `Behavior`.
        parameters: the limits of the motion.
        start: the pose of the robot at the start.
    """

    def __init__(self, angle: float, allowance: float, parameters: SpinParameters, start: Pose) -> None:
        super().__init__(allowance)
        self._angle = angle
        self._parameters = parameters
        self._previous_yaw = start[2]
        self._turned_angle = 0.0

    def _step(self, pose: Pose, elapsed: float, is_free: IsFree) -> Step:
        self._turned_angle += wrap_angle(pose[2] - self._previous_yaw)
        self._previous_yaw = pose[2]
        remaining_angle = abs(self._angle) - copysign(self._turned_angle, self._turned_angle * self._angle)
        if remaining_angle <= _ANGLE_TOLERANCE:
            return Step(Outcome.DONE, traveled=self._turned_angle)
        parameters = self._parameters
        speed = min(
            max(sqrt(2.0 * parameters.rotational_acc_lim * remaining_angle), parameters.min_rotational_vel),
            parameters.max_rotational_vel,
        )
        velocity = Velocity(yaw=copysign(speed, self._angle))
        predicted_poses = _predict_poses(pose, velocity, min(parameters.simulate_ahead_time, remaining_angle / speed))
        if not is_free(predicted_poses):
            return Step(Outcome.COLLISION, traveled=self._turned_angle)
        return Step(Outcome.RUNNING, velocity, self._turned_angle)


class DriveStraight(Behavior):
    """A behavior that drives the robot straight forward or backward.

    Args:
        distance: the distance to drive, in meters; negative to drive backward.
        speed: the speed in m/s.
        allowance: see `Behavior`.
        look_ahead: how far ahead the motion is checked for collisions, in seconds.
        start: the pose of the robot at the start.
    """

    def __init__(self, distance: float, speed: float, allowance: float, look_ahead: float, start: Pose) -> None:
        super().__init__(allowance)
        self._distance = distance
        self._speed = copysign(speed, distance)
        self._look_ahead = look_ahead
        self._start = start

    def _step(self, pose: Pose, elapsed: float, is_free: IsFree) -> Step:
        traveled = hypot(pose[0] - self._start[0], pose[1] - self._start[1])
        remaining_distance = abs(self._distance) - traveled
        if remaining_distance <= 0.0:
            return Step(Outcome.DONE, traveled=traveled)
        velocity = Velocity(self._speed)
        if not is_free(_predict_poses(pose, velocity, min(self._look_ahead, remaining_distance / abs(self._speed)))):
            return Step(Outcome.COLLISION, traveled=traveled)
        return Step(Outcome.RUNNING, velocity, traveled)


class Wait(Behavior):
    """A behavior that keeps the robot at rest for a number of seconds."""

    def __init__(self, seconds: float) -> None:
        super().__init__(0.0)
        self._seconds = seconds

    def _step(self, pose: Pose, elapsed: float, is_free: IsFree) -> Step:
        return Step(Outcome.DONE if elapsed >= self._seconds else Outcome.RUNNING)


def slow_near_obstacles(pose: Pose, velocity: Velocity, seconds: float, is_free: IsFree) -> Velocity:
    """Return an operator's velocity, reduced near obstacles (nav2's assisted teleoperation).

    The sooner the velocity leads to a collision, the more it is reduced.

    Args:
        pose: the pose of the robot.
        velocity: the requested velocity.
        seconds: how far ahead the motion is checked for collisions, in seconds.
        is_free: checks poses for collisions; see `IsFree`.
    """
    predicted_poses = _predict_poses(pose, velocity, seconds)
    for index in range(len(predicted_poses)):
        if not is_free(predicted_poses[index : index + 1]):
            fraction = index / len(predicted_poses)
            return Velocity(velocity.x * fraction, velocity.y * fraction, velocity.yaw * fraction)
    return velocity


def _predict_poses(pose: Pose, velocity: Velocity, seconds: float) -> NDArray[np.float64]:
    """Return the poses predicted at a constant velocity, of shape (poses, 3)."""
    count = max(2, round(seconds / _CHECK_INTERVAL) + 1)
    poses: NDArray[np.float64] = predict_poses(pose, np.array([velocity]), np.linspace(0.0, seconds, count)[1:])[0]
    return poses


_ANGLE_TOLERANCE = 1e-3
"""The remaining angle at which a spin is complete, in radians."""
_CHECK_INTERVAL = 0.1
"""The time between two poses that are checked for collisions, in seconds."""
