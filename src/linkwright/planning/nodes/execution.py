"""Execution of trajectories by the controllers of MoveIt's simple controller manager."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.graph import ActionClient, Node
from linkwright.graph.actions.goal import GoalStatus
from linkwright.graph.loop.node_handle import ReentrantCallbackGroup
from linkwright.messages import get_action, get_message
from linkwright.planning.nodes.conversions import RequestError, joint_state_message, update_positions
from linkwright.planning.nodes.robot_context import RobotContext
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_ACTIONS = {
    "FollowJointTrajectory": "control_msgs/action/FollowJointTrajectory",
    "GripperCommand": "control_msgs/action/GripperCommand",
    "ParallelGripperCommand": "control_msgs/action/ParallelGripperCommand",
}
_SERVER_TIMEOUT_S = 5.0
_POLL_S = 0.02
_START_TOLERANCE = 0.01
"""The distance in rad or m of the robot from the start of a trajectory that is accepted by default."""
_DURATION_SCALING, _DURATION_MARGIN_S = 1.1, 0.5
"""The factor of a trajectory's duration and the time in s after it within which controllers must end by default."""
_PREFIX = "trajectory_execution."
_SCALING_PARAMETER, _MARGIN_PARAMETER = "allowed_execution_duration_scaling", "allowed_goal_duration_margin"


@dataclass(frozen=True, slots=True)
class ControllerSettings:
    """A controller in ``moveit_controllers.yaml``.

    Attributes:
        action: the name of the action.
        type: the type of the action without its package.
        joints: the joints that the controller moves.
        is_default: whether to prefer it to other controllers of the same joints.
        max_effort: the effort of gripper commands.
        duration_scaling: the factor of a trajectory's duration within which the controller must end; None for the
            factor of all controllers.
        duration_margin_s: the time in s after it; None for the time of all controllers.
    """

    name: str
    action: str
    type: str
    joints: tuple[str, ...]
    is_default: bool = False
    max_effort: float = 0.0
    duration_scaling: float | None = None
    duration_margin_s: float | None = None


def read_controllers(parameters: Mapping[str, Any]) -> tuple[list[ControllerSettings], list[str]]:
    """Return the controllers in the parameters, and the errors of other controllers.

    The parameters are those of ``moveit_simple_controller_manager``.

    Args:
        parameters: the parameters of move_group by name.
    """
    prefix = "moveit_simple_controller_manager."
    controllers, problems = [], []
    for name in parameters.get(f"{prefix}controller_names") or ():
        values = {
            key: parameters.get(f"{prefix}{name}.{key}")
            for key in (
                *("action_ns", "type", "joints", "default", "max_effort"),
                *(_SCALING_PARAMETER, _MARGIN_PARAMETER),
            )
        }
        if not values["joints"]:
            problems.append(f"joints not specified for controller {name}")
        elif values["type"] not in _ACTIONS:
            problems.append(f"Unknown controller type: {values['type']}")
        else:
            action = f"{name}/{values['action_ns']}" if values["action_ns"] else name
            controllers.append(
                ControllerSettings(
                    name,
                    action,
                    values["type"],
                    tuple(values["joints"]),
                    bool(values["default"]),
                    float(values["max_effort"] or 0.0),
                    values[_SCALING_PARAMETER],
                    values[_MARGIN_PARAMETER],
                )
            )
    return controllers, problems


class TrajectoryExecution:
    """The controllers, and the trajectories that they execute.

    Args:
        node: the node that sends the goals.
        controllers: the controllers.
        parameters: the parameters by name, among them those of ``trajectory_execution``.
    """

    def __init__(self, node: Node, controllers: Sequence[ControllerSettings], parameters: Mapping[str, Any]) -> None:
        self._controllers = controllers
        self._parameters = parameters
        self._clock = node.get_clock()
        self._timebase = node.graph.timebase
        group = ReentrantCallbackGroup()
        self._clients = {
            controller.name: ActionClient(node, _ACTIONS[controller.type], controller.action, callback_group=group)
            for controller in controllers
        }
        self._handles: list[Any] = []
        self._is_stopped = False

    async def execute(self, trajectory: Any, is_canceled: Callable[[], bool]) -> None:
        """Execute a moveit_msgs/msg/RobotTrajectory, and return when all controllers are done.

        Controllers that take too long are stopped. As in MoveIt, they have 1.1 times the duration of the trajectory and
        0.5 s by default; unlike there, the time is that of the node's clock, so that a slow simulation is not too late.

        Args:
            trajectory: the trajectory.
            is_canceled: returns whether the execution must stop.

        Raises:
            RequestError: no controllers move these joints, or a controller failed, took too long or was stopped.
        """
        joint_trajectory = trajectory.joint_trajectory
        if not joint_trajectory.points:
            return
        if is_canceled():
            raise RequestError("PREEMPTED", "the execution was canceled")
        self._is_stopped = False
        controllers = self._select(joint_trajectory.joint_names)
        handles = [await self._send(controller, joint_trajectory) for controller in controllers]
        self._handles = [handle for handle, _ in handles]
        pending = [result for _, result in handles]
        start, limit_s = self._clock.now(), self._find_time_limit_s(controllers, joint_trajectory)
        while not all(result.done() for result in pending):
            if self._is_stopped or is_canceled():
                self._cancel_all()
                raise RequestError("PREEMPTED", "the execution was stopped")
            if (self._clock.now() - start).nanoseconds > limit_s * NANOSECONDS_PER_SECOND:
                self._cancel_all()
                raise RequestError(
                    "TIMED_OUT",
                    f"Controller is taking too long to execute trajectory (the expected upper bound for the trajectory "
                    f"execution was {limit_s:f} seconds). Stopping trajectory.",
                )
            await self._pause()
        for controller, result in zip(controllers, pending, strict=True):
            response = result.result()
            if response.status != GoalStatus.SUCCEEDED:
                text = getattr(response.result, "error_string", "")
                raise RequestError("CONTROL_FAILED", f"Controller '{controller.name}' failed: {text or 'aborted'}")

    def stop(self) -> None:
        """Stop the current execution."""
        self._is_stopped = True

    async def _pause(self) -> None:
        """Wait until the next check; in lockstep, on the clock of the graph."""
        if not self._timebase.is_lockstep:
            await asyncio.sleep(_POLL_S)
            return
        loop = asyncio.get_running_loop()
        due = asyncio.Event()
        self._timebase.call_at(loop, self._timebase.steady_ns() + round(_POLL_S * NANOSECONDS_PER_SECOND), due.set)
        await due.wait()

    def _find_time_limit_s(self, controllers: Sequence[ControllerSettings], trajectory: Any) -> float:
        """Return the time in s after which an execution is stopped; infinite if it is not monitored."""
        if not self._parameters.get(f"{_PREFIX}execution_duration_monitoring", True):
            return math.inf
        scaling = self._parameters.get(f"{_PREFIX}{_SCALING_PARAMETER}", _DURATION_SCALING)
        margin_s = self._parameters.get(f"{_PREFIX}{_MARGIN_PARAMETER}", _DURATION_MARGIN_S)
        end = trajectory.points[-1].time_from_start
        duration_s = end.sec + end.nanosec / NANOSECONDS_PER_SECOND
        limits: list[float] = [
            duration_s * (scaling if controller.duration_scaling is None else controller.duration_scaling)
            + (margin_s if controller.duration_margin_s is None else controller.duration_margin_s)
            for controller in controllers
        ]
        return max(limits)

    def _cancel_all(self) -> None:
        for handle in self._handles:
            handle.cancel_goal_async()

    def _select(self, joints: Sequence[str]) -> list[ControllerSettings]:
        """Return controllers that together move the joints, each joint by one of them."""
        remaining = set(joints)
        selected = []
        for controller in sorted(self._controllers, key=lambda item: (not item.is_default, -len(item.joints))):
            if remaining.intersection(controller.joints):
                selected.append(controller)
                remaining.difference_update(controller.joints)
        if remaining:
            raise RequestError(
                "CONTROL_FAILED",
                f"Unable to identify any set of controllers that can actuate the specified joints: "
                f"[ {' '.join(sorted(remaining))} ]",
            )
        return selected

    async def _send(self, controller: ControllerSettings, trajectory: Any) -> tuple[Any, Any]:
        """Send a controller its part of a trajectory.

        Return the handle of the goal, and the future of the result.
        """
        client = self._clients[controller.name]
        for _ in range(round(_SERVER_TIMEOUT_S / _POLL_S)):
            if client.server_is_ready():
                break
            await self._pause()
        else:
            raise RequestError("CONTROL_FAILED", f"Action client not connected to action server: {controller.action}")
        handle = await client.send_goal_async(_make_goal(controller, trajectory))
        if handle is None or not handle.accepted:
            raise RequestError("CONTROL_FAILED", f"Goal request rejected by controller '{controller.name}'")
        return handle, handle.get_result_async()


def _make_goal(controller: ControllerSettings, trajectory: Any) -> Any:
    goal = get_action(_ACTIONS[controller.type]).Goal()
    names = [name for name in trajectory.joint_names if name in controller.joints]
    indexes = [trajectory.joint_names.index(name) for name in names]
    if controller.type == "GripperCommand":
        goal.command.position = float(trajectory.points[-1].positions[indexes[0]])
        goal.command.max_effort = controller.max_effort
    elif controller.type == "ParallelGripperCommand":
        goal.command.name = names
        goal.command.position = [trajectory.points[-1].positions[index] for index in indexes]
    else:
        part = goal.trajectory
        part.joint_names = names
        point_class = get_message("trajectory_msgs/msg/JointTrajectoryPoint")
        for point in trajectory.points:
            selected = point_class()
            for field in ("positions", "velocities", "accelerations"):
                values = getattr(point, field)
                setattr(selected, field, [values[index] for index in indexes] if len(values) else [])
            selected.time_from_start = point.time_from_start
            part.points.append(selected)
    return goal


def check_start(trajectory: Any, robot: RobotContext, parameters: Mapping[str, Any]) -> None:
    """Raise RequestError if a trajectory does not start where the robot is.

    Args:
        trajectory: a trajectory_msgs/msg/JointTrajectory.
        robot: the robot with its current state.
        parameters: the parameters by name, among them ``trajectory_execution.allowed_start_tolerance``.
    """
    tolerance = float(parameters.get(f"{_PREFIX}allowed_start_tolerance", _START_TOLERANCE))
    if not trajectory.points or tolerance <= 0.0 or not robot.has_state:
        return
    names = robot.model.joint_names
    first = joint_state_message(trajectory.joint_names, trajectory.points[0].positions)
    differences = np.abs(update_positions(names, robot.positions, first) - robot.positions)
    differences = np.minimum(differences, np.abs(differences - 2.0 * np.pi))
    farthest = int(np.argmax(differences))
    if differences[farthest] > tolerance:
        raise RequestError(
            "CONTROL_FAILED",
            f"Invalid Trajectory: start point deviates from current robot state more than {tolerance:g} at joint "
            f"'{names[farthest]}'.",
        )
