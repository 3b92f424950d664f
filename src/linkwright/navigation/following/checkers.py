"""Goal checkers and progress checkers.

Source: nav2_controller's goal checkers and progress checkers, with their parameters.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from math import hypot

from linkwright.navigation.following.follower import Pose, Velocity, wrap_angle


class GoalChecker(ABC):
    """The base class of checkers that decide whether a goal is reached."""

    xy_tolerance: float = 0.25
    """The distance from the goal at which its position counts as reached, in meters."""

    @abstractmethod
    def is_reached(self, pose: Pose, goal: Pose, velocity: Velocity) -> bool:
        """Return whether the goal is reached.

        All arguments are in the same frame.
        """

    def reset(self) -> None:  # noqa: B027  # Some checkers have no state.
        """Reset for a new goal."""


@dataclass(frozen=True, kw_only=True)
class SimpleGoalParameters:
    """Parameters of `SimpleGoalChecker`, in meters and radians."""

    xy_goal_tolerance: float = 0.25
    yaw_goal_tolerance: float = 0.25
    stateful: bool = True


class SimpleGoalChecker(GoalChecker):
    """A goal checker with tolerances of position and heading.

    If `stateful` is set, only the heading is checked once the position has been reached.
    """

    def __init__(self, parameters: SimpleGoalParameters | None = None) -> None:
        self._parameters = parameters or SimpleGoalParameters()
        self.xy_tolerance = self._parameters.xy_goal_tolerance
        self._position_reached = False

    def reset(self) -> None:
        """Reset for a new goal."""
        self._position_reached = False

    def is_reached(self, pose: Pose, goal: Pose, velocity: Velocity) -> bool:
        """Return whether the position and heading are within the tolerances."""
        if not self._position_reached:
            if hypot(pose[0] - goal[0], pose[1] - goal[1]) > self._parameters.xy_goal_tolerance:
                return False
            self._position_reached = self._parameters.stateful
        return abs(wrap_angle(pose[2] - goal[2])) <= self._parameters.yaw_goal_tolerance


@dataclass(frozen=True, kw_only=True)
class StoppedGoalParameters(SimpleGoalParameters):
    """Parameters of `StoppedGoalChecker`, in meters, radians and seconds."""

    trans_stopped_velocity: float = 0.25
    rot_stopped_velocity: float = 0.25


class StoppedGoalChecker(SimpleGoalChecker):
    """A `SimpleGoalChecker` that also requires the robot to have stopped."""

    def __init__(self, parameters: StoppedGoalParameters | None = None) -> None:
        self._stopped_parameters = parameters or StoppedGoalParameters()
        super().__init__(self._stopped_parameters)

    def is_reached(self, pose: Pose, goal: Pose, velocity: Velocity) -> bool:
        """Return whether the pose and the velocity are within the tolerances."""
        return (
            super().is_reached(pose, goal, velocity)
            and hypot(velocity.x, velocity.y) <= self._stopped_parameters.trans_stopped_velocity
            and abs(velocity.yaw) <= self._stopped_parameters.rot_stopped_velocity
        )


@dataclass(frozen=True, kw_only=True)
class ProgressParameters:
    """Parameters of `ProgressChecker` (nav2's SimpleProgressChecker), in meters and seconds."""

    required_movement_radius: float = 0.5
    movement_time_allowance: float = 10.0


@dataclass(frozen=True, kw_only=True)
class PoseProgressParameters(ProgressParameters):
    """Parameters of nav2's PoseProgressChecker, which also counts rotation as progress.

    Angles are in radians.
    """

    required_movement_angle: float = 0.5


class ProgressChecker:
    """A checker of whether a robot moves by a minimum distance within a time limit.

    With `PoseProgressParameters`, a minimum rotation also counts as progress.
    """

    def __init__(self, parameters: ProgressParameters | None = None) -> None:
        self._parameters = parameters or ProgressParameters()
        self._reference_pose: Pose | None = None
        self._reference_time_ns = 0

    def reset(self) -> None:
        """Reset for a new goal."""
        self._reference_pose = None

    def makes_progress(self, pose: Pose, time_ns: int) -> bool:
        """Return whether the robot made enough progress, or the time limit has not passed yet."""
        if self._reference_pose is None or self._has_moved(self._reference_pose, pose):
            self._reference_pose, self._reference_time_ns = pose, time_ns
            return True
        return time_ns - self._reference_time_ns <= self._parameters.movement_time_allowance * 1e9

    def _has_moved(self, reference: Pose, pose: Pose) -> bool:
        parameters = self._parameters
        if hypot(pose[0] - reference[0], pose[1] - reference[1]) > parameters.required_movement_radius:
            return True
        return (
            isinstance(parameters, PoseProgressParameters)
            and abs(wrap_angle(pose[2] - reference[2])) > parameters.required_movement_angle
        )
