"""Controllers that forward commands to the interfaces of joints.

Source: forward_command_controller, position_controllers, velocity_controllers and effort_controllers of
ros2_controllers (parameters, topics, messages; velocities and efforts are 0 after deactivation).
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from linkwright.control.controllers.controller import Controller, ControllerError, InterfaceNames
from linkwright.control.hardware.interfaces import EFFORT, POSITION, VELOCITY
from linkwright.diagnostics import phrase
from linkwright.nodes.parameter_tables import parameter

P = TypeVar("P")


@dataclass(frozen=True, kw_only=True)
class ForwardParameters:
    """Parameters of ``ForwardCommandController``."""

    joints: tuple[str, ...] = parameter((), description="joints whose interface is commanded")
    interface_name: str = parameter("", description="the interface of the joints")


@dataclass(frozen=True, kw_only=True)
class MultiInterfaceParameters:
    """Parameters of ``MultiInterfaceForwardCommandController``."""

    joint: str = parameter("", description="the joint whose interfaces are commanded")
    interface_names: tuple[str, ...] = parameter((), description="the interfaces of the joint")


@dataclass(frozen=True, kw_only=True)
class GroupParameters:
    """Parameters of the ``JointGroup...Controller`` types."""

    joints: tuple[str, ...] = parameter((), description="joints whose interface is commanded")


class _ForwardingController(Controller[P], Generic[P]):
    """The base class of controllers that forward ``~/commands`` to interfaces."""

    @abstractmethod
    def _list_interface_names(self) -> Sequence[str]:
        """Return the names of the commanded interfaces.

        Raises:
            ControllerError: a parameter is empty.
        """

    def command_interfaces(self) -> InterfaceNames:
        """Return the names of the commanded interfaces."""
        return self._list_interface_names()

    def on_configure(self) -> None:
        """Subscribe to the commands."""
        self._list_interface_names()
        self._command: Sequence[float] | None = None
        command_guard = self.node.command_guard(self._stop_velocities)
        self.node.subscribe(
            "std_msgs/msg/Float64MultiArray", "~/commands", self._on_command, command_guard=command_guard
        )

    def on_activate(self) -> None:
        """Discard earlier commands."""
        self._command = None

    def on_deactivate(self) -> None:
        """Discard the last command."""
        self._command = None

    def update(self, time_ns: int, period_s: float) -> None:
        """Forward the last command."""
        values = self._command
        if values is None:
            return
        for command, value in zip(self.commands, values, strict=True):
            command.value = value

    def _stop_velocities(self) -> bool:
        """Set commanded velocities to zero, but keep commanded positions and efforts.

        Returns whether any commanded velocity was not zero.
        """
        if self._command is None:
            return False
        velocity_mask = [name.endswith(f"/{VELOCITY}") for name in self._list_interface_names()]
        old_values = self._command
        self._command = [
            0.0 if is_velocity else value for is_velocity, value in zip(velocity_mask, old_values, strict=True)
        ]
        return self._command != old_values

    def _on_command(self, message: Any) -> None:
        values, count = list(message.data), len(self.commands)
        if not count:
            return  # Commands are ignored while the controller is not active.
        if len(values) != count:
            self.node.logger.error(
                f"command size ({len(values)}) does not match number of interfaces ({count})",
                throttle_duration_sec=1.0,
            )
            return
        if any(value != value for value in values):
            self.node.logger.error(phrase("a command with NaN is not forwarded"), throttle_duration_sec=1.0)
            return
        self._command = values


class ForwardCommandController(_ForwardingController[ForwardParameters]):
    """``forward_command_controller/ForwardCommandController``."""

    PARAMETERS = ForwardParameters

    def _list_interface_names(self) -> Sequence[str]:
        if not self.parameters.joints:
            raise ControllerError("'joints' parameter was empty")
        if not self.parameters.interface_name:
            raise ControllerError("'interface_name' parameter was empty")
        return [f"{joint}/{self.parameters.interface_name}" for joint in self.parameters.joints]


class MultiInterfaceForwardCommandController(_ForwardingController[MultiInterfaceParameters]):
    """``forward_command_controller/MultiInterfaceForwardCommandController``."""

    PARAMETERS = MultiInterfaceParameters

    def _list_interface_names(self) -> Sequence[str]:
        if not self.parameters.joint:
            raise ControllerError("'joint' parameter is empty")
        if not self.parameters.interface_names:
            raise ControllerError("'interfaces' parameter is empty")
        return [f"{self.parameters.joint}/{name}" for name in self.parameters.interface_names]


class _JointGroupController(_ForwardingController[GroupParameters]):
    PARAMETERS = GroupParameters
    INTERFACE: str
    """The interface of the joints that is commanded."""
    STOPS_ON_DEACTIVATION = True
    """Whether the joints are commanded to 0 on deactivation."""

    def _list_interface_names(self) -> Sequence[str]:
        if not self.parameters.joints:
            raise ControllerError("'joints' parameter was empty")
        return [f"{joint}/{self.INTERFACE}" for joint in self.parameters.joints]

    def on_deactivate(self) -> None:
        """Command zero to the joints, unless their positions are commanded."""
        super().on_deactivate()
        if self.STOPS_ON_DEACTIVATION:
            for command in self.commands:
                command.value = 0.0


class JointGroupPositionController(_JointGroupController):
    """``position_controllers/JointGroupPositionController``."""

    INTERFACE = POSITION
    STOPS_ON_DEACTIVATION = False  # Joints keep their positions.


class JointGroupVelocityController(_JointGroupController):
    """``velocity_controllers/JointGroupVelocityController``."""

    INTERFACE = VELOCITY


class JointGroupEffortController(_JointGroupController):
    """``effort_controllers/JointGroupEffortController``."""

    INTERFACE = EFFORT
