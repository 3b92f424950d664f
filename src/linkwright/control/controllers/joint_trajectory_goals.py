"""Validate trajectory messages, and convert them to trajectories of a controller.

Source: joint_trajectory_controller of ros2_controllers (error messages, effects of missing joints, tolerances of
goals).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import isfinite
from typing import Any

from linkwright.control.controllers.joint_trajectory_parameters import Parameters
from linkwright.control.motion.splines import MotionState
from linkwright.control.motion.tolerances import Tolerances, resolve_tolerance
from linkwright.control.motion.trajectory import Trajectory, TrajectoryPoint
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_VELOCITY_EPSILON = 1.1920929e-07
"""The maximum final velocity that counts as zero, in rad/s or m/s: the epsilon of a 32-bit float."""


def to_nanoseconds(time: Any) -> int:
    """Convert a time or duration message to nanoseconds."""
    return int(time.sec) * NANOSECONDS_PER_SECOND + int(time.nanosec)


def find_trajectory_error(message: Any, parameters: Parameters, now_ns: int) -> str | None:
    """Return ros2_controllers' error message for an invalid trajectory, or None.

    Args:
        message: trajectory_msgs/msg/JointTrajectory.
        parameters: the parameters of the controller.
        now_ns: the current time in nanoseconds.
    """
    names, points = message.joint_names, message.points
    if not parameters.allow_partial_joints_goal and len(names) != len(parameters.joints):
        return "Joints on incoming trajectory don't match the controller joints."
    if not names:
        return "Empty joint names on incoming trajectory."
    if not points:
        return "Empty trajectory received."
    start, last_point = to_nanoseconds(message.header.stamp), points[-1]
    end = start + to_nanoseconds(last_point.time_from_start)
    if start and end < now_ns:
        return (
            f"Received trajectory with non-zero start time ({start / NANOSECONDS_PER_SECOND:f}) that ends in the past "
            f"({end / NANOSECONDS_PER_SECOND:f})"
        )
    for index, name in enumerate(names):
        if name not in parameters.joints:
            return f"Incoming joint {name} doesn't match the controller's joints."
        if name in names[:index]:
            return f"Incoming joint {name} appears twice."
    if not parameters.allow_nonzero_velocity_at_trajectory_end:
        for name, velocity in zip(names, last_point.velocities, strict=False):
            if abs(velocity) > _VELOCITY_EPSILON:
                return f"Velocity of last trajectory point of joint {name} is not zero: {velocity:.15f}"
    return _find_point_error(points, len(names), allow_integration=parameters.allow_integration_in_goal_trajectories)


def _find_point_error(points: Sequence[Any], count: int, *, allow_integration: bool) -> str | None:
    previous_ns = 0
    for index, point in enumerate(points):
        time_ns = to_nanoseconds(point.time_from_start)
        if index and time_ns <= previous_ns:
            return (
                f"Time between points {index - 1} and {index} is not strictly increasing, "
                f"it is {previous_ns / NANOSECONDS_PER_SECOND:f} and {time_ns / NANOSECONDS_PER_SECOND:f} respectively"
            )
        previous_ns = time_ns
        lists = {field: getattr(point, field) for field in ("positions", "velocities", "accelerations")}
        if not any(len(values) for values in lists.values()) and allow_integration:
            return f"Point #{index} has neither positions nor velocities nor accelerations."
        for name, values in lists.items():
            is_optional = allow_integration or name != "positions"
            if len(values) != count and not (is_optional and not len(values)):
                return f"Mismatch between joint_names size ({count}) and {name} ({len(values)}) at point #{index}."
            if not all(map(isfinite, values)):
                return f"The {name} at point #{index} are not all finite."
        if len(point.effort):
            return "Trajectories with effort fields are currently not supported."
    return None


def trajectory_from_message(message: Any, parameters: Parameters, held_positions: Sequence[float]) -> Trajectory:
    """Convert a message to a trajectory of all joints of a controller.

    Args:
        message: trajectory_msgs/msg/JointTrajectory, which must be valid (see `find_trajectory_error`).
        parameters: the parameters of the controller.
        held_positions: the positions of all joints, in rad or m, for joints that the message does not name.
    """
    message_indices = [
        message.joint_names.index(name) if name in message.joint_names else -1 for name in parameters.joints
    ]

    def reorder(values: Sequence[float], defaults: Sequence[float]) -> list[float]:
        if not len(values):
            return []
        return [
            float(values[index]) if index >= 0 else default
            for index, default in zip(message_indices, defaults, strict=True)
        ]

    zeros = [0.0] * len(message_indices)
    points = [
        TrajectoryPoint(
            to_nanoseconds(point.time_from_start),
            MotionState(
                reorder(point.positions, held_positions),
                reorder(point.velocities, zeros),
                reorder(point.accelerations, zeros),
            ),
        )
        for point in message.points
    ]
    interpolated = parameters.interpolation_method == "splines"
    return Trajectory(points, to_nanoseconds(message.header.stamp), interpolated=interpolated)


def tolerances_from_goal(
    goal: Any, joints: Sequence[str], default: Tolerances, log: Callable[[str], object]
) -> Tolerances:
    """Return the controller's tolerances, overridden by the tolerances of a goal.

    Args:
        goal: control_msgs/action/FollowJointTrajectory_Goal.
        joints: the joints of the controller.
        default: the controller's tolerances, which are returned if a tolerance of the goal is invalid.
        log: called with each error message.
    """
    tolerances = default
    for field, goal_tolerances in (("path_tolerance", goal.path_tolerance), ("goal_tolerance", goal.goal_tolerance)):
        for tolerance in goal_tolerances:
            if tolerance.name not in joints:
                log(f"joint '{tolerance.name}' specified in goal.{field} does not exist. Using default tolerances.")
                return default
            index = joints.index(tolerance.name)
            old_tolerance = (tolerances.path if field == "path_tolerance" else tolerances.goal)[index]
            try:
                new_tolerance = old_tolerance.override(tolerance.position, tolerance.velocity, tolerance.acceleration)
            except ValueError:
                log(f"joint '{tolerance.name}' specified in goal.{field} has a negative tolerance that is not -1.")
                log("Using default tolerances.")
                return default
            change = tolerances.with_path if field == "path_tolerance" else tolerances.with_goal
            tolerances = change(index, new_tolerance)
    try:
        goal_time_s = resolve_tolerance(
            tolerances.goal_time_s, to_nanoseconds(goal.goal_time_tolerance) / NANOSECONDS_PER_SECOND
        )
    except ValueError:
        log("goal.goal_time_tolerance is negative and not -1. Using default tolerances.")
        return default
    return Tolerances(tolerances.path, tolerances.goal, goal_time_s)
