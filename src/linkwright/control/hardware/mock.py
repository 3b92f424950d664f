"""``mock_components/GenericSystem``: hardware whose states follow its commands.

Source: mock_components of ros2_control (parameters, order of steps, messages). With ``calculate_dynamics`` a joint is
integrated from its active command interface; otherwise each state copies the command of the same name.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from math import isnan

from linkwright.control.hardware.component import Hardware, HardwareError
from linkwright.control.hardware.description import ComponentDescription, HardwareDescription
from linkwright.control.hardware.interfaces import (
    ACCELERATION,
    EFFORT,
    POSITION,
    VELOCITY,
    CommandInterface,
    Interface,
    StateInterface,
)
from linkwright.graph.log.logger import Logger

_STANDARD_INTERFACES = (POSITION, VELOCITY, ACCELERATION, EFFORT)
_MODES = (POSITION, VELOCITY, ACCELERATION)

DYNAMICS = "calculate_dynamics"
"""The parameter that requests joints that are integrated from their active command interface."""


class MockJoint:
    """A simulated joint with all kinds of states.

    Only the states in the description have an interface.

    Args:
        description: the joint in the description of the hardware.
        states: the state interfaces of the joint, by kind.

    Attributes:
        description: the joint in the description of the hardware.
        mode: the kind of command that moves the joint if dynamics are calculated.
        exposed_states: the state interfaces of standard kinds.
        values: the states of all standard kinds.
        commands: the command interfaces of standard kinds, by kind.
    """

    def __init__(self, description: ComponentDescription, states: dict[str, StateInterface]) -> None:
        self.description = description
        self.mode = POSITION
        self.exposed_states = [states[state.name] for state in description.states if state.name in _STANDARD_INTERFACES]
        self.values = dict.fromkeys(_STANDARD_INTERFACES, 0.0)
        for interface in self.exposed_states:
            if isnan(interface.value):
                interface.value = 0.0
            self.values[interface.kind] = interface.value
        self.commands: dict[str, CommandInterface] = {}


class GenericSystem(Hardware):
    """Hardware whose states follow its commands."""

    def __init__(self, description: HardwareDescription, logger: Logger) -> None:
        super().__init__(description, logger)
        is_set = description.is_set
        self._is_disabled = is_set("disable_commands")
        self._has_dynamics = is_set(DYNAMICS)
        self._offset = float(description.parameters.get("position_state_following_offset") or 0.0)
        self._offset_interface = description.parameters.get("custom_interface_with_following_offset", "")
        states = {state.name: state for state in self.states}
        self._add_mock_commands("sensor", enabled=is_set("mock_sensor_commands") or is_set("fake_sensor_commands"))
        self._add_mock_commands("gpio", enabled=is_set("mock_gpio_commands") or is_set("fake_gpio_commands"))
        self.joints = {
            joint.name: MockJoint(joint, {state.kind: state for state in self.states if state.component == joint.name})
            for joint in description.joints
        }
        self._mirrored_pairs: list[tuple[CommandInterface, StateInterface]] = []
        for command in self.commands:
            joint = self.joints.get(command.component)
            if joint is not None and command.kind in _STANDARD_INTERFACES:
                joint.commands[command.kind] = command
            elif command.name in states:
                self._mirrored_pairs.append((command, states[command.name]))
        self._mimic_joints = [
            (joint, self.joints[joint.description.mimic.joint], joint.description.mimic)
            for joint in self.joints.values()
            if joint.description.mimic is not None and joint.description.mimic.joint in self.joints
        ]
        self._offset_states = [
            (self.joints[state.component], state)
            for state in self.states
            if self._offset_interface and state.kind == self._offset_interface and state.component in self.joints
        ]
        # Lookups are slow at 1 kHz, so states are copied directly unless dynamics or a mimic joint needs their values.
        coupled = {coupled_joint for joint, mimicked, _ in self._mimic_joints for coupled_joint in (joint, mimicked)}
        joints = [joint for joint in self.joints.values() if self._has_dynamics or joint in coupled]
        uncoupled = [joint for joint in self.joints.values() if not self._has_dynamics and joint not in coupled]
        self._shown_states = list_shown_states(joints)
        self._commands_to_joints = [
            (command, joint.values, kind, self._get_state_offset(kind))
            for joint in joints
            for kind, command in joint.commands.items()
        ]
        self._commands_to_states = [
            (joint.commands[state.kind], state, self._get_state_offset(state.kind))
            for joint in uncoupled
            for state in joint.exposed_states
            if state.kind in joint.commands
        ]
        self._update_joints: Callable[[float], None] = self._integrate if self._has_dynamics else self._copy_commands

    def _add_mock_commands(self, kind: str, *, enabled: bool) -> None:
        names = {command.name for command in self.commands}
        for component in self.description.components:
            if enabled and component.kind == kind:
                for state in component.states:
                    command = CommandInterface(component.name, state.name)
                    if command.name not in names:
                        self.commands.append(command)

    def prepare_switch(self, start: Collection[str], stop: Collection[str]) -> None:
        """Check that each joint with started interfaces gets exactly one mode.

        The mode is position, velocity or acceleration. The check applies only if dynamics are calculated.

        Raises:
            HardwareError: such a joint gets no mode or several modes.
        """
        if not self._has_dynamics:
            return
        for name in self.joints:
            prefix = f"{name}/"
            kinds = [name.removeprefix(prefix) for name in start if name.startswith(prefix)]
            modes = [item for item in kinds if item in _MODES]
            if kinds and not modes:
                raise HardwareError(
                    f"Joint '{name}' has to have '{POSITION}', '{VELOCITY}', or '{ACCELERATION}' interface!"
                )
            if len(modes) > 1:
                raise HardwareError(
                    f"Got multiple ({len(modes)}) starting interfaces for joint '{name}' - this is not supported!"
                )

    def perform_switch(self, start: Collection[str], stop: Collection[str]) -> None:
        """Set the modes of joints to their started interfaces, if dynamics are calculated."""
        for name, joint in self.joints.items():
            for mode in _MODES:
                if self._has_dynamics and f"{name}/{mode}" in start:
                    joint.mode = mode

    def read(self, time_ns: int, period_s: float) -> None:
        """Compute the states from the commands."""
        if self._is_disabled:
            return
        for command, state, offset in self._commands_to_states:
            value = command.value
            if value == value:
                state.value = value + offset
        self._update_joints(period_s)
        for joint, mimicked, mimic in self._mimic_joints:
            joint.values[POSITION] = mimic.multiplier * mimicked.values[POSITION] + mimic.offset
            for kind in (VELOCITY, ACCELERATION, EFFORT):
                joint.values[kind] = mimic.multiplier * mimicked.values[kind]
        for state, values, kind in self._shown_states:
            state.value = values[kind]
        for command, state in self._mirrored_pairs:
            if command.value == command.value:
                state.value = command.value
        for joint, state in self._offset_states:
            position = _get_command(joint.commands.get(POSITION))
            if position is not None:
                state.value = position + self._offset

    @property
    def _position_offset(self) -> float:
        return 0.0 if self._offset_interface else self._offset

    def _get_state_offset(self, kind: str) -> float:
        return self._position_offset if kind == POSITION else 0.0

    def _copy_commands(self, _: float) -> None:
        for command, values, kind, offset in self._commands_to_joints:
            value = command.value
            if value == value:
                values[kind] = value + offset

    def _integrate(self, period_s: float) -> None:
        for joint in self.joints.values():
            self._integrate_joint(joint, period_s)
            effort = _get_command(joint.commands.get(EFFORT))
            if effort is not None:
                joint.values[EFFORT] = effort

    def _integrate_joint(self, joint: MockJoint, period_s: float) -> None:
        """Integrate a joint over one period from its previous values, as ros2_control does."""
        values = joint.values
        target = _get_command(joint.commands.get(joint.mode))
        velocity = values[VELOCITY]
        if joint.mode == POSITION:
            if target is not None:
                last_position, values[POSITION] = values[POSITION], target + self._position_offset
                values[VELOCITY] = (values[POSITION] - last_position) / period_s if period_s else 0.0
                values[ACCELERATION] = (values[VELOCITY] - velocity) / period_s if period_s else 0.0
            return
        values[POSITION] += velocity * period_s + self._position_offset
        if joint.mode == ACCELERATION:
            values[VELOCITY] += values[ACCELERATION] * period_s
            if target is not None:
                values[ACCELERATION] = target
        elif target is not None:
            values[VELOCITY] = target
            values[ACCELERATION] = (target - velocity) / period_s if period_s else 0.0


def _get_command(command: Interface | None) -> float | None:
    """Return the value of a command, or None if there is no interface or no command."""
    return None if command is None or isnan(command.value) else command.value


def list_shown_states(joints: Iterable[MockJoint]) -> list[tuple[StateInterface, dict[str, float], str]]:
    """Return the exposed states of joints, each with the values and the kind that it shows."""
    return [(state, joint.values, state.kind) for joint in joints for state in joint.exposed_states]
