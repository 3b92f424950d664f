"""The base class of controllers, and their interface to a manager.

A controller is a class that is declared as an entry point of the group ``linkwright.controllers`` under its type name:

    class Copier(Controller[Parameters]):
        PARAMETERS = Parameters  # a dataclass, see `parameters`

        def command_interfaces(self):
            return [f"{joint}/position" for joint in self.parameters.joints]

        def on_configure(self):
            self._target = nan
            self.node.subscribe("std_msgs/msg/Float64", "~/command", self._on_command)

        def on_activate(self):
            self._target = nan

        def update(self, time_ns, period_s):
            for command in self.commands:
                command.value = self._target

All methods are called in one thread, the update thread. The callbacks have the same names, order and meaning as in
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
"""The names of interfaces, such as ``joint1/position``, or all interfaces."""


class ControllerError(LinkwrightError):
    """Raised by a controller that cannot be configured, activated or updated.

    The message is logged.

    Args:
        message: what is wrong, and how to fix it.
    """

    def __init__(self, message: str) -> None:
        super().__init__(Diagnostic("CTL102", foreign(message)))


@dataclass(frozen=True, slots=True)
class ControllerContext:
    """The node, update rate and description that a manager passes to a controller.

    Attributes:
        name: the name of the controller and of its node.
        node: the controller's node.
        update_rate: the rate of the controller's updates, in Hz.
        robot_description: the URDF of the robot; empty if none is known.
    """

    name: str
    node: ControllerNode
    update_rate: float
    robot_description: str = ""


class Controller(ABC, Generic[P]):
    """The base class of controllers, which compute commands from states in each update.

    Args:
        context: the node and settings that the manager provides.

    Raises:
        LinkwrightError: a parameter has a value that is not allowed.

    Attributes:
        PARAMETERS: the dataclass with the controller's parameters.
        name: the controller's name.
        node: the controller's node, which has the parameters.
        update_rate: the rate of the controller's updates, in Hz.
        robot_description: the URDF of the robot; empty if none is known.
        commands: the command interfaces available while the controller is active, in the order of `command_interfaces`.
        states: the state interfaces, in the order of `state_interfaces`.
        references: the inputs that another controller may command; see `reference_interfaces`.
        exported: the states for other controllers; see `exported_states`.
        is_chained: whether another controller commands the references.
        time_ns: the time of the latest update, in nanoseconds.
        state: the lifecycle state.
    """

    PARAMETERS: ClassVar[type[Any]] = NoParameters

    def __init__(self, context: ControllerContext) -> None:
        self.name = context.name
        self.node = context.node
        self.update_rate = context.update_rate
        self.robot_description = context.robot_description
        self.commands: list[CommandInterface] = []
        self.states: list[StateInterface] = []
        self.references: list[CommandInterface] = []
        self.exported: list[StateInterface] = []
        self.is_chained = False
        self.time_ns = 0
        self.state: LifecycleState = UNCONFIGURED
        self._parameters: ParameterTable[P] = ParameterTable(context.node.graph_node, self.PARAMETERS)
        self.declare_parameters()
        for name, hint in self._parameters.unknown_parameters():
            message = phrase("'{name}' is not a parameter of this controller", name=name)
            self.node.logger.warning(message if hint is None else joined((message, hint), "; "))

    def declare_parameters(self) -> None:
        """Declare parameters whose names follow from the values of other parameters.

        The parameters in `PARAMETERS` are declared before this call.

        Raises:
            LinkwrightError: a parameter has a value that is not allowed.
        """

    @classmethod
    def variant(cls, parameter_names: Collection[str]) -> type[Controller[Any]]:  # noqa: ARG003 - overrides use it
        """Return the controller class for which the parameters are intended.

        If two packages use the same type name, this may return another class. `parameter_names` contains the names of
        the parameters that have values.
        """
        return cls

    @property
    def parameters(self) -> P:
        """The current parameters.

        Do not store them, because they may change at run time.
        """
        return self._parameters.values

    @cached_property
    def robot(self) -> Robot | None:
        """The parsed robot description, or None if it is unknown or cannot be parsed."""
        from linkwright.descriptions import DescriptionLibrary

        return DescriptionLibrary().read(self.robot_description).robot if self.robot_description else None

    # --- claimed and exported interfaces, read after `on_configure` --------------------------------------------------

    def command_interfaces(self) -> InterfaceNames:
        """Return the names of the command interfaces that the controller claims while it is active."""
        return ()

    def state_interfaces(self) -> InterfaceNames:
        """Return the names of the state interfaces that the controller reads while it is active."""
        return ()

    def reference_interfaces(self) -> Sequence[str]:
        """Return the names of the references that another controller may command instead of topics.

        The names do not include the controller's name.
        """
        return ()

    def exported_states(self) -> Sequence[str]:
        """Return the names of the states that other controllers may read.

        The names do not include the controller's name.
        """
        return ()

    # --- lifecycle ----------------------------------------------------------------------------------------------------

    def on_configure(self) -> None:
        """Read the parameters, and create the topics.

        Raises:
            ControllerError: the controller cannot be configured; it stays unconfigured.
        """

    def on_activate(self) -> None:
        """Start the controller.

        `commands` and `states` are available from this call until `on_deactivate` returns.

        Raises:
            ControllerError: the controller cannot be activated; it stays inactive.
        """

    def on_deactivate(self) -> None:
        """Write safe commands, such as zero velocity.

        Afterwards `commands` and `states` are no longer available.
        """

    def on_cleanup(self) -> None:
        """Release the resources of `on_configure`, except topics and services.

        Topics and services are removed automatically.
        """

    def on_error(self) -> None:
        """Handle an exception, other than `ControllerError`, that a callback or an update raised."""

    def on_set_chained_mode(self, chained: bool) -> None:
        """Handle a change of chained mode, in which another controller commands the references.

        Raises:
            ControllerError: the controller refuses the change.
        """

    # --- updates ------------------------------------------------------------------------------------------------------

    def update_references(self, time_ns: int, period_s: float) -> None:
        """Copy commands from topics into `references`.

        Called before `update`, unless another controller commands the references.
        """

    def update(self, time_ns: int, period_s: float) -> None:
        """Read `states`, and write `commands`.

        Args:
            time_ns: the time, in nanoseconds.
            period_s: the time since the last update, in seconds.

        Raises:
            Exception: any exception is logged, and the controller is deactivated.
        """

    def step(self, time_ns: int, period_s: float) -> None:
        """Run `update`, preceded by `update_references` if no controller commands the references."""
        self.time_ns = time_ns
        if not self.is_chained and self.references:
            self.update_references(time_ns, period_s)
        self.update(time_ns, period_s)
