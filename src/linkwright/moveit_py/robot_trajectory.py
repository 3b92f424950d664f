"""Trajectories of a group (``moveit.core.robot_trajectory``)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from copy import copy
from itertools import pairwise
from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.graph.time.values import Duration
from linkwright.moveit_py.robot_model import RobotModel
from linkwright.moveit_py.robot_state import RobotState
from linkwright.planning.nodes.conversions import joint_state_message, trajectory_message, update_positions
from linkwright.planning.timing import Trajectory, parameterize
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND


class RobotTrajectory:
    """The states of a group over time.

    Args:
        robot_model: the robot.

    Attributes:
        joint_model_group_name: the name of the group; empty until it is set.
    """

    def __init__(self, robot_model: RobotModel) -> None:
        self.robot_model = robot_model
        self.joint_model_group_name = ""
        self._start = RobotState(robot_model)
        self._names: tuple[str, ...] = ()
        zeros = np.zeros((0, 0))
        self._trajectory = Trajectory(np.zeros(0), zeros, zeros, zeros)

    @classmethod
    def from_plan(cls, start: RobotState, group: str, trajectory: Trajectory) -> RobotTrajectory:
        """Return the trajectory of a plan.

        Args:
            start: the state of all joints at the start.
            group: the name of the group.
            trajectory: the trajectory of the group's joints.
        """
        result = cls(start.robot_model)
        result.joint_model_group_name, result._start, result._trajectory = group, copy(start), trajectory
        result._names = start.robot_model.group(group).joint_names
        return result

    def __len__(self) -> int:
        return len(self._trajectory.times)

    def __getitem__(self, index: int) -> RobotState:
        state = copy(self._start)
        trajectory = self._trajectory
        state.joint_positions = dict(zip(self._names, trajectory.positions[index].tolist(), strict=True))
        state.joint_velocities = dict(zip(self._names, trajectory.velocities[index].tolist(), strict=True))
        state.joint_accelerations = dict(zip(self._names, trajectory.accelerations[index].tolist(), strict=True))
        return state

    def __iter__(self) -> Iterator[tuple[RobotState, float]]:
        """Yield each state with the time in s since the one before it."""
        for index, duration in enumerate(self.get_waypoint_durations()):
            yield self[index], duration

    @property
    def duration(self) -> float:
        """The duration in s."""
        return self._trajectory.duration if len(self) else 0.0

    @property
    def average_segment_duration(self) -> float:
        """The mean time in s between two states."""
        return self.duration / (len(self) - 1) if len(self) > 1 else 0.0

    def get_waypoint_durations(self) -> list[float]:
        """Return for each state the time in s since the one before it; the first time is 0."""
        return [0.0, *np.diff(self._trajectory.times).tolist()] if len(self) else []

    def path_length(self) -> float:
        """Return the sum of the distances between the states, in rad or m over all joints."""
        steps = pairwise(self._trajectory.positions)
        return float(sum(np.linalg.norm(second - first) for first, second in steps))

    def get_robot_trajectory_msg(self, joint_filter: Sequence[str] = ()) -> Any:
        """Return a moveit_msgs/msg/RobotTrajectory.

        Args:
            joint_filter: the joints of the message; all joints of the group if empty.
        """
        names, trajectory = self._names, self._trajectory
        if joint_filter:
            indexes = [index for index, name in enumerate(names) if name in joint_filter]
            names = tuple(names[index] for index in indexes)
            trajectory = Trajectory(
                trajectory.times,
                trajectory.positions[:, indexes],
                trajectory.velocities[:, indexes],
                trajectory.accelerations[:, indexes],
            )
        return trajectory_message(names, trajectory, self.robot_model.robot.root)

    def set_robot_trajectory_msg(self, robot_state: RobotState, msg: Any) -> None:
        """Take the states of a moveit_msgs/msg/RobotTrajectory.

        Args:
            robot_state: the positions of the joints that the message lacks.
            msg: the message.
        """
        source = msg.joint_trajectory
        self._start, self._names = copy(robot_state), tuple(source.joint_names)
        names = self.robot_model.moved.joint_names
        if source.points:
            first = joint_state_message(source.joint_names, source.points[0].positions)
            self._start.positions = update_positions(names, robot_state.positions, first)
        shape = (len(source.points), len(self._names))

        def rows(field: str) -> Array:
            values = [getattr(point, field) for point in source.points]
            return np.array([row if len(row) else np.zeros(shape[1]) for row in values], dtype=float).reshape(shape)

        times = [Duration.from_msg(point.time_from_start).nanoseconds for point in source.points]
        self._trajectory = Trajectory(
            np.array(times, dtype=float) / NANOSECONDS_PER_SECOND,
            rows("positions"),
            rows("velocities"),
            rows("accelerations"),
        )

    def apply_totg_time_parameterization(
        self,
        velocity_scaling_factor: float,
        acceleration_scaling_factor: float,
        *,
        path_tolerance: float = 0.1,
        resample_dt: float = 0.1,
        min_angle_change: float = 0.001,
    ) -> bool:
        """Make the trajectory as fast as the limits allow, and return whether that was possible.

        Args:
            velocity_scaling_factor: the share of the maximum velocities, from 0 to 1.
            acceleration_scaling_factor: the share of the maximum accelerations, from 0 to 1.
            path_tolerance: the maximum distance of the trajectory from a corner, in rad or m over all joints.
            resample_dt: the time in s between two states.
            min_angle_change: accepted for compatibility.
        """
        if not len(self) or self.joint_model_group_name not in self.robot_model.groups:
            return False
        group = self.robot_model.group(self.joint_model_group_name)
        if group.joint_names != self._names:
            return False
        self._trajectory = parameterize(
            self._trajectory.positions,
            group.max_velocities * velocity_scaling_factor,
            group.max_accelerations * acceleration_scaling_factor,
            max_deviation=path_tolerance,
            interval_s=resample_dt,
        )
        return True
