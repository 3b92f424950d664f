"""The hardware of a robot: its interfaces, the claims of controllers, and its lifecycle.

Source: the resource manager of ros2_control (rules and messages).
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from typing import TypeVar

from linkwright.control.hardware.component import Hardware, hardware_class
from linkwright.control.hardware.description import HardwareDescription
from linkwright.control.hardware.interfaces import CommandInterface, Interface, Interfaces, StateInterface
from linkwright.control.hardware.replacement import ReplacementSystem
from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.graph.lifecycle.states import ACTIVE, FINALIZED, INACTIVE, UNCONFIGURED, LifecycleState
from linkwright.graph.log.logger import Logger

HardwareFactory = Callable[[HardwareDescription, Logger], "Hardware | None"]
"""A function that creates the hardware of a description, or returns None if the type is not supported."""

N = TypeVar("N", bound=Interface)

_STATE_ORDER = (UNCONFIGURED, INACTIVE, ACTIVE)
_UP_TRANSITIONS = ("configure", "activate")
_DOWN_TRANSITIONS = ("cleanup", "deactivate")


def create_installed_hardware(description: HardwareDescription, logger: Logger) -> Hardware | None:
    """Create the hardware of a description, or return None if its type is not installed."""
    hardware_type = hardware_class(description.plugin)
    return None if hardware_type is None else hardware_type(description, logger)


class Resources:
    """The hardware of a robot, with the interfaces that controllers use.

    Args:
        logger: the logger of its events.

    Attributes:
        components: the hardware by name.
        claims: the name of the controller that has claimed a command interface, by the interface's name.
    """

    def __init__(self, logger: Logger) -> None:
        self.components: dict[str, Hardware] = {}
        self.claims: dict[str, str] = {}
        self._logger = logger
        self._states: dict[str, StateInterface] = {}
        self._commands: dict[str, CommandInterface] = {}
        self._hardware_by_interface: dict[str, Hardware] = {}
        self._references: dict[str, list[CommandInterface]] = {}
        self._exported: dict[str, list[StateInterface]] = {}
        self._available: set[str] = set()

    # --- loading ------------------------------------------------------------------------------------------------------

    def load(self, descriptions: Sequence[HardwareDescription], create_hardware: HardwareFactory) -> None:
        """Create hardware from descriptions.

        If a type is not supported, a mock replaces it, and a warning is logged.
        """
        for description in descriptions:
            self._logger.info(f"Loading hardware '{description.name}' ")
            try:
                hardware = create_hardware(description, self._logger)
            except LinkwrightError as error:
                self._logger.error(error.diagnostics[0].message)  # noqa: TRY400 - the message is for users
                continue
            if hardware is None:
                self._logger.warning(
                    phrase(
                        "hardware '{name}': Linkwright does not support '{plugin}', so a mock replaces it, "
                        "and its joints move as the claimed commands say",
                        name=description.name,
                        plugin=description.plugin,
                    )
                )
                hardware = ReplacementSystem(description, self._logger)
            if description.is_async:
                self._logger.info(
                    phrase(
                        "hardware '{name}': is_async is not supported, so the hardware is read and written in "
                        "the control loop",
                        name=description.name,
                    )
                )
            self._logger.info(f"Initialize hardware '{description.name}' ")
            self.components[description.name] = hardware
            for state in hardware.states:
                self._states.setdefault(state.name, state)
            for command in hardware.commands:
                self._commands.setdefault(command.name, command)
            self._hardware_by_interface.update(
                (state.name, hardware) for state in (*hardware.states, *hardware.commands)
            )
            self._logger.info(f"Successful initialization of hardware '{description.name}'")
        replacements = [item for item in self.components.values() if isinstance(item, ReplacementSystem)]
        for replacement in replacements:
            replacement.show_joints_of(replacements)

    # --- interfaces ---------------------------------------------------------------------------------------------------

    @property
    def state_names(self) -> list[str]:
        """The names of all state interfaces, including states exported by controllers."""
        return [*self._states, *(interface.name for exported in self._exported.values() for interface in exported)]

    @property
    def command_names(self) -> list[str]:
        """The names of all command interfaces, including references of chainable controllers."""
        return [
            *self._commands,
            *(interface.name for references in self._references.values() for interface in references),
        ]

    def is_available(self, name: str) -> bool:
        """Return whether an interface is available.

        An interface is available if its hardware is configured or its controller is active.
        """
        hardware = self._hardware_by_interface.get(name)
        return name in self._available if hardware is None else hardware.state in (INACTIVE, ACTIVE)

    def states(self, names: Sequence[str] | Interfaces) -> list[StateInterface]:
        """Return state interfaces by name, or all available state interfaces.

        Raises:
            KeyError: a named interface does not exist, or is not available.
        """
        if names is Interfaces.ALL:
            return [state for state in self._all_states() if self.is_available(state.name)]
        return [self._find_interface(name, self._all_states(), "State") for name in names]

    def commands(self, names: Sequence[str] | Interfaces) -> list[CommandInterface]:
        """Return command interfaces by name, or all available command interfaces.

        Raises:
            KeyError: a named interface does not exist, or is not available.
        """
        if names is Interfaces.ALL:
            return [command for command in self._all_commands() if self.is_available(command.name)]
        return [self._find_interface(name, self._all_commands(), "Command") for name in names]

    def _all_states(self) -> Iterator[StateInterface]:
        yield from self._states.values()
        for exported in self._exported.values():
            yield from exported

    def _all_commands(self) -> Iterator[CommandInterface]:
        yield from self._commands.values()
        for references in self._references.values():
            yield from references

    def _find_interface(self, name: str, interfaces: Iterator[N], kind: str) -> N:
        match = next((interface for interface in interfaces if interface.name == name), None)
        if match is None:
            raise KeyError(f"{kind} interface with key '{name}' does not exist")
        if not self.is_available(name):
            raise KeyError(f"{kind} interface with '{name}' does not exist")
        return match

    def add_exported_interfaces(
        self, controller: str, references: list[CommandInterface], exported_states: list[StateInterface]
    ) -> None:
        """Add the references and exported states of a chainable controller."""
        self._references[controller], self._exported[controller] = references, exported_states

    def remove_exported_interfaces(self, controller: str) -> None:
        """Remove the references and exported states of a controller."""
        self.set_available(controller, available=False)
        self._references.pop(controller, None)
        self._exported.pop(controller, None)

    def reference_names(self, controller: str) -> list[str]:
        """Return the names of a controller's references."""
        return [reference.name for reference in self._references.get(controller, ())]

    def set_available(self, controller: str, *, available: bool) -> None:
        """Set whether a controller's references and exported states are available."""
        names = {
            reference.name for reference in (*self._references.get(controller, ()), *self._exported.get(controller, ()))
        }
        self._available = self._available | names if available else self._available - names

    # --- lifecycle ----------------------------------------------------------------------------------------------------

    def set_state(self, name: str, target: LifecycleState) -> bool:
        """Bring hardware to a lifecycle state, and return whether the state was reached."""
        hardware = self.components[name]
        if hardware.state == FINALIZED:
            return target == FINALIZED
        if target == FINALIZED:
            is_reached = self.set_state(name, UNCONFIGURED)
            hardware.state = FINALIZED
            return is_reached
        while hardware.state != target:
            index = _STATE_ORDER.index(hardware.state)
            is_upward = _STATE_ORDER.index(target) > index
            is_done = self._run_transition(
                hardware,
                _UP_TRANSITIONS[index] if is_upward else _DOWN_TRANSITIONS[index - 1],
                _STATE_ORDER[index + (1 if is_upward else -1)],
            )
            if not is_done:
                return False
        return True

    def _run_transition(self, hardware: Hardware, transition: str, goal: LifecycleState) -> bool:
        name = hardware.description.name
        self._logger.info(f"'{transition}' hardware '{name}' ")
        failure = _call_hardware(getattr(hardware, f"on_{transition}"))
        if failure:
            self._logger.error(f"Failed to '{transition}' hardware '{name}': {failure}")
            return False
        hardware.state = goal
        self._logger.info(f"Successful '{transition}' of hardware '{name}'")
        return True

    # --- updates ------------------------------------------------------------------------------------------------------

    def prepare_switch(self, start: Collection[str], stop: Collection[str]) -> str:
        """Check whether all hardware permits a switch of command interfaces.

        Returns an error message, or an empty string if the switch is possible.
        """
        for hardware in self.components.values():
            failure = _call_hardware(hardware.prepare_switch, start, stop)
            if failure:
                name = hardware.description.name
                return f"Component '{name}' did not accept command interfaces combination: {failure}"
        return ""

    def perform_switch(self, start: Collection[str], stop: Collection[str]) -> None:
        """Switch the command interfaces of all hardware, and log failures."""
        for hardware in self.components.values():
            failure = _call_hardware(hardware.perform_switch, start, stop)
            if failure:
                self._logger.error(f"Component '{hardware.description.name}' could not perform switch: {failure}")

    def read(self, time_ns: int, period_s: float) -> list[Hardware]:
        """Read the states of all hardware that is inactive or active.

        Returns the components that failed. Their errors are logged, and they become unconfigured; if their `on_error`
        also fails, they become finalized.
        """
        failed = []
        for hardware in self.components.values():
            if hardware.state is INACTIVE or hardware.state is ACTIVE:
                try:
                    if hardware.timings is None:
                        hardware.read(time_ns, period_s)
                    else:
                        hardware.timings[0].measure(hardware.read, time_ns, period_s)
                except Exception as error:  # noqa: BLE001 - an error of hardware must not stop other hardware
                    failed.append(self._handle_failure(hardware, "reading", error))
        return failed

    def write(self, time_ns: int, period_s: float) -> list[Hardware]:
        """Write the commands of all active hardware.

        Returns the components that failed; their errors are handled as in `read`.
        """
        failed = []
        for hardware in self.components.values():
            if hardware.state is ACTIVE:
                try:
                    if hardware.timings is None:
                        hardware.write(time_ns, period_s)
                    else:
                        hardware.timings[1].measure(hardware.write, time_ns, period_s)
                except Exception as error:  # noqa: BLE001 - an error of hardware must not stop other hardware
                    failed.append(self._handle_failure(hardware, "writing", error))
        return failed

    def _handle_failure(self, hardware: Hardware, activity: str, error: Exception) -> Hardware:
        self._logger.error(f"Error while {activity} hardware '{hardware.description.name}': {_describe_error(error)}")
        failure = _call_hardware(hardware.on_error)
        if failure:
            self._logger.error(f"'on_error' of hardware '{hardware.description.name}' failed: {failure}")
        hardware.state = FINALIZED if failure else UNCONFIGURED
        return hardware

    def list_interface_names(self, hardware: Hardware) -> set[str]:
        """Return the names of all state and command interfaces of a hardware component."""
        return {state.name for state in (*hardware.states, *hardware.commands)}


def _call_hardware(callback: Callable[..., object], *arguments: object) -> str:
    """Call a function of hardware, and return the message of its error, or an empty string."""
    try:
        callback(*arguments)
    except Exception as error:  # noqa: BLE001 - an error of hardware must not stop other hardware
        return _describe_error(error)
    return ""


def _describe_error(error: Exception) -> str:
    if isinstance(error, LinkwrightError):
        return str(error.diagnostics[0].message)
    return f"{type(error).__name__}: {error}"
