"""The base class of controllers, and their interface to a manager.

How to write one: a class, declared as an entry point of the group ``linkwright.controllers`` under its type name:

    class Copier(Controller[Parameters]):
        PARAMETERS = Parameters  # a dataclass, see `parameters`

        def command_interfaces(self):
            return [f"{joint}/position" for joint in self.parameters.joints]

        def on_configure(self):
            self._wanted = nan
            self.node.subscribe("std_msgs/msg/Float64", "~/command", self._on_command)

        def on_activate(self):
            self._wanted = nan

        def update(self, time_ns, period_s):
            for command in self.commands:
                command.value = self._wanted

Everything is called in one thread, that of the updates. Names, order and meaning of the callbacks are those of
``controller_interface`` of ros2_control.
"""

from __future__ import annotations

from abc import ABC
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Generic, TypeVar

from linkwright.control.controllers.node import ControllerNode
from linkwright.control.hardware.interfaces import CommandInterface, Interfaces, StateInterface
from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, joined, phrase
from linkwright.graph.lifecycle.states import UNCONFIGURED, LifecycleState
from linkwright.nodes.parameter_tables import NoParameters, ParameterTable

if TYPE_CHECKING:
    from linkwright.urdf import Robot

P = TypeVar("P")

InterfaceNames = Sequence[str] | Interfaces
"""Names of interfaces, ``joint1/position``; or all that there are."""


class ControllerError(LinkwrightError):
    """Raised by a controller that refuses to be configured or activated; its text is logged.

    Args:
        message: what is wrong, and how to fix it.
    """

    def __init__(self, message: str) -> None:
        super().__init__(Diagnostic("CTL102", foreign(message)))


@dataclass(frozen=True, slots=True)
class ControllerPlace:
    """The node, parameters and description that a manager gives to a controller.

    Attributes:
        name: the controller's name, that of its node.
        node: its node.
        update_rate: how often it is updated, in Hz.
        robot_description: the URDF of the robot; empty if none is known.
    """

    name: str
    node: ControllerNode
    update_rate: float
    robot_description: str = ""


class Controller(ABC, Generic[P]):
    """A controller.

    Args:
        place: where it runs.

    Raises:
        LinkwrightError: one of its parameters has a value that it cannot have.

    Attributes:
        PARAMETERS: the dataclass with its parameters.
        name: its name.
        node: its part of the ROS graph; its parameters are this node's.
        update_rate: how often it is updated, in Hz.
        robot_description: the URDF of the robot; empty if none is known.
        commands: the command interfaces that it has while it is active, in the order that it asked for them.
        states: the state interfaces; likewise.
        references: the inputs for another controller in chained mode, see `reference_interfaces`.
        exported: the states that it gives to others, see `exported_states`.
        chained: whether another controller commands its references.
        time_ns: the time of the latest update, in nanoseconds.
        state: where in its life it is.
    """

    PARAMETERS: ClassVar[type[Any]] = NoParameters

    def __init__(self, place: ControllerPlace) -> None:
        self.name = place.name
        self.node = place.node
        self.update_rate = place.update_rate
        self.robot_description = place.robot_description
        self.commands: list[CommandInterface] = []
        self.states: list[StateInterface] = []
        self.references: list[CommandInterface] = []
        self.exported: list[StateInterface] = []
        self.chained = False
        self.time_ns = 0
        self.state: LifecycleState = UNCONFIGURED
        self._parameters: ParameterTable[P] = ParameterTable(place.node.graph_node, self.PARAMETERS)
        for name, hint in self._parameters.unknown():
            message = phrase("'{name}' is not a parameter of this controller", name=name)
            self.node.logger.warning(message if hint is None else joined((message, hint), "; "))

    @classmethod
    def variant(cls, given: Collection[str]) -> type[Controller[Any]]:  # noqa: ARG003 - for those that share a name
        """The class for the names of given parameters: another one where two packages share the name of a type."""
        return cls

    @property
    def parameters(self) -> P:
        """Its current parameters; read those that may change at run time again for each use."""
        return self._parameters.values

    @cached_property
    def robot(self) -> Robot | None:
        """The robot; None where no description is known, or it cannot be read."""
        from linkwright.descriptions import DescriptionLibrary

        return DescriptionLibrary().read(self.robot_description).robot if self.robot_description else None

    # --- interfaces that it claims and exports, read after `on_configure` --------------------------------------------

    def command_interfaces(self) -> InterfaceNames:
        """The names of the command interfaces that it claims while it is active."""
        return ()

    def state_interfaces(self) -> InterfaceNames:
        """The names of the state interfaces that it reads while it is active."""
        return ()

    def reference_interfaces(self) -> Sequence[str]:
        """The names, without its own, of the references that another controller may command in place of its topics."""
        return ()

    def exported_states(self) -> Sequence[str]:
        """The names, without its own, of the states that other controllers may read."""
        return ()

    # --- its life -----------------------------------------------------------------------------------------------------

    def on_configure(self) -> None:
        """Read the parameters, make the topics.

        Raises:
            ControllerError: it cannot work so; it stays unconfigured.
        """

    def on_activate(self) -> None:
        """Start; `commands` and `states` are available now.

        Raises:
            ControllerError: it cannot; it stays inactive.
        """

    def on_deactivate(self) -> None:
        """Stop: set safe commands, such as zero velocity. `commands` and `states` become unavailable afterwards."""

    def on_cleanup(self) -> None:
        """Release what `on_configure` made; topics and services are removed automatically."""

    def on_error(self) -> None:
        """Handle an error other than ControllerError in one of the others, or in an update."""

    def on_set_chained_mode(self, chained: bool) -> None:
        """Note whether another controller commands the references from now on.

        Raises:
            ControllerError: it refuses.
        """

    # --- its work -----------------------------------------------------------------------------------------------------

    def update_references(self, time_ns: int, period_s: float) -> None:
        """Copy commands from topics into `references`; called before `update` unless another controller sets them."""

    def update(self, time_ns: int, period_s: float) -> None:
        """Read `states`, write `commands`.

        Args:
            time_ns: the time, in nanoseconds.
            period_s: the time since the last update, in seconds.

        Raises:
            Exception: whatever it raises is logged, and the controller is deactivated.
        """

    def step(self, time_ns: int, period_s: float) -> None:
        """Run an update for the manager: `update_references` where that is due, and `update`."""
        self.time_ns = time_ns
        if not self.chained and self.references:
            self.update_references(time_ns, period_s)
        self.update(time_ns, period_s)
