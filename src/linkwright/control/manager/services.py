"""The services and topics of the controller manager.

Source: controller_manager_msgs and the controller manager of ros2_control.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from linkwright.control.controllers.registry import controller_types
from linkwright.control.hardware.component import Hardware
from linkwright.control.manager.loaded import LoadedController
from linkwright.control.manager.manager import ControllerManager
from linkwright.control.manager.statistics import StatisticsTopics
from linkwright.graph.lifecycle.states import ACTIVE, FINALIZED, INACTIVE, UNCONFIGURED, LifecycleState
from linkwright.graph.qos.profile import LATCHED_QOS
from linkwright.graph.stepped.node import SteppedNode
from linkwright.messages import get_message, is_before_iron

_PACKAGE = "controller_manager_msgs"
_CONTROLLER_BASE, _CHAINABLE_CONTROLLER_BASE = (
    "controller_interface::ControllerInterface",
    "controller_interface::ChainableControllerInterface",
)
_STATES = {state.state_id: state for state in (UNCONFIGURED, INACTIVE, ACTIVE, FINALIZED)}


class ManagerServices:
    """The services and topics of a controller manager.

    Args:
        manager: the manager.
        node: the manager's node as a `SteppedNode`; its callbacks run in the update thread.
    """

    def __init__(self, manager: ControllerManager, node: SteppedNode) -> None:
        self._manager = manager
        self._activity_output = node.publisher(f"{_PACKAGE}/msg/ControllerManagerActivity", "~/activity", LATCHED_QOS)
        self._diagnostics_output = node.publisher("diagnostic_msgs/msg/DiagnosticArray", "/diagnostics")
        self._statistics = None if is_before_iron() else StatisticsTopics(manager, node)
        manager.on_change = self.publish_activity
        callbacks: dict[str, Callable[[Any, Any], Any]] = {
            "ListControllers": self._list_controllers,
            "ListControllerTypes": _list_types,
            "LoadController": lambda request, response: _set_ok(response, manager.load(request.name)),
            "ConfigureController": lambda request, response: _set_ok(response, manager.configure(request.name)),
            "CleanupController": lambda request, response: _set_ok(response, manager.cleanup(request.name)),
            "UnloadController": lambda request, response: _set_ok(response, manager.unload(request.name)),
            "ReloadControllerLibraries": lambda request, response: _set_ok(
                response, manager.reload(force=request.force_kill)
            ),
            "SwitchController": self._switch,
            "ListHardwareComponents": self._list_components,
            "ListHardwareInterfaces": self._list_interfaces,
            "SetHardwareComponentState": self._set_state,
        }
        for name, callback in callbacks.items():
            node.service(f"{_PACKAGE}/srv/{name}", f"~/{_to_service_name(name)}", callback)
        self.publish_activity()

    def publish_activity(self) -> None:
        """Publish the lifecycle states of controllers and hardware."""
        message = get_message(f"{_PACKAGE}/msg/ControllerManagerActivity")()
        message.header.stamp = self._manager.node.get_clock().now().to_msg()
        message.controllers = [
            _build_named_state(controller.name, controller.controller.state)
            for controller in self._manager.controllers.values()
        ]
        message.hardware_components = [
            _build_named_state(name, hardware.state) for name, hardware in self._manager.resources.components.items()
        ]
        self._activity_output.publish(message)

    def publish_diagnostics(self) -> None:
        """Publish whether controllers and hardware are active, and the statistics.

        The caller is a timer with a period of 1 s.
        """
        if self._statistics is not None:
            self._statistics.publish()
        if not self._diagnostics_output.is_wanted:
            return
        message = get_message("diagnostic_msgs/msg/DiagnosticArray")()
        message.header.stamp = self._manager.node.get_clock().now().to_msg()
        name = self._manager.node.get_name()
        controllers = {
            controller.name: controller.controller.state for controller in self._manager.controllers.values()
        }
        components = {name: hardware.state for name, hardware in self._manager.resources.components.items()}
        message.status = [
            _build_status(f"{name}: Controllers Activity", "controllers", controllers),
            _build_status(f"{name}: Hardware Components Activity", "hardware components", components),
        ]
        self._diagnostics_output.publish(message)

    # --- controllers --------------------------------------------------------------------------------------------------

    def _list_controllers(self, _: Any, response: Any) -> Any:
        response.controller = [
            self._build_controller_message(controller) for controller in self._manager.controllers.values()
        ]
        return response

    def _build_controller_message(self, loaded: LoadedController) -> Any:
        resources = self._manager.resources
        controller = loaded.controller
        message = get_message(f"{_PACKAGE}/msg/ControllerState")(name=loaded.name, type=loaded.type)
        message.state = controller.state.label
        message.update_rate = int(controller.update_rate)
        message.claimed_interfaces = [name for name, claimant in resources.claims.items() if claimant == loaded.name]
        message.is_chainable, message.is_chained = loaded.is_chainable, controller.is_chained
        if not loaded.is_configured:
            return message
        message.required_command_interfaces = loaded.claimed_command_interfaces(resources.command_names)
        message.required_state_interfaces = loaded.required_state_interfaces(resources.state_names)
        message.exported_state_interfaces = [interface.kind for interface in controller.exported]
        message.reference_interfaces = [reference.kind for reference in controller.references]
        chains: dict[str, list[str]] = {}
        for interface_name in message.required_command_interfaces:
            name, _, kind = interface_name.partition("/")
            if name in self._manager.controllers:
                chains.setdefault(name, []).append(kind)
        connection = get_message(f"{_PACKAGE}/msg/ChainConnection")
        message.chain_connections = [
            connection(name=name, reference_interfaces=kinds) for name, kinds in chains.items()
        ]
        return message

    def _switch(self, request: Any, response: Any) -> Any:
        response.ok, response.message = self._manager.switch(
            request.activate_controllers, request.deactivate_controllers, request.strictness
        )
        return response

    # --- hardware -----------------------------------------------------------------------------------------------------

    def _list_components(self, _: Any, response: Any) -> Any:
        response.component = [
            self._build_component_message(component) for component in self._manager.resources.components.values()
        ]
        return response

    def _build_component_message(self, hardware: Hardware) -> Any:
        description = hardware.description
        message = get_message(f"{_PACKAGE}/msg/HardwareComponentState")(name=description.name, type=description.type)
        message.plugin_name = message.class_type = description.plugin
        message.rw_rate = int(self._manager.update_rate)
        message.state.id, message.state.label = hardware.state.state_id, hardware.state.label
        message.command_interfaces = [self._build_interface_message(command.name) for command in hardware.commands]
        message.state_interfaces = [self._build_interface_message(state.name) for state in hardware.states]
        return message

    def _build_interface_message(self, name: str) -> Any:
        resources = self._manager.resources
        return get_message(f"{_PACKAGE}/msg/HardwareInterface")(
            name=name,
            data_type="double",
            is_available=resources.is_available(name),
            is_claimed=name in resources.claims,
        )

    def _list_interfaces(self, _: Any, response: Any) -> Any:
        resources = self._manager.resources
        response.command_interfaces = [
            self._build_interface_message(command_name) for command_name in resources.command_names
        ]
        response.state_interfaces = [self._build_interface_message(state_name) for state_name in resources.state_names]
        for state_interface in response.state_interfaces:
            state_interface.is_claimed = False
        return response

    def _set_state(self, request: Any, response: Any) -> Any:
        resources = self._manager.resources
        if request.name not in resources.components:
            self._manager.node.get_logger().error(f"hardware component with name '{request.name}' does not exist")
            response.ok = False
            return response
        requested = request.target_state
        target = _STATES.get(requested.id) or next(
            (state for state in _STATES.values() if state.label == requested.label), None
        )
        response.ok = target is not None and self._manager.set_hardware_state(request.name, target)
        state = resources.components[request.name].state
        response.state.id, response.state.label = state.state_id, state.label
        return response


def _to_service_name(name: str) -> str:
    """Return the name of a service from its type: ``list_controllers`` for ``ListControllers``."""
    return "".join(f"_{letter.lower()}" if letter.isupper() else letter for letter in name).lstrip("_")


def _set_ok(response: Any, succeeded: bool) -> Any:
    response.ok = succeeded
    return response


def _list_types(_: Any, response: Any) -> Any:
    from linkwright.control.controllers.controller import Controller
    from linkwright.control.controllers.registry import controller_class
    from linkwright.diagnostics import LinkwrightError

    for name in controller_types():
        try:
            controller_type = controller_class(name)
        except LinkwrightError:
            continue  # The error of a broken package is reported on loading.
        is_chainable = controller_type.reference_interfaces is not Controller.reference_interfaces
        response.types.append(name)
        response.base_classes.append(_CHAINABLE_CONTROLLER_BASE if is_chainable else _CONTROLLER_BASE)
    return response


def _build_named_state(name: str, state: LifecycleState) -> Any:
    message = get_message(f"{_PACKAGE}/msg/NamedLifecycleState")(name=name)
    message.state.id, message.state.label = state.state_id, state.label
    return message


def _build_status(name: str, subject: str, states: dict[str, LifecycleState]) -> Any:
    status = get_message("diagnostic_msgs/msg/DiagnosticStatus")(name=name, hardware_id="ros2_control")
    value = get_message("diagnostic_msgs/msg/KeyValue")
    status.values = [value(key=key, value=state.label) for key, state in states.items()]
    all_active = all(state is ACTIVE for state in states.values())
    status.message = f"All {subject} are active" if all_active else f"Not all {subject} are active"
    return status
