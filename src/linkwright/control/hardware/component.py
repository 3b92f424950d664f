"""The base class of hardware components, and the lookup of hardware classes by type name.

A type name such as ``mock_components/GenericSystem`` is an entry point of the group ``linkwright.hardware``.
"""

from __future__ import annotations

from collections.abc import Collection
from math import nan

from linkwright.control.hardware.description import ComponentDescription, HardwareDescription, InterfaceDescription
from linkwright.control.hardware.interfaces import CommandInterface, StateInterface
from linkwright.control.hardware.timing import Timing
from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.diagnostics.extension_errors import load_extension
from linkwright.graph.lifecycle.states import UNCONFIGURED, LifecycleState
from linkwright.graph.log.logger import Logger
from linkwright.loading.extensions import extensions

GROUP = "linkwright.hardware"


class HardwareError(LinkwrightError):
    """Raised when hardware fails or does not accept a request.

    The message is logged.

    Args:
        message: what is wrong.
    """

    def __init__(self, message: str) -> None:
        super().__init__(Diagnostic("CTL120", foreign(message)))


class Hardware:
    """The base class of hardware components.

    Args:
        description: the component's description in the URDF.
        logger: the logger of its events.

    Attributes:
        description: the component's description in the URDF.
        logger: the logger of its events.
        states, commands: the interfaces of the hardware; a state starts with its initial value, or NaN.
        state: the lifecycle state.
        timings: the timers of reading and writing; None while no statistics are requested.
    """

    def __init__(self, description: HardwareDescription, logger: Logger) -> None:
        self.description = description
        self.logger = logger
        self.state: LifecycleState = UNCONFIGURED
        self.timings: tuple[Timing, Timing] | None = None
        self.states: list[StateInterface] = []
        self.commands: list[CommandInterface] = []
        for component in description.components:
            self.states += [self._create_state_interface(component, state) for state in component.states]
            self.commands += [CommandInterface(component.name, command.name) for command in component.commands]

    def _create_state_interface(
        self, component: ComponentDescription, interface: InterfaceDescription
    ) -> StateInterface:
        value = interface.initial_value
        if value != value:  # NaN means that initial_value is missing, so the older parameter ``initial_NAME`` is used.
            text = component.parameters.get(f"initial_{interface.name}", "")
            value = float(text) if text.replace(".", "", 1).lstrip("-").isdigit() else nan
        return StateInterface(component.name, interface.name, value)

    def on_configure(self) -> None:
        """Connect to the hardware.

        Raises:
            HardwareError: the hardware cannot be reached.
        """

    def on_activate(self) -> None:
        """Power on the hardware.

        Raises:
            HardwareError: the hardware cannot be activated.
        """

    def on_deactivate(self) -> None:
        """Power off the hardware."""

    def on_cleanup(self) -> None:
        """Disconnect from the hardware."""

    def on_error(self) -> None:
        """Handle an error that `read` or `write` raised."""

    def prepare_switch(self, start: Collection[str], stop: Collection[str]) -> None:
        """Check whether controllers may switch to other command interfaces.

        Args:
            start: names of the command interfaces that controllers will claim, including those of other hardware.
            stop: names of the command interfaces that controllers will release.

        Raises:
            HardwareError: the switch is not possible, so no interface is switched.
        """

    def perform_switch(self, start: Collection[str], stop: Collection[str]) -> None:
        """Switch to other command interfaces, with the arguments of `prepare_switch`."""

    def read(self, time_ns: int, period_s: float) -> None:
        """Update `states` from the hardware.

        Raises:
            HardwareError: the hardware does not respond; its controllers are stopped.
        """

    def write(self, time_ns: int, period_s: float) -> None:
        """Send `commands` to the hardware.

        NaN means that a command is missing.

        Raises:
            HardwareError: the hardware does not accept the commands; its controllers are stopped.
        """


def hardware_class(plugin: str) -> type[Hardware] | None:
    """Return the hardware class with a type name, or None if there is none.

    Raises:
        LinkwrightError: CTL121, the package that provides it cannot be imported.
    """
    entry = extensions(GROUP).get(plugin)
    if entry is None:
        return None
    message = phrase("the hardware '{name}' cannot be imported", name=plugin)
    loaded_class: type[Hardware] = load_extension(entry, "CTL121", message)
    return loaded_class
