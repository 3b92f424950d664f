"""Joints of legged robots, whose motors follow a position and a velocity with gains that controllers command.

A joint with the command interfaces ``kp`` and ``kd`` has the torque

    effort + kp (position - q) + kd (velocity - dq)

of its commands, for its position q and velocity dq. All its commands act together; those without a value count as 0.

Source: gz_quadruped_hardware (interfaces, formula, forces of feet).
"""

from __future__ import annotations

from math import isnan

from linkwright.control.hardware.description import ComponentDescription
from linkwright.control.hardware.interfaces import EFFORT, POSITION, VELOCITY, CommandInterface, StateInterface
from linkwright.simulation.simulation import Simulation

KP, KD = "kp", "kd"
GAIN_KINDS = (KP, KD)


class ImpedanceJoint:
    """A joint in the simulation whose commands include its gains.

    Args:
        simulation: the simulation of the world.
        name: the joint's name in the simulation.
        description: the description of the joint in ``<ros2_control>``.
        states, commands: the interfaces of the joint, by kind, such as ``position``.
    """

    def __init__(
        self,
        simulation: Simulation,
        name: str,
        description: ComponentDescription,
        states: dict[str, StateInterface],
        commands: dict[str, CommandInterface],
    ) -> None:
        self._simulation = simulation
        self._name = name
        self._description = description
        self._states, self._commands = states, commands
        self._mode = ""
        simulation.keep_awake(simulation.scene.joints[name].child)

    def begin(self) -> None:
        """Set the initial position, if the description has one, and release the joint."""
        for state in self._description.states:
            if state.name == POSITION and not isnan(state.initial_value):
                self._simulation.set_joint_position(self._name, state.initial_value)
        self.set_mode("")

    def set_mode(self, kind: str) -> None:
        """Set the kind of interface that was claimed last; empty if no controller commands the joint."""
        self._mode = kind
        if not kind:
            self._simulation.push_joint(self._name, 0.0)

    @property
    def mode(self) -> str:
        """The kind of interface that was claimed last, or an empty string for none."""
        return self._mode

    def read(self) -> None:
        """Update the values of the state interfaces."""
        position, velocity = self._simulation.joint_state(self._name)
        effort = float(self._simulation.data.joint(self._name).qfrc_applied[0])
        for kind, value in ((POSITION, position), (VELOCITY, velocity), (EFFORT, effort)):
            if kind in self._states:
                self._states[kind].value = value

    def write(self, period_s: float) -> None:
        """Apply the torque of the commands."""
        position, velocity = self._simulation.joint_state(self._name)
        stiffness, damping = self._get_command(KP), self._get_command(KD)
        torque = self._get_command(EFFORT)
        torque += stiffness * (self._get_command(POSITION) - position)
        torque += damping * (self._get_command(VELOCITY) - velocity)
        self._simulation.push_joint(self._name, torque)

    def push(self, period_s: float) -> None:
        """Keep the torque between updates."""

    def _get_command(self, kind: str) -> float:
        command = self._commands.get(kind)
        return 0.0 if command is None or isnan(command.value) else command.value
