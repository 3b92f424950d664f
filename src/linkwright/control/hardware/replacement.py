"""The mock that replaces hardware without a driver here, such as a driver in C++.

A driver learns from ``perform_command_mode_switch`` of ros2_control which interfaces controllers claim, and moves its
joints by them. So does this mock. In contrast, ``mock_components/GenericSystem`` copies all commands to the states of
the same name unless its description requests dynamics.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import replace
from math import isnan, nan

from linkwright.control.hardware.description import HardwareDescription
from linkwright.control.hardware.interfaces import ACCELERATION, EFFORT, POSITION, VELOCITY
from linkwright.control.hardware.mock import DYNAMICS, GenericSystem, MockJoint, list_shown_states
from linkwright.graph.log.logger import Logger


class ReplacementSystem(GenericSystem):
    """Hardware whose joints move as their claimed command interfaces say.

    A claimed position sets the position. Without one, a claimed velocity is integrated; without both, a claimed
    acceleration is integrated twice. A joint without any of them stands still: efforts move nothing, because a mock
    knows no masses.

    Args:
        description: the description of the replaced hardware.
        logger: the logger of its events.
    """

    def __init__(self, description: HardwareDescription, logger: Logger) -> None:
        super().__init__(replace(description, parameters={**description.parameters, DYNAMICS: "true"}), logger)
        self._claimed_names: set[str] = set()

    def prepare_switch(self, start: Collection[str], stop: Collection[str]) -> None:
        """Permit each switch, because the rules of the replaced driver are unknown."""

    def perform_switch(self, start: Collection[str], stop: Collection[str]) -> None:
        """Move the joints by the interfaces that are claimed from now on.

        A newly claimed interface starts without a command, so the command of an earlier controller moves nothing.
        """
        self._claimed_names.difference_update(stop)
        self._claimed_names.update(start)
        for command in self.commands:
            if command.name in start and command.name not in stop:
                command.value = nan

    def show_joints_of(self, others: Iterable[ReplacementSystem]) -> None:
        """Show the states of joints that other hardware moves, as separate position sensors of joints do.

        Args:
            others: the hardware that replaces the other drivers of the same robot.
        """
        moved_joints = {name: joint for other in others for name, joint in other.joints.items() if joint.commands}
        for name, joint in self.joints.items():
            moved_joint = moved_joints.get(name)
            if moved_joint is not None and not joint.commands:
                own_kinds = {state.kind for state in moved_joint.exposed_states}
                moved_joint.values.update(
                    {kind: value for kind, value in joint.values.items() if kind not in own_kinds}
                )
                joint.values = moved_joint.values
        self._shown_states = list_shown_states(self.joints.values())

    def _integrate_joint(self, joint: MockJoint, period_s: float) -> None:
        """Move a joint by the commands of its claimed interfaces."""
        values = joint.values
        claimed = {
            kind: command.value for kind, command in joint.commands.items() if command.name in self._claimed_names
        }
        commands = {kind: value for kind, value in claimed.items() if not isnan(value)}
        last_position, last_velocity = values[POSITION], values[VELOCITY]
        if POSITION in claimed:
            position = commands.get(POSITION, last_position)
            velocity = commands.get(VELOCITY, (position - last_position) / period_s if period_s else 0.0)
        else:
            if VELOCITY in claimed:
                velocity = commands.get(VELOCITY, 0.0)
            elif ACCELERATION in claimed:
                velocity = last_velocity + commands.get(ACCELERATION, 0.0) * period_s
            else:
                velocity = 0.0
            position = last_position + velocity * period_s
        acceleration = commands.get(ACCELERATION, (velocity - last_velocity) / period_s if period_s else 0.0)
        values.update(
            {
                POSITION: position,
                VELOCITY: velocity,
                ACCELERATION: acceleration,
                EFFORT: commands.get(EFFORT, 0.0),
            }
        )
