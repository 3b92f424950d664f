"""Gripper controllers: action servers that open and close a gripper.

``position_controllers/GripperActionController`` forwards the position, ``effort_controllers/GripperActionController``
computes an effort by PID from the position error, and ``parallel_gripper_action_controller/GripperActionController``
also forwards the maximum effort and velocity.

Source: ros2_controllers (parameters, actions, and the conditions for a reached goal and a stalled gripper).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import isfinite
from typing import Any, ClassVar, TypeVar

from linkwright.control.controllers.action import ControllerAction, Goal
from linkwright.control.controllers.controller import Controller, ControllerError, InterfaceNames
from linkwright.control.controllers.pid_parameters import PidParameters
from linkwright.control.hardware.interfaces import EFFORT, POSITION, VELOCITY
from linkwright.control.motion.pid import Pid
from linkwright.diagnostics import phrase
from linkwright.messages import JointState, get_action
from linkwright.nodes.parameter_tables import at_least, for_each, not_empty, parameter
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND


@dataclass(frozen=True, kw_only=True)
class GripperParameters:
    """Parameters of all grippers."""

    action_monitor_rate: float = parameter(20.0, description="the rate of feedback, in Hz", check=at_least(0.1))
    joint: str = parameter("", read_only=True, description="the joint of the gripper", check=not_empty)
    goal_tolerance: float = parameter(0.01, description="the maximum final error, in rad or m", check=at_least(0.0))
    max_effort: float = parameter(0.0, description="the maximum effort, Nm or N; 0 for any", check=at_least(0.0))
    allow_stalling: bool = parameter(False, description="whether a goal succeeds when the gripper stalls")
    stall_velocity_threshold: float = parameter(0.001, description="the velocity that counts as 0, in rad/s or m/s")
    stall_timeout: float = parameter(
        1.0, description="the time without motion after which the gripper has stalled, in seconds", check=at_least(0.0)
    )


@dataclass(frozen=True, kw_only=True)
class EffortGripperParameters(GripperParameters):
    """Parameters of the gripper that commands efforts."""

    gains: Mapping[str, PidParameters] = for_each("joint", PidParameters)


@dataclass(frozen=True, kw_only=True)
class ParallelGripperParameters(GripperParameters):
    """Parameters of the gripper with interfaces for the maximum effort and velocity."""

    max_effort: float = parameter(
        10.0, description="the maximum effort for goals without an effort, in N", check=at_least(0.0)
    )
    max_velocity: float = parameter(
        0.1, description="the maximum velocity for goals without a velocity, in m/s", check=at_least(0.0)
    )
    state_interfaces: tuple[str, ...] = (POSITION, VELOCITY)
    max_effort_interface: str = parameter("", description="the command interface for the maximum effort")
    max_velocity_interface: str = parameter("", description="the command interface for the maximum velocity")


P = TypeVar("P", bound=GripperParameters)


class Gripper(Controller[P]):
    """The base class of gripper controllers.

    The class accepts goals, and determines when they end.
    """

    ACTION: ClassVar[str] = "control_msgs/action/GripperCommand"

    def command_interfaces(self) -> InterfaceNames:
        """Return the position interface of the joint."""
        return [f"{self.parameters.joint}/{POSITION}"]

    def state_interfaces(self) -> InterfaceNames:
        """Return the position and velocity interfaces of the joint."""
        return [f"{self.parameters.joint}/{kind}" for kind in (POSITION, VELOCITY)]

    def on_configure(self) -> None:
        """Create the action server."""
        self._active = False
        self._goal: Goal | None = None
        action_class = get_action(self.ACTION)
        self._result, self._feedback = action_class.Result, action_class.Feedback
        self._action = ControllerAction(
            self.node, self.ACTION, "~/gripper_cmd", is_allowed=self._is_allowed, begin=self._begin, cancel=self._cancel
        )

    def on_activate(self) -> None:
        """Hold the gripper at its current position."""
        self._position_state, self._velocity_state = self.states[0], self.states[1]
        if not isfinite(self._position_state.value):
            raise ControllerError(phrase("the positions of the joints are not known yet"))
        self._hold_position()
        self._goal = None
        self._last_motion_ns = self._next_feedback_ns = 0
        self._active = True

    def on_deactivate(self) -> None:
        """Cancel the active goal."""
        self._active = False
        self._cancel_goal()

    def on_cleanup(self) -> None:
        """Remove the action server."""
        self._action.close()

    def update(self, time_ns: int, period_s: float) -> None:
        """Command the gripper, and end the goal if it is reached or the gripper is stalled."""
        position, velocity = self._position_state.value, self._velocity_state.value
        effort = self._write_commands(self._target - position, velocity, period_s)
        goal = self._goal
        if goal is None:
            return
        if time_ns >= self._next_feedback_ns:
            self._next_feedback_ns = time_ns + round(NANOSECONDS_PER_SECOND / self.parameters.action_monitor_rate)
            goal.publish_feedback(self._fill_message(self._feedback(), position, velocity, effort))
        if abs(velocity) > self.parameters.stall_velocity_threshold:
            self._last_motion_ns = time_ns
        is_reached = abs(self._target - position) < self.parameters.goal_tolerance
        is_stalled = (
            not is_reached and time_ns - self._last_motion_ns > self.parameters.stall_timeout * NANOSECONDS_PER_SECOND
        )
        if not is_reached and not is_stalled:
            return
        result = self._fill_message(self._result(), position, velocity, effort)
        result.reached_goal, result.stalled = is_reached, is_stalled
        end = goal.succeed if is_reached or self.parameters.allow_stalling else goal.abort
        end(result)
        self._goal = None

    # --- goals --------------------------------------------------------------------------------------------------------

    def _is_allowed(self, request: Any) -> bool:
        error = self._find_goal_error(request)
        if not self._active:
            error = "Can't accept new action goals. Controller is not running."
        if error is not None:
            self.node.logger.error(error)
            return False
        self.node.logger.info("Received & accepted new action goal")
        return True

    def _begin(self, goal: Goal) -> None:
        self._cancel_goal()
        if not self._active:
            goal.abort(self._result())
            return
        self._store_goal(goal.request)
        self._goal = goal
        self._last_motion_ns = self.time_ns
        self._next_feedback_ns = 0

    def _cancel(self, goal: Goal) -> None:
        self.node.logger.info("Got request to cancel goal")
        if self._goal is goal:
            self.node.logger.info("Canceling active action goal because cancel callback received.")
            self._cancel_goal()
            self._hold_position()

    def _cancel_goal(self) -> None:
        if self._goal is not None:
            self._goal.cancel(self._result())
            self._goal = None

    def _hold_position(self) -> None:
        self._target = self._position_state.value
        self._max_effort = self.parameters.max_effort

    # --- steps that differ between grippers ---------------------------------------------------------------------------

    def _find_goal_error(self, request: Any) -> str | None:
        """Return the error message for an invalid goal, or None if the goal is valid."""
        if isfinite(request.command.position):
            return None
        return "Received action goal with a position that is not a number"

    def _store_goal(self, request: Any) -> None:
        """Store the position and maximum effort of a goal."""
        self._target = request.command.position
        self._max_effort = request.command.max_effort

    def _write_commands(self, error: float, velocity: float, period_s: float) -> float:
        """Write the commands, and return the effort to report.

        By default, the reported effort is the maximum effort.
        """
        self.commands[0].value = self._target
        return self._max_effort

    def _fill_message(self, message: Any, position: float, velocity: float, effort: float) -> Any:
        """Set the fields of a result or feedback message, and return the message."""
        message.position, message.effort = position, effort
        return message


class PositionGripper(Gripper[GripperParameters]):
    """``position_controllers/GripperActionController``."""

    PARAMETERS = GripperParameters


class EffortGripper(Gripper[EffortGripperParameters]):
    """``effort_controllers/GripperActionController``."""

    PARAMETERS = EffortGripperParameters

    def command_interfaces(self) -> InterfaceNames:
        """Return the effort interface of the joint."""
        return [f"{self.parameters.joint}/{EFFORT}"]

    def on_activate(self) -> None:
        """Hold the gripper at its current position."""
        self._pid = Pid(self.parameters.gains[self.parameters.joint].pid)
        super().on_activate()

    def on_deactivate(self) -> None:
        """Cancel the active goal, and command zero effort."""
        super().on_deactivate()
        self.commands[0].value = 0.0

    def _write_commands(self, error: float, velocity: float, period_s: float) -> float:
        self._pid.gains = self.parameters.gains[self.parameters.joint].pid
        effort = self._pid.command(error, period_s, -velocity)
        limit = abs(self._max_effort)
        if limit:
            effort = min(max(effort, -limit), limit)
        self.commands[0].value = effort
        return effort


class ParallelGripper(Gripper[ParallelGripperParameters]):
    """``parallel_gripper_action_controller/GripperActionController``."""

    PARAMETERS = ParallelGripperParameters
    ACTION = "control_msgs/action/ParallelGripperCommand"

    def command_interfaces(self) -> InterfaceNames:
        """Return the position interface, and the interfaces for maximum effort and velocity.

        The last two are left out if the parameters do not name them.
        """
        parameters = self.parameters
        limit_interfaces = [
            name for name in (parameters.max_effort_interface, parameters.max_velocity_interface) if name
        ]
        return [f"{parameters.joint}/{POSITION}", *limit_interfaces]

    def _hold_position(self) -> None:
        super()._hold_position()
        self._max_velocity = self.parameters.max_velocity

    def _find_goal_error(self, request: Any) -> str | None:
        positions = request.command.position
        if len(positions) != 1:
            return f"Received action goal with wrong number of position values, expects 1, got {len(positions)}"
        return None if isfinite(positions[0]) else "Received action goal with a position that is not a number"

    def _store_goal(self, request: Any) -> None:
        parameters, command = self.parameters, request.command
        self._target = command.position[0]
        self._max_effort = (
            command.effort[0] if parameters.max_effort_interface and len(command.effort) else parameters.max_effort
        )
        uses_goal_velocity = parameters.max_velocity_interface and len(command.velocity)
        self._max_velocity = command.velocity[0] if uses_goal_velocity else parameters.max_velocity

    def _write_commands(self, error: float, velocity: float, period_s: float) -> float:
        effort = super()._write_commands(error, velocity, period_s)
        limits = iter(self.commands[1:])
        if self.parameters.max_effort_interface:
            next(limits).value = self._max_effort
        if self.parameters.max_velocity_interface:
            next(limits).value = self._max_velocity
        return effort

    def _fill_message(self, message: Any, position: float, velocity: float, effort: float) -> Any:
        message.state = JointState(
            name=[self.parameters.joint], position=[position], velocity=[velocity], effort=[effort]
        )
        return message
