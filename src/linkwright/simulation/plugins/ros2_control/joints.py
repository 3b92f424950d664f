"""Simulated joints, whose states the hardware reads and to which it applies commands."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf, isfinite, isnan, nan, remainder, tau
from types import MappingProxyType

from linkwright.control.hardware.description import ComponentDescription
from linkwright.control.hardware.interfaces import EFFORT, POSITION, VELOCITY, CommandInterface, StateInterface
from linkwright.control.motion.pid import Pid
from linkwright.simulation.actuators import EXACT_VELOCITY_GAIN, Motor, Servo
from linkwright.simulation.simulation import Simulation

_MIN_VELOCITY_GAIN = 20.0
"""The minimum velocity gain of motors, in N m per rad/s of velocity error (N per m/s for prismatic joints).

A motor that reaches its effort limit at a smaller error than 1 rad/s would switch between both limits.
"""
_MAX_SERVO_SPEED = 1000.0
"""The maximum speed of servos in rad/s, or in m/s for prismatic joints."""


class SimulatedJoint:
    """A joint in the simulation that a joint of ``<ros2_control>`` reads and commands.

    Call `begin` only after all joints are created, so that the model is compiled only once.

    Position commands use a constraint, because Gazebo moves joints exactly to the commanded positions. Velocity
    commands use a motor with the effort limit of the joint. Effort commands and PID controllers apply forces.

    Args:
        simulation: the simulation of the world.
        name: the joint's name in the simulation.
        description: the description of the joint in ``<ros2_control>``.
        states, commands: the interfaces of the joint, by kind, such as ``position``.
        holds_position: whether the joint holds its position while no controller commands it.
        gain: the fraction of a position error that each update corrects; NaN for the whole error.
        pids: the PID controllers that apply forces, by the kind of command that they follow.
    """

    def __init__(
        self,
        simulation: Simulation,
        name: str,
        description: ComponentDescription,
        states: dict[str, StateInterface],
        commands: dict[str, CommandInterface],
        *,
        holds_position: bool,
        gain: float = nan,
        pids: Mapping[str, Pid] = MappingProxyType({}),
    ) -> None:
        self._simulation = simulation
        self._name = name
        self._description = description
        self._holds_position, self._gain = holds_position, gain
        self._position, self._velocity = states.get(POSITION), states.get(VELOCITY)
        self._effort = states.get(EFFORT)
        self._commands = commands
        self._pids = pids
        self._target = 0.0
        self._mode = ""
        placed_joint = simulation.scene.joints[name]
        simulation.keep_awake(placed_joint.child)
        limit = placed_joint.axes[0][0].limit.effort
        self._max_effort = limit if isfinite(limit) and limit > 0.0 else inf
        self._is_continuous = placed_joint.is_continuous
        self._accepts_forces = bool(pids) or EFFORT in commands
        self._motor: Motor | None = None
        self._servo: Servo | None = None
        if VELOCITY in commands and VELOCITY not in pids:
            gain = min(max(self._max_effort, _MIN_VELOCITY_GAIN), EXACT_VELOCITY_GAIN)
            self._motor = simulation.add_velocity_motor(name, gain, self._max_effort)
        if (POSITION in commands and POSITION not in pids) or (
            self._accepts_forces and self._motor is None and holds_position
        ):
            self._servo = simulation.add_servo(name, _MAX_SERVO_SPEED)

    def begin(self) -> None:
        """Set the initial position, if the description has one, and clear the command mode."""
        for state in self._description.states:
            if state.name == POSITION and not isnan(state.initial_value):
                self._simulation.set_joint_position(self._name, state.initial_value)
        self.set_mode("")

    def set_mode(self, kind: str) -> None:
        """Set the kind of interface that commands the joint.

        The kind is empty if no controller commands the joint.
        """
        previous_mode, self._mode = self._mode, kind
        if previous_mode in (VELOCITY, EFFORT) and self._motor is not None:  # In other modes the target is already 0.
            self._motor.target = 0.0
        if self._accepts_forces:
            self._simulation.push_joint(self._name, 0.0)
        if kind in self._pids:
            self._pids[kind].reset()
            self._target = self._simulation.joint_state(self._name)[0] if kind == POSITION else 0.0
        if self._servo is not None:
            self._servo.restart()
            if kind not in ("", POSITION) or kind in self._pids or (not kind and not self._holds_position):
                self._servo.release()

    @property
    def mode(self) -> str:
        """The kind of interface that commands the joint, or an empty string for none."""
        return self._mode

    def read(self) -> None:
        """Update the values of the state interfaces."""
        position, velocity = self._simulation.joint_state(self._name)
        if self._position is not None:
            self._position.value = position
        if self._velocity is not None:
            self._velocity.value = velocity
        if self._effort is not None:
            joint = self._simulation.data.joint(self._name)
            self._effort.value = float(joint.qfrc_actuator[0] + joint.qfrc_applied[0])

    def write(self, period_s: float) -> None:
        """Apply the command of the current mode, unless a PID controller follows it.

        A NaN command has no effect. Without a command mode, the motor is released unless the joint holds its position.
        """
        command = self._commands.get(self._mode)
        if command is None:
            if self._motor is not None and not self._holds_position:
                self._motor.release()
            return
        value = command.value
        if value != value or self._mode in self._pids:
            return
        if self._mode == POSITION and self._servo is not None:
            if isfinite(self._gain):
                value = self._servo.position + self._gain * (value - self._servo.position)
            self._servo.move(value, period_s)
        elif self._mode == VELOCITY and self._motor is not None:
            self._motor.target = value
        elif self._mode == EFFORT:
            if self._motor is not None:
                self._motor.release()
            self._simulation.push_joint(self._name, value)

    def push(self, period_s: float) -> None:
        """Apply the force of the current mode's PID controller, if it has one.

        Call this after each simulation step.
        """
        pid = self._pids.get(self._mode)
        if pid is None:
            return
        command = self._commands[self._mode].value
        if command == command:  # Not NaN; before the first command, the target of `set_mode` applies.
            self._target = command
        if self._motor is not None:
            self._motor.release()
        position, velocity = self._simulation.joint_state(self._name)
        error = self._target - (velocity if self._mode == VELOCITY else position)
        if self._is_continuous and self._mode == POSITION:
            error = remainder(error, tau)
        force = pid.command(error, period_s)
        self._simulation.push_joint(self._name, min(max(force, -self._max_effort), self._max_effort))
