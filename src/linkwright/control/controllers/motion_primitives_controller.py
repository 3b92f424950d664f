"""``motion_primitives_controllers/MotionPrimitivesForwardController``: motions for an industrial robot's own planner.

Source: ros2_controllers (parameter, names and codes of the interfaces, action, and the order of markers and motions).
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum
from math import isfinite, nan
from typing import Any

from linkwright.control.controllers.action import ControllerAction, Goal
from linkwright.control.controllers.controller import Controller, ControllerError, InterfaceNames
from linkwright.diagnostics import phrase
from linkwright.messages import get_action, get_message
from linkwright.nodes.parameter_tables import parameter

_ACTION = "control_msgs/action/ExecuteMotionPrimitiveSequence"
_QUEUE_SIZE = 1024
_MAX_JOINTS = 6
_POSE = ("x", "y", "z", "qx", "qy", "qz", "qw")
_ARGUMENTS = ("velocity", "acceleration", "move_time")
_COMMANDS = (
    "motion_type",
    *(f"q{number}" for number in range(1, _MAX_JOINTS + 1)),
    *(f"pos_{name}" for name in _POSE),
    *(f"pos_via_{name}" for name in _POSE),
    "blend_radius",
    *_ARGUMENTS,
)


class Motion(IntEnum):
    """The motion types, and the commands that share their interface."""

    LINEAR_JOINT = 0
    LINEAR_CARTESIAN = 50
    CIRCULAR_CARTESIAN = 51
    STOP_MOTION = 66
    RESET_STOP = 67
    MOTION_SEQUENCE_START = 100
    MOTION_SEQUENCE_END = 101


class Execution(IntEnum):
    """The values of the state interface ``execution_status``."""

    IDLE = 0
    EXECUTING = 1
    SUCCESS = 2
    ERROR = 3
    STOPPING = 4
    STOPPED = 5


class Readiness(IntEnum):
    """The values of the state interface ``ready_for_new_primitive``."""

    NOT_READY = 0
    READY = 1


@dataclass(frozen=True, kw_only=True)
class MotionPrimitivesParameters:
    """Parameters of the controller."""

    tf_prefix: str = parameter("", read_only=True, description="the prefix of the names of all interfaces")


class MotionPrimitivesForwardController(Controller[MotionPrimitivesParameters]):
    """A controller that forwards motions one by one, as soon as the hardware is ready for the next."""

    PARAMETERS = MotionPrimitivesParameters

    def command_interfaces(self) -> InterfaceNames:
        """Return the interfaces that describe a motion."""
        return [f"{self.parameters.tf_prefix}motion_primitive/{name}" for name in _COMMANDS]

    def state_interfaces(self) -> InterfaceNames:
        """Return the interfaces that report the execution."""
        names = ("execution_status", "ready_for_new_primitive")
        return [f"{self.parameters.tf_prefix}motion_primitive/{name}" for name in names]

    # --- lifecycle ----------------------------------------------------------------------------------------------------

    def on_configure(self) -> None:
        """Create the action server."""
        self._active = False
        self._goal: Goal | None = None
        self._queue: deque[Any] = deque()
        self._is_stop_requested = self._is_cancel_requested = False
        self._action_class = get_action(_ACTION)
        self._primitive_class = get_message("control_msgs/msg/MotionPrimitive")
        self._action = ControllerAction(
            self.node, _ACTION, "~/motion_sequence", is_allowed=self._is_allowed, begin=self._begin, cancel=self._cancel
        )

    def on_activate(self) -> None:
        """Command no motion."""
        self._reset_commands()
        self._was_executing = self._has_reported_error = False
        self._active = True

    def on_deactivate(self) -> None:
        """Command no motion, and end the goal."""
        self._active = False
        self._reset_commands()
        self._queue.clear()
        self._is_cancel_requested = self._is_stop_requested = False
        if self._goal is not None:
            self._goal.cancel(self._action_class.Result())
            self._goal = None

    def on_cleanup(self) -> None:
        """Remove the action server."""
        self._action.close()

    # --- updates ------------------------------------------------------------------------------------------------------

    def update(self, time_ns: int, period_s: float) -> None:
        """Stop if that was requested, end a goal that has been executed, and forward the next motion.

        Raises:
            ControllerError: a state has an undefined value.
        """
        if self._is_cancel_requested:
            self._is_cancel_requested = False
            self.node.logger.info("Cancel requested, stopping execution.")
            self._reset_commands()
            self.commands[0].value = float(Motion.STOP_MOTION)
            self._queue.clear()
            self._is_stop_requested = True
        self._handle_status(Execution(self._read_state(0, Execution)))
        if self._read_state(1, Readiness) and self._queue:
            self._write_motion(self._queue.popleft())

    def _read_state(self, index: int, values: type[IntEnum]) -> IntEnum:
        """Return a state; a value that is not known yet counts as 0."""
        state = self.states[index]
        value = round(state.value) if isfinite(state.value) else 0
        if value in list(values):
            return values(value)
        raise ControllerError(
            phrase("the state '{name}' has the undefined value {value}", name=state.name, value=value)
        )

    def _handle_status(self, status: Execution) -> None:
        if status is not Execution.ERROR:
            self._has_reported_error = False
        elif not self._has_reported_error:
            self._has_reported_error = True
            self.node.logger.error("Execution state: ERROR")
        if status is Execution.EXECUTING:
            self._was_executing = True
        elif status is Execution.SUCCESS and self._was_executing and self._goal is not None:
            self._was_executing = False
            self._succeed()
        elif status in (Execution.STOPPING, Execution.STOPPED, Execution.ERROR):
            self._was_executing = False
        if status is Execution.STOPPED:
            self._finish_stop()

    def _succeed(self) -> None:
        result = self._action_class.Result(
            error_code=self._action_class.Result.SUCCESSFUL, error_string="Motion primitives executed successfully"
        )
        if self._goal is not None:
            self._goal.succeed(result)
            self._goal = None
        self.node.logger.info("Motion primitives executed successfully.")

    def _finish_stop(self) -> None:
        """End the goal after a stop, and allow new motions."""
        if self._goal is not None:
            self._goal.cancel(self._action_class.Result())
            self._goal = None
            self.node.logger.info("Motion primitives execution canceled.")
        if self._is_stop_requested:
            self._is_stop_requested = False
            self._reset_commands()
            self.commands[0].value = float(Motion.RESET_STOP)
            self.node.logger.info("Robot stopped, ready for new motion primitives.")

    def _reset_commands(self) -> None:
        for command in self.commands:
            command.value = nan

    def _write_motion(self, motion: Any) -> None:
        """Write a motion; interfaces that it does not describe keep their values, as in ros2_controllers."""
        values: dict[str, float] = {"motion_type": float(motion.type), "blend_radius": motion.blend_radius}
        values |= {f"q{index + 1}": value for index, value in enumerate(motion.joint_positions)}
        if len(motion.poses):
            values |= _name_pose("pos_", motion.poses[0].pose)
            if motion.type == Motion.CIRCULAR_CARTESIAN and len(motion.poses) == 2:
                values |= _name_pose("pos_via_", motion.poses[1].pose)
        for argument in motion.additional_arguments:
            if argument.name in _ARGUMENTS:
                values[argument.name] = argument.value
            else:
                self.node.logger.warning(f"Unknown additional argument: {argument.name}")
        for name, command in zip(_COMMANDS, self.commands, strict=True):
            if name in values:
                command.value = float(values[name])

    # --- goals --------------------------------------------------------------------------------------------------------

    def _is_allowed(self, request: Any) -> bool:
        error = self._find_goal_error(request.trajectory.motions)
        if error is not None:
            self.node.logger.error(error)
            return False
        self.node.logger.info("Accepted new action goal")
        return True

    def _find_goal_error(self, motions: Sequence[Any]) -> str | None:
        """Return why a goal is rejected, or None."""
        if not self._active:
            return "Can't accept new trajectories. Controller is not running."
        if self._goal is not None:
            return "Already has an active goal, rejecting new goal request."
        if self._is_stop_requested or self._is_cancel_requested:
            return "Robot requested to stop. Discarding the new command."
        if not motions:
            return "Goal rejected: no motion primitives provided."
        if len(motions) + 2 > _QUEUE_SIZE:
            return (
                f"Remaining queue capacity ({_QUEUE_SIZE}) is not enough for the requested {len(motions)} motion "
                "primitives (+ start and stop marker)."
            )
        errors = (_find_motion_error(index, motion) for index, motion in enumerate(motions))
        return next((error for error in errors if error is not None), None)

    def _begin(self, goal: Goal) -> None:
        if not self._active or self._goal is not None:
            goal.abort(self._action_class.Result(error_code=self._action_class.Result.INVALID_GOAL))
            return
        motions = list(goal.request.trajectory.motions)
        if len(motions) > 1:
            markers = (Motion.MOTION_SEQUENCE_START, Motion.MOTION_SEQUENCE_END)
            start, end = (self._primitive_class(type=int(marker)) for marker in markers)
            motions = [start, *motions, end]
        self._queue.extend(motions)
        self._goal = goal

    def _cancel(self, goal: Goal) -> None:
        self.node.logger.info("Got request to cancel goal")
        if goal is self._goal:
            self._is_cancel_requested = True


def _name_pose(prefix: str, pose: Any) -> dict[str, float]:
    """Return the values of a pose by the names of their interfaces."""
    values = [getattr(pose.position, axis) for axis in "xyz"] + [getattr(pose.orientation, axis) for axis in "xyzw"]
    return {f"{prefix}{name}": value for name, value in zip(_POSE, values, strict=True)}


def _find_motion_error(index: int, motion: Any) -> str | None:
    """Return why a motion is invalid, or None."""
    if motion.type == Motion.LINEAR_JOINT:
        if not len(motion.joint_positions):
            return f"Primitive {index} invalid: LINEAR_JOINT requires joint_positions."
        if len(motion.joint_positions) > _MAX_JOINTS:
            return f"Primitive {index} invalid: LINEAR_JOINT has more than {_MAX_JOINTS} joint_positions."
    elif motion.type == Motion.LINEAR_CARTESIAN:
        if not len(motion.poses):
            return f"Primitive {index} invalid: LINEAR_CARTESIAN requires at least one pose."
    elif motion.type == Motion.CIRCULAR_CARTESIAN:
        if len(motion.poses) != 2:
            return f"Primitive {index} invalid: CIRCULAR_CARTESIAN requires exactly two poses."
    else:
        return f"Primitive {index} invalid: unknown motion type {motion.type}."
    return None
