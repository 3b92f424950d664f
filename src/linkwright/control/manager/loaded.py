"""A controller that a manager has loaded."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import isfinite
from typing import Any

from linkwright.control.controllers.controller import Controller
from linkwright.control.hardware.interfaces import POSITION, Interfaces
from linkwright.control.hardware.timing import Timing
from linkwright.graph.lifecycle.states import ACTIVE, INACTIVE


@dataclass(eq=False, slots=True)
class Loaded:
    """A controller that a manager has loaded.

    Attributes:
        name, type: its names.
        controller: the controller.
        fallbacks: the controllers to activate when it fails.
        period_ns: the time between two updates; 0 for each update of the manager.
        next_ns: the time of the next update.
        before: the last finite values of its commands.
        timing: the timer of its updates; None while no statistics are requested.
    """

    name: str
    type: str
    controller: Controller[Any]
    fallbacks: tuple[str, ...] = ()
    period_ns: int = 0
    next_ns: int = 0
    before: list[float] = field(default_factory=list)
    timing: Timing | None = None

    @property
    def is_active(self) -> bool:
        """Whether it is active."""
        return self.controller.state is ACTIVE

    @property
    def is_inactive(self) -> bool:
        """Whether it is configured and not active."""
        return self.controller.state is INACTIVE

    @property
    def is_configured(self) -> bool:
        """Whether it is configured, active or not."""
        return self.is_active or self.is_inactive

    @property
    def is_chainable(self) -> bool:
        """Whether other controllers can command it, or read its exported states."""
        return bool(self.controller.references or self.controller.exported)

    def wanted_commands(self, known: list[str]) -> list[str]:
        """The names of the command interfaces that it claims; all available ones where it asks for all."""
        wanted = self.controller.command_interfaces()
        return [*known] if isinstance(wanted, Interfaces) else [*wanted]

    def wanted_states(self, known: list[str]) -> list[str]:
        """The names of the state interfaces that it reads; all available ones where it asks for all."""
        wanted = self.controller.state_interfaces()
        return [*known] if isinstance(wanted, Interfaces) else [*wanted]

    def replace_invalid_commands(self) -> str:
        """Replace commands that are not finite by the last position, or by a velocity or effort of 0.

        Returns:
            The name of one of them, or nothing.
        """
        commands = self.controller.commands
        if not commands:
            return ""
        values = [command.value for command in commands]
        if isfinite(sum(values)) or all(map(isfinite, values)):  # as nearly always; a sum may overflow
            self.before = values
            return ""
        wrong = ""
        before = self.before
        for place, command in enumerate(commands):
            value = command.value
            if isfinite(value):
                before[place] = value
            elif isfinite(before[place]):
                wrong = wrong or command.name
                command.value = before[place] if command.kind == POSITION else 0.0
            elif value == value:  # infinite, and nothing was before it
                wrong = wrong or command.name
                command.value = before[place]
        return wrong

    def halt(self) -> None:
        """Command 0 on the velocities, accelerations and efforts that it claimed."""
        for command in self.controller.commands:
            if command.kind != POSITION and isfinite(command.value):
                command.value = 0.0
