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
class LoadedController:
    """A controller that a manager has loaded.

    Attributes:
        name, type: the controller's name and type name.
        controller: the controller.
        fallbacks: the names of the controllers that are activated if this controller fails.
        period_ns: the time between two updates; 0 to update in each cycle of the manager.
        next_update_ns: the time of the next update.
        last_commands: the last finite values of its commands.
        timing: the timer of its updates; None while no statistics are requested.
    """

    name: str
    type: str
    controller: Controller[Any]
    fallbacks: tuple[str, ...] = ()
    period_ns: int = 0
    next_update_ns: int = 0
    last_commands: list[float] = field(default_factory=list)
    timing: Timing | None = None

    @property
    def is_active(self) -> bool:
        """Whether the controller is active."""
        return self.controller.state is ACTIVE

    @property
    def is_inactive(self) -> bool:
        """Whether the controller is configured and not active."""
        return self.controller.state is INACTIVE

    @property
    def is_configured(self) -> bool:
        """Whether the controller is configured, active or not."""
        return self.is_active or self.is_inactive

    @property
    def is_chainable(self) -> bool:
        """Whether other controllers can command this controller, or read its exported states."""
        return bool(self.controller.references or self.controller.exported)

    def claimed_command_interfaces(self, available_names: list[str]) -> list[str]:
        """Return the names of the command interfaces that the controller claims.

        If the controller claims all interfaces, these are `available_names`.
        """
        claims = self.controller.command_interfaces()
        return [*available_names] if isinstance(claims, Interfaces) else [*claims]

    def required_state_interfaces(self, available_names: list[str]) -> list[str]:
        """Return the names of the state interfaces that the controller reads.

        If the controller reads all interfaces, these are `available_names`.
        """
        requirements = self.controller.state_interfaces()
        return [*available_names] if isinstance(requirements, Interfaces) else [*requirements]

    def replace_invalid_commands(self) -> str:
        """Replace commands that are not finite.

        A position command becomes its last finite value, and any other command becomes 0.

        Returns:
            The name of the first replaced interface, or an empty string.
        """
        commands = self.controller.commands
        if not commands:
            return ""
        values = [command.value for command in commands]
        if isfinite(sum(values)) or all(map(isfinite, values)):  # A sum is fast, but may overflow.
            self.last_commands = values
            return ""
        replaced_name = ""
        last_values = self.last_commands
        for index, command in enumerate(commands):
            value = command.value
            if isfinite(value):
                last_values[index] = value
            elif isfinite(last_values[index]):
                replaced_name = replaced_name or command.name
                command.value = last_values[index] if command.kind == POSITION else 0.0
            elif value == value:  # The value is infinite, and a finite command is missing.
                replaced_name = replaced_name or command.name
                command.value = last_values[index]
        return replaced_name

    def halt(self) -> None:
        """Command 0 to the claimed interfaces that have a command, except positions."""
        for command in self.controller.commands:
            if command.kind != POSITION and isfinite(command.value):
                command.value = 0.0
