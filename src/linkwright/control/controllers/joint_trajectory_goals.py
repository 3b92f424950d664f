"""Validation of trajectory messages, and their conversion to trajectories of all joints of a controller.

Source: joint_trajectory_controller of ros2_controllers (error messages, effects of missing joints, tolerances of
goals).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import isfinite
from typing import Any

from linkwright.control.controllers.joint_trajectory_parameters import Parameters
from linkwright.control.motion.splines import MotionState
from linkwright.control.motion.tolerances import Tolerances, resolved
from linkwright.control.motion.trajectory import Trajectory, TrajectoryPoint
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_STANDING = 1.1920929e-07
"""The greatest velocity that counts as none, in rad/s or m/s: the distance of 1 to the next number of 32 bits."""


def nanoseconds(time: Any) -> int:
    """Convert a time or duration message to nanoseconds."""
    return int(time.sec) * NANOSECONDS_PER_SECOND + int(time.nanosec)


def objection(message: Any, parameters: Parameters, now_ns: int) -> str | None:
    """Return ros2_controllers' error message for an invalid trajectory, or None if it is valid.

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
    start, last = nanoseconds(message.header.stamp), points[-1]
    end = start + nanoseconds(last.time_from_start)
    if start and end < now_ns:
        return (
            f"Received trajectory with non-zero start time ({start / NANOSECONDS_PER_SECOND:f}) that ends in the past "
            f"({end / NANOSECONDS_PER_SECOND:f})"
        )
    for number, name in enumerate(names):
        if name not in parameters.joints:
            return f"Incoming joint {name} doesn't match the controller's joints."
        if name in names[:number]:
            return f"Incoming joint {name} appears twice."
    if not parameters.allow_nonzero_velocity_at_trajectory_end:
        for name, velocity in zip(names, last.velocities, strict=False):
            if abs(velocity) > _STANDING:
                return f"Velocity of last trajectory point of joint {name} is not zero: {velocity:.15f}"
    return _objection_to_points(points, len(names), integrated=parameters.allow_integration_in_goal_trajectories)


def _objection_to_points(points: Sequence[Any], count: int, *, integrated: bool) -> str | None:
    before = 0
    for number, point in enumerate(points):
        time = nanoseconds(point.time_from_start)
        if number and time <= before:
            return (
                f"Time between points {number - 1} and {number} is not strictly increasing, "
                f"it is {before / NANOSECONDS_PER_SECOND:f} and {time / NANOSECONDS_PER_SECOND:f} respectively"
            )
        before = time
        lists = {field: getattr(point, field) for field in ("positions", "velocities", "accelerations")}
        if not any(len(values) for values in lists.values()) and integrated:
            return f"Point #{number} has neither positions nor velocities nor accelerations."
        for name, values in lists.items():
            may_lack = integrated or name != "positions"
            if len(values) != count and not (may_lack and not len(values)):
                return f"Mismatch between joint_names size ({count}) and {name} ({len(values)}) at point #{number}."
            if not all(map(isfinite, values)):
                return f"The {name} at point #{number} are not all finite."
        if len(point.effort):
            return "Trajectories with effort fields are currently not supported."
    return None


def trajectory_of(message: Any, parameters: Parameters, held: Sequence[float]) -> Trajectory:
    """Convert a message to a trajectory of all joints of a controller.

    Args:
        message: trajectory_msgs/msg/JointTrajectory, which must be valid (see `objection`).
        parameters: the parameters of the controller.
        held: the positions of all joints, in rad or m, used for joints that the message does not name.
    """
    places = [message.joint_names.index(name) if name in message.joint_names else -1 for name in parameters.joints]

    def ordered(values: Sequence[float], missing: Sequence[float]) -> list[float]:
        if not len(values):
            return []
        return [float(values[each]) if each >= 0 else other for each, other in zip(places, missing, strict=True)]

    still = [0.0] * len(places)
    points = [
        TrajectoryPoint(
            nanoseconds(point.time_from_start),
            MotionState(
                ordered(point.positions, held),
                ordered(point.velocities, still),
                ordered(point.accelerations, still),
            ),
        )
        for point in message.points
    ]
    interpolated = parameters.interpolation_method == "splines"
    return Trajectory(points, nanoseconds(message.header.stamp), interpolated=interpolated)


def tolerances_of(goal: Any, joints: Sequence[str], default: Tolerances, log: Callable[[str], object]) -> Tolerances:
    """Return the controller's tolerances, overridden for the joints that the goal names.

    Args:
        goal: control_msgs/action/FollowJointTrajectory_Goal.
        joints: the joints of the controller.
        default: the controller's tolerances, which are returned if a tolerance of the goal is invalid.
        log: called with each error message.
    """
    tolerances = default
    for field, given in (("path_tolerance", goal.path_tolerance), ("goal_tolerance", goal.goal_tolerance)):
        for tolerance in given:
            if tolerance.name not in joints:
                log(f"joint '{tolerance.name}' specified in goal.{field} does not exist. Using default tolerances.")
                return default
            index = joints.index(tolerance.name)
            known = (tolerances.path if field == "path_tolerance" else tolerances.goal)[index]
            try:
                changed = known.overridden(tolerance.position, tolerance.velocity, tolerance.acceleration)
            except ValueError:
                log(f"joint '{tolerance.name}' specified in goal.{field} has a negative tolerance that is not -1.")
                log("Using default tolerances.")
                return default
            change = tolerances.with_path if field == "path_tolerance" else tolerances.with_goal
            tolerances = change(index, changed)
    try:
        time = resolved(tolerances.goal_time_s, nanoseconds(goal.goal_time_tolerance) / NANOSECONDS_PER_SECOND)
    except ValueError:
        log("goal.goal_time_tolerance is negative and not -1. Using default tolerances.")
        return default
    return Tolerances(tolerances.path, tolerances.goal, time)
