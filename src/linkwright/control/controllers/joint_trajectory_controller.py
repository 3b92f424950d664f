"""``joint_trajectory_controller/JointTrajectoryController``: motion along trajectories.

Source: ros2_controllers (parameters, topics, action, service, times of commands, tolerances, messages). The controller
commands the point that the trajectory reaches at the next update. It checks the tolerances between the measured state
and the trajectory's point for the current time.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite
from typing import Any

from linkwright.control.controllers.action import ControllerAction, Goal
from linkwright.control.controllers.controller import Controller, ControllerError, InterfaceNames
from linkwright.control.controllers.joint_trajectory_goals import (
    find_trajectory_error,
    to_nanoseconds,
    tolerances_from_goal,
    trajectory_from_message,
)
from linkwright.control.controllers.joint_trajectory_parameters import Parameters
from linkwright.control.hardware.interfaces import (
    ACCELERATION,
    EFFORT,
    POSITION,
    VELOCITY,
    CommandInterface,
    Interface,
    StateInterface,
)
from linkwright.control.motion.pid import Pid
from linkwright.control.motion.splines import MotionState
from linkwright.control.motion.tolerances import StateTolerance
from linkwright.control.motion.trajectory import Sample, Trajectory, TrajectoryPoint, shortest_turn
from linkwright.diagnostics import phrase
from linkwright.messages import Header, Time, get_action, get_message
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_ACTION = "control_msgs/action/FollowJointTrajectory"


class JointTrajectoryController(Controller[Parameters]):
    """A controller that follows trajectories.

    Trajectories are received on the topic ``~/joint_trajectory`` and by the action ``~/follow_joint_trajectory``.
    """

    PARAMETERS = Parameters

    def command_interfaces(self) -> InterfaceNames:
        """Return the command interfaces, joint by joint."""
        parameters = self.parameters
        return [
            f"{joint}/{kind}"
            for joint in parameters.command_joints or parameters.joints
            for kind in parameters.command_interfaces
        ]

    def state_interfaces(self) -> InterfaceNames:
        """Return the state interfaces, joint by joint."""
        return [f"{joint}/{kind}" for joint in self.parameters.joints for kind in self.parameters.state_interfaces]

    # --- lifecycle ----------------------------------------------------------------------------------------------------

    def on_configure(self) -> None:
        """Create the publishers, the subscription, the service and the action server."""
        parameters = self.parameters
        self._check_parameters(parameters)
        self._active = False
        self._goal: Goal | None = None
        self._is_wrapped = [self._wraps_around(joint) for joint in parameters.joints]
        self._has_pid = parameters.has_pid
        self._create_pids(parameters)
        self._period_ns = round(NANOSECONDS_PER_SECOND / self.update_rate)
        state_type = "control_msgs/msg/JointTrajectoryControllerState"
        self._point_type = get_message("trajectory_msgs/msg/JointTrajectoryPoint")
        self._state_type = get_message(state_type)
        self._result = get_action(_ACTION).Result
        self._feedback_type = get_action(_ACTION).Feedback
        self._outputs = [self.node.publisher(state_type, topic) for topic in ("~/controller_state", "~/state")]
        self.node.subscribe("trajectory_msgs/msg/JointTrajectory", "~/joint_trajectory", self._on_trajectory)
        self.node.service("control_msgs/srv/QueryTrajectoryState", "~/query_state", self._on_query)
        self._action = ControllerAction(
            self.node,
            _ACTION,
            "~/follow_joint_trajectory",
            is_allowed=self._is_allowed,
            begin=self._begin,
            cancel=self._cancel,
        )

    def on_activate(self) -> None:
        """Hold the joints at their current positions."""
        parameters = self.parameters
        count = len(parameters.command_interfaces)
        self._command: dict[str, list[CommandInterface]] = {
            kind: self.commands[index::count] for index, kind in enumerate(parameters.command_interfaces)
        }
        count = len(parameters.state_interfaces)
        self._state: dict[str, list[StateInterface]] = {
            kind: self.states[index::count] for index, kind in enumerate(parameters.state_interfaces)
        }
        self._measured_states = tuple(self._state.get(kind, []) for kind in (POSITION, VELOCITY, ACCELERATION))
        self._has_velocity_error = VELOCITY in self._state and (VELOCITY in self._command or EFFORT in self._command)
        self._has_acceleration_error = ACCELERATION in self._state and ACCELERATION in self._command
        self._timeout_s = self._check_timeout(parameters)
        self._create_pids(parameters)
        self._current = self._read_state()
        if parameters.set_last_command_interface_value_as_state_on_activation:
            self._current = self._replace_by_commands(self._current)
        if not all(map(isfinite, self._current.positions)):
            raise ControllerError(phrase("the positions of the joints are not known yet"))
        self._last_command = self._current.copy()
        self._computed_error: MotionState | None = MotionState([0.0] * len(parameters.joints))
        self._goal = None
        self._next_state_ns = self._next_feedback_ns = 0
        self._next_sample: Sample | None = None
        self._hold(MotionState(list(self._current.positions)))
        self._active = True

    def on_deactivate(self) -> None:
        """Cancel the active goal, and command zero velocity, acceleration and effort."""
        self._active = False
        self._cancel_goal("Current goal cancelled during deactivate transition.")
        for kind in (VELOCITY, ACCELERATION, EFFORT):
            for command in self._command.get(kind, ()):
                command.value = 0.0

    def on_cleanup(self) -> None:
        """Remove the action server."""
        self._action.close()

    def _check_parameters(self, parameters: Parameters) -> None:
        if parameters.command_joints and len(parameters.command_joints) != len(parameters.joints):
            raise ControllerError("'command_joints' parameter has to have the same size as 'joints' parameter.")
        states = set(parameters.state_interfaces)
        for kind in (VELOCITY, EFFORT):
            if parameters.command_interfaces == (kind,) and not {POSITION, VELOCITY} <= states:
                raise ControllerError(
                    f"'{kind}' command interface can only be used alone if 'velocity' and 'position' state "
                    "interfaces are present"
                )

    def _create_pids(self, parameters: Parameters) -> None:
        self._pid_parameters = parameters
        self._pids = [Pid(parameters.gains[joint].pid) for joint in parameters.joints]
        self._velocity_scales = [parameters.gains[joint].ff_velocity_scale for joint in parameters.joints]

    def _wraps_around(self, joint: str) -> bool:
        gains = self.parameters.gains[joint]
        robot_joint = self.robot.joints.get(joint) if self.robot is not None else None
        return (
            gains.angle_wraparound
            or gains.normalize_error
            or (robot_joint is not None and robot_joint.type == "continuous")
        )

    def _check_timeout(self, parameters: Parameters) -> float:
        goal_time = parameters.constraints.goal_time
        if 0.0 < parameters.cmd_timeout <= goal_time:
            self.node.logger.warning(
                "Command timeout must be higher than goal_time tolerance "
                f"({parameters.cmd_timeout:f} vs. {goal_time:f})"
            )
            return 0.0
        return parameters.cmd_timeout

    # --- trajectories -------------------------------------------------------------------------------------------------

    def _on_trajectory(self, message: Any) -> None:
        error = find_trajectory_error(message, self.parameters, self.time_ns)
        if error is not None:
            self.node.logger.error(error)
        elif self._active:
            self._cancel_goal("Current goal cancelled due to new incoming trajectory.")
            self._tolerances = self.parameters.tolerances
            self._follow(trajectory_from_message(message, self.parameters, self._get_positions_to_hold()))

    def _is_allowed(self, request: Any) -> bool:
        self.node.logger.info("Received new action goal")
        error = find_trajectory_error(request.trajectory, self.parameters, self.time_ns)
        if not self._active:
            error = "Can't accept new action goals. Controller is not running."
        if error is not None:
            self.node.logger.error(error)
            return False
        self.node.logger.info("Accepted new action goal")
        return True

    def _begin(self, goal: Goal) -> None:
        if not self._active:
            goal.abort(self._result(error_code=self._result.INVALID_GOAL, error_string="Controller is not running."))
            return
        self._cancel_goal("Current goal cancelled due to new incoming action.")
        parameters = self.parameters
        self._goal = goal
        self._tolerances = tolerances_from_goal(
            goal.request, parameters.joints, parameters.tolerances, self.node.logger.error
        )
        self._follow(trajectory_from_message(goal.request.trajectory, parameters, self._get_positions_to_hold()))

    def _cancel(self, goal: Goal) -> None:
        self.node.logger.info("Got request to cancel goal")
        if self._goal is goal:
            self.node.logger.info("Canceling active action goal because cancel callback received.")
            self._goal = None
            goal.cancel(self._result())
            self._hold()

    def _cancel_goal(self, reason: str) -> None:
        if self._goal is not None:
            self._goal.cancel(self._result(error_code=self._result.INVALID_GOAL, error_string=reason))
            self._goal = None

    def _get_positions_to_hold(self) -> list[float]:
        """Return the positions for joints that a trajectory leaves out, in the order of the joints.

        These are the last commanded positions, or the current positions if no positions are commanded.
        """
        return self._get_finite_values_or(self._command.get(POSITION), self._current.positions)

    def _follow(self, trajectory: Trajectory) -> None:
        self._trajectory, self._is_held = trajectory, False
        self._next_sample_ns = -1

    def _hold(self, state: MotionState | None = None) -> None:
        """Hold the joints in a state, or at their current positions if the state is None."""
        held_state = MotionState(self._read_state().positions) if state is None else state
        self._follow(Trajectory([TrajectoryPoint(0, held_state)]))
        self._is_held = True
        self._tolerances = self.parameters.tolerances

    # --- states -------------------------------------------------------------------------------------------------------

    def _read_state(self) -> MotionState:
        positions, velocities, accelerations = self._measured_states
        return MotionState(
            [position.value for position in positions],
            [velocity.value for velocity in velocities],
            [acceleration.value for acceleration in accelerations],
        )

    def _replace_by_commands(self, state: MotionState) -> MotionState:
        """Return a state with the last commands in place of measurements.

        Otherwise hardware that sags under load would be commanded to the sagged position.
        """
        return MotionState(
            self._get_finite_values_or(self._command.get(POSITION), state.positions),
            self._get_finite_values_or(self._command.get(VELOCITY) if state.velocities else None, state.velocities),
            self._get_finite_values_or(
                self._command.get(ACCELERATION) if state.accelerations else None, state.accelerations
            ),
        )

    @staticmethod
    def _get_finite_values_or(interfaces: Sequence[Interface] | None, defaults: Sequence[float]) -> list[float]:
        interface_values = [interface.value for interface in interfaces or ()]
        return interface_values if interface_values and all(map(isfinite, interface_values)) else list(defaults)

    @property
    def _error(self) -> MotionState:
        """The error at the last update, computed on demand.

        A controller that holds its position needs the error only for its topics.
        """
        if self._computed_error is None:
            self._computed_error = self._compute_error(self._desired)
        return self._computed_error

    def _compute_error(self, desired: MotionState) -> MotionState:
        """Return the error of the current state: the desired values minus the current values.

        Errors of velocities and accelerations are zero if the controller does not control them.
        """
        current = self._current
        positions = [
            shortest_turn(actual, target) if is_wrapped else target - actual
            for target, actual, is_wrapped in zip(desired.positions, current.positions, self._is_wrapped, strict=True)
        ]
        zeros = [0.0] * len(positions)
        return MotionState(
            positions,
            [
                target_rate - actual_rate
                for target_rate, actual_rate in zip(desired.velocities, current.velocities, strict=True)
            ]
            if self._has_velocity_error
            else zeros,
            [a - b for a, b in zip(desired.accelerations, current.accelerations, strict=True)]
            if self._has_acceleration_error
            else zeros,
        )

    # --- updates ------------------------------------------------------------------------------------------------------

    def update(self, time_ns: int, period_s: float) -> None:
        """Command the desired state at the next update, and check the tolerances."""
        if time_ns < self._next_sample_ns - self._period_ns:
            self._cancel_goal("Time jumped backwards.")
            self._hold()
        self._current = self._read_state()
        trajectory = self._trajectory
        is_first = not trajectory.is_started
        if is_first:
            start_state = self._last_command if self.parameters.open_loop else self._current
            trajectory.begin(time_ns, _drop_unmeasured(start_state), self._is_wrapped)
        desired = self._next_sample if time_ns == self._next_sample_ns else trajectory.sample(time_ns)
        next_sample = trajectory.sample(time_ns + self._period_ns)
        assert desired is not None
        assert next_sample is not None, "the trajectory has begun"
        self._next_sample_ns, self._next_sample = time_ns + self._period_ns, next_sample
        self._desired, self._computed_error = desired.state, None
        self._check_and_command(time_ns, period_s, desired.state, next_sample, is_first=is_first)
        self._publish_state(time_ns, desired.state)

    def _check_and_command(
        self, time_ns: int, period_s: float, desired: MotionState, next_sample: Sample, *, is_first: bool
    ) -> None:
        tolerances, late_s = self._tolerances, (time_ns - next_sample.point_ns) / NANOSECONDS_PER_SECOND
        violates_path = misses_goal = False
        if not self._is_held:
            violates_path = (is_first or not next_sample.has_ended) and not self._is_within(tolerances.path)
            misses_goal = next_sample.has_ended and not self._is_within(tolerances.goal)
        is_overdue = misses_goal and 0.0 < tolerances.goal_time_s < late_s
        if not violates_path and not is_overdue:
            self._write_commands(next_sample.state, period_s)
        if self._goal is not None:
            self._publish_feedback(self._goal, time_ns, desired)
        if violates_path:
            self._log_violations(tolerances.path)
            self._fail(
                self._result.PATH_TOLERANCE_VIOLATED,
                "Aborted due to path tolerance violation",
                "Holding position due to state tolerance violation",
            )
        elif is_overdue:
            self._log_violations(tolerances.goal)
            self._fail(
                self._result.GOAL_TOLERANCE_VIOLATED,
                f"Aborted due to goal_time_tolerance exceeding by {late_s:f} seconds",
                "Exceeded goal_time_tolerance: holding position...",
            )
        elif next_sample.has_ended and not misses_goal and self._goal is not None:
            self._goal.succeed(self._result(error_string="Goal successfully reached!"))
            self._goal = None
            self.node.logger.info("Goal reached, success!")
            self._hold(next_sample.state)
        elif next_sample.has_ended and not self._is_held and 0.0 < self._timeout_s < late_s:
            self.node.logger.warning("Aborted due to command timeout")
            self._hold()

    def _is_within(self, tolerances: Sequence[StateTolerance]) -> bool:
        error = self._error
        errors = zip(tolerances, error.positions, error.velocities, error.accelerations, strict=True)
        return all(tolerance.is_within(*joint_errors) for tolerance, *joint_errors in errors)

    def _log_violations(self, tolerances: Sequence[StateTolerance]) -> None:
        error = self._error
        errors = zip(
            self.parameters.joints, tolerances, error.positions, error.velocities, error.accelerations, strict=True
        )
        for joint, tolerance, *values in errors:
            for name, value, limit in tolerance.find_violations(*values):
                self.node.logger.error(
                    f"State tolerances failed for joint '{joint}': {name} Error: {value:f}, {name} Tolerance: {limit:f}"
                )

    def _fail(self, code: int, message: str, message_without_goal: str) -> None:
        if self._goal is None:
            self.node.logger.error(message_without_goal)
        else:
            self.node.logger.warning(message)
            self._goal.abort(self._result(error_code=code, error_string=message))
            self._goal = None
        self._hold()

    def _write_commands(self, target: MotionState, period_s: float) -> None:
        if self._has_pid:
            self._update_gains()
            (commands,) = self._command.values()
            errors = self._error
            for index, pid in enumerate(self._pids):
                command = pid.command(errors.positions[index], period_s, errors.velocities[index])
                commands[index].value = target.velocities[index] * self._velocity_scales[index] + command
        else:
            for kind, commands in self._command.items():
                values = (
                    target.positions
                    if kind == POSITION
                    else target.velocities
                    if kind == VELOCITY
                    else target.accelerations
                )
                for interface, value in zip(commands, values, strict=True):
                    interface.value = value
        self._last_command = target

    def _update_gains(self) -> None:
        """Apply changed PID gains, without resetting the integrals."""
        parameters = self.parameters
        if parameters is not self._pid_parameters:
            integrals = [pid.integral for pid in self._pids]
            self._create_pids(parameters)
            for pid, integral in zip(self._pids, integrals, strict=True):
                pid.integral = integral

    # --- messages -----------------------------------------------------------------------------------------------------

    def _build_point(self, state: MotionState) -> Any:
        return self._point_type(
            positions=state.positions, velocities=state.velocities, accelerations=state.accelerations
        )

    def _publish_feedback(self, goal: Goal, time_ns: int, desired: MotionState) -> None:
        if time_ns < self._next_feedback_ns:
            return
        self._next_feedback_ns = time_ns + round(NANOSECONDS_PER_SECOND / self.parameters.action_monitor_rate)
        goal.publish_feedback(
            self._feedback_type(
                header=Header(stamp=Time.from_nanoseconds(time_ns)),
                joint_names=list(self.parameters.joints),
                desired=self._build_point(desired),
                actual=self._build_point(self._current),
                error=self._build_point(self._error),
            )
        )

    def _publish_state(self, time_ns: int, desired: MotionState) -> None:
        rate = self.parameters.state_publish_rate
        if rate and time_ns < self._next_state_ns:
            return
        self._next_state_ns = time_ns + (round(NANOSECONDS_PER_SECOND / rate) if rate else 0)
        outputs = [output for output in self._outputs if output.is_wanted]
        if not outputs:
            return
        reference, feedback = self._build_point(desired), self._build_point(self._current)
        commands = {kind: [interface.value for interface in interfaces] for kind, interfaces in self._command.items()}
        message = self._state_type(
            header=Header(stamp=Time.from_nanoseconds(time_ns)),
            joint_names=list(self.parameters.joints),
            reference=reference,
            feedback=feedback,
            error=self._build_point(self._error),
            output=self._point_type(
                positions=commands.get(POSITION, []),
                velocities=commands.get(VELOCITY, []),
                accelerations=commands.get(ACCELERATION, []),
                effort=commands.get(EFFORT, []),
            ),
            desired=reference,
            actual=feedback,
        )
        for output in outputs:
            output.publish(message)

    def _on_query(self, request: Any, response: Any) -> Any:
        sample = None
        if not self._active:
            response.message = "Can't sample trajectory. Controller is not active."
        elif not self._trajectory.is_started:
            response.message = "Currently there is no valid trajectory instance."
        else:
            sample = self._trajectory.sample(to_nanoseconds(request.time))
            if sample is None:
                response.message = "Requested sample time is earlier than the current trajectory start time."
            elif sample.has_ended:
                response.message = "Requested sample time precedes the current trajectory end time."
        if response.message:
            self.node.logger.error(response.message)
        response.success = sample is not None and not sample.has_ended
        if self._active:
            state = self._current if sample is None else sample.state
            response.name = list(self.parameters.joints)
            response.position, response.velocity = state.positions, state.velocities
            response.acceleration = state.accelerations
        return response


def _drop_unmeasured(state: MotionState) -> MotionState:
    """Return a state without velocities and accelerations that are not measured."""
    measured = [values if all(map(isfinite, values)) else [] for values in (state.velocities, state.accelerations)]
    return MotionState(state.positions, *measured)
