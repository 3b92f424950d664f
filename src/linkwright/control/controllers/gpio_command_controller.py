"""``gpio_controllers/GpioCommandController``: inputs and outputs of ``<gpio>`` elements.

Source: ros2_controllers (parameters, topics, the states that are published by default).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isfinite
from typing import Any

from linkwright.control.controllers.controller import Controller, ControllerError, InterfaceNames
from linkwright.control.hardware.description import hardware_from_robot
from linkwright.diagnostics import Phrase, counted, phrase
from linkwright.messages import Header, Time, get_message
from linkwright.nodes.parameter_tables import for_each, parameter

_MESSAGE_TYPE = "control_msgs/msg/DynamicInterfaceGroupValues"


def _check_names(name: str, value: Sequence[str]) -> Phrase | None:
    """Return an error message if a list of names is empty or contains a name twice."""
    if not value:
        return phrase("Parameter '{name}' cannot be empty", name=name)
    return _check_unique(name, value)


def _check_unique(name: str, value: Sequence[str]) -> Phrase | None:
    repeated = next((item for item in value if value.count(item) > 1), None)
    return None if repeated is None else phrase("parameter '{name}' contains '{item}' twice", name=name, item=repeated)


@dataclass(frozen=True, kw_only=True)
class GpioInterfaces:
    """The interfaces of a GPIO."""

    interfaces: tuple[str, ...] = parameter((), description="the names of the interfaces", check=_check_unique)


@dataclass(frozen=True, kw_only=True)
class GpioParameters:
    """Parameters of the controller."""

    gpios: tuple[str, ...] = parameter((), description="the names of the GPIOs in ros2_control", check=_check_names)
    command_interfaces: Mapping[str, GpioInterfaces] = for_each("gpios", GpioInterfaces)
    state_interfaces: Mapping[str, GpioInterfaces] = for_each("gpios", GpioInterfaces)


class GpioCommandController(Controller[GpioParameters]):
    """A controller that forwards ``~/commands`` to GPIOs and publishes their states.

    If no GPIO has state interfaces in the parameters, all state interfaces of the description are published.
    """

    PARAMETERS = GpioParameters

    def command_interfaces(self) -> InterfaceNames:
        """Return the command interfaces in the parameters."""
        return _list_interface_names(self.parameters.command_interfaces)

    def state_interfaces(self) -> InterfaceNames:
        """Return the state interfaces in the parameters, or else in the description."""
        return self._states

    def on_configure(self) -> None:
        """Determine the interfaces, and create the topics.

        Raises:
            ControllerError: there are neither command nor state interfaces.
        """
        parameters = self.parameters
        self._states = _list_interface_names(parameters.state_interfaces) or self._find_described_states()
        if not self._states and not self.command_interfaces():
            raise ControllerError("No command or state interfaces are configured")
        self._values: dict[str, float] = {}
        if self.command_interfaces():
            self.node.subscribe(_MESSAGE_TYPE, "~/commands", self._on_command)
        self._output = self.node.publisher(_MESSAGE_TYPE, "~/gpio_states")

    def _find_described_states(self) -> list[str]:
        """Return the state interfaces that the description has for the GPIOs."""
        hardware = [] if self.robot is None else hardware_from_robot(self.robot)[0]
        described = {gpio.name: gpio.states for component in hardware for gpio in component.gpios}
        return [f"{gpio}/{state.name}" for gpio in self.parameters.gpios for state in described.get(gpio, ())]

    def on_activate(self) -> None:
        """Discard earlier commands."""
        self._values = {}

    def on_deactivate(self) -> None:
        """Discard the commands. The outputs keep their values."""
        self._values = {}

    def update(self, time_ns: int, period_s: float) -> None:
        """Forward the last commands, and publish the states."""
        for command in self.commands:
            if command.name in self._values:
                command.value = self._values[command.name]
        if self._output.is_wanted:
            self._output.publish(self._build_message(time_ns))

    def _build_message(self, time_ns: int) -> Any:
        """Return the states of all GPIOs, with empty lists for GPIOs without state interfaces."""
        interface_value = get_message("control_msgs/msg/InterfaceValue")
        groups = []
        for gpio in self.parameters.gpios:
            states = [state for state in self.states if state.component == gpio]
            names, values = [state.kind for state in states], [state.value for state in states]
            groups.append(interface_value(interface_names=names, values=values))
        header = Header(stamp=Time.from_nanoseconds(time_ns), frame_id="")
        gpios = list(self.parameters.gpios)
        return get_message(_MESSAGE_TYPE)(header=header, interface_groups=gpios, interface_values=groups)

    def _on_command(self, message: Any) -> None:
        """Store the values of a complete and finite command, or log why a command is invalid."""
        logger = self.node.logger
        names = {command.name for command in self.commands}
        if not names:
            return  # Commands are ignored while the controller is not active.
        if len(message.interface_groups) != len(message.interface_values):
            group_count, value_count = len(message.interface_groups), len(message.interface_values)
            logger.error(
                counted(
                    "a command has {count} GPIO, but values for {value_count}",
                    "a command has {count} GPIOs, but values for {value_count}",
                    group_count,
                    value_count=value_count,
                )
            )
            return
        for gpio, group in zip(message.interface_groups, message.interface_values, strict=True):
            if len(group.interface_names) != len(group.values):
                logger.error(phrase("For gpio {gpio} interfaces_names do not match values", gpio=gpio))
                return
            for name, value in zip(group.interface_names, group.values, strict=True):
                full_name = f"{gpio}/{name}"
                if full_name not in names:
                    text = phrase("'{name}' is not a command interface of this controller", name=full_name)
                    logger.error(text, throttle_duration_sec=1.0)
                elif not isfinite(value):
                    logger.error(phrase("a command with NaN is not forwarded"), throttle_duration_sec=1.0)
                else:
                    self._values[full_name] = value


def _list_interface_names(groups: Mapping[str, GpioInterfaces]) -> list[str]:
    """Return the full names of the interfaces of all GPIOs."""
    return [f"{gpio}/{name}" for gpio, group in groups.items() for name in group.interfaces]
