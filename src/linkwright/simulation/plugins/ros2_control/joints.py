"""Simulated joints, which the hardware reads and commands."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf, isfinite, isnan, nan, remainder, tau
from types import MappingProxyType

from linkwright.control.hardware.description import ComponentDescription
from linkwright.control.hardware.interfaces import EFFORT, POSITION, VELOCITY, CommandInterface, StateInterface
from linkwright.control.motion.pid import Pid
from linkwright.simulation.actuators import Motor, Servo
from linkwright.simulation.simulation import Simulation

_GAIN = 20.0
"""Torque of a motor in N m for each rad/s that its joint is too slow."""
_FASTEST = 1000.0
"""Speed in rad/s (m/s) of a joint without a velocity limit."""


class SimulatedJoint:
    """A simulated joint of the hardware.

    Call `begin` only after all joints are created, so that the model is compiled only once.

    A constraint holds positions, because Gazebo puts joints exactly where they are commanded. A motor with the effort
    limit of the joint holds velocities. Efforts and PID controllers apply forces.

    Args:
        simulation: the simulation of the world.
        name: the joint's name in the simulation.
        described: the joint in ``<ros2_control>``.
        states, commands: the interfaces of the joint, by kind.
        holds: whether the joint holds its position while it has no command.
        gain: the fraction of a position error that each update corrects; with NaN, an update corrects the whole error.
        pids: PID controllers that apply forces, by the kind of command that they follow.
    """

    def __init__(
        self,
        simulation: Simulation,
        name: str,
        described: ComponentDescription,
        states: dict[str, StateInterface],
        commands: dict[str, CommandInterface],
        *,
        holds: bool,
        gain: float = nan,
        pids: Mapping[str, Pid] = MappingProxyType({}),
    ) -> None:
        self._simulation = simulation
        self._name = name
        self._described = described
        self._holds, self._gain = holds, gain
        self._position, self._velocity = states.get(POSITION), states.get(VELOCITY)
        self._effort = states.get(EFFORT)
        self._commands = commands
        self._pids = pids
        self._target = 0.0
        self._mode = ""
        placed = simulation.scene.joints[name]
        simulation.keep_awake(placed.child)
        limit = placed.axes[0][0].limit.effort
        self._greatest = limit if isfinite(limit) and limit > 0.0 else inf
        self._is_endless = placed.joint.type == "continuous"
        self._pushed = bool(pids) or EFFORT in commands
        self._motor: Motor | None = None
        self._servo: Servo | None = None
        if VELOCITY in commands and VELOCITY not in pids:
            self._motor = simulation.add_velocity_motor(name, _GAIN, self._greatest)
        if (POSITION in commands and POSITION not in pids) or (self._pushed and self._motor is None and holds):
            self._servo = simulation.add_servo(name, _FASTEST)

    def begin(self) -> None:
        """Set the initial position of the description if there is one, and clear the command mode."""
        for state in self._described.states:
            if state.name == POSITION and not isnan(state.initial_value):
                self._simulation.set_joint_position(self._name, state.initial_value)
        self.set_mode("")

    def set_mode(self, kind: str) -> None:
        """Set the kind of interface that commands the joint; empty if no controller commands the joint."""
        before, self._mode = self._mode, kind
        if before in (VELOCITY, EFFORT) and self._motor is not None:  # other motors already hold 0
            self._motor.target = 0.0
        if self._pushed:
            self._simulation.push_joint(self._name, 0.0)
        if kind in self._pids:
            self._pids[kind].reset()
            self._target = self._simulation.joint_state(self._name)[0] if kind == POSITION else 0.0
        if self._servo is not None:
            self._servo.restart()
            if kind not in ("", POSITION) or kind in self._pids or (not kind and not self._holds):
                self._servo.release()

    @property
    def mode(self) -> str:
        """The kind of interface that commands the joint; empty if no controller commands the joint."""
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
        """Apply the command of the current mode, except one that a PID controller follows.

        A command that is NaN has no effect. Without a command mode, the motor is released unless the joint is held.
        """
        command = self._commands.get(self._mode)
        if command is None:
            if self._motor is not None and not self._holds:
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
        """Apply the force of the PID controller; call this after each step of the world."""
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
        if self._is_endless and self._mode == POSITION:
            error = remainder(error, tau)
        force = pid.command(error, period_s)
        self._simulation.push_joint(self._name, min(max(force, -self._greatest), self._greatest))
