"""The controller manager, which loads, configures, switches and updates controllers.

Source: the controller manager of ros2_control (order of steps, rules, messages).
"""

from __future__ import annotations

import traceback
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from math import nan
from typing import Any

from linkwright.control.controllers.controller import Controller, ControllerContext, ControllerError
from linkwright.control.controllers.node import ControllerNode
from linkwright.control.controllers.registry import controller_class, controller_types
from linkwright.control.hardware.component import Hardware
from linkwright.control.hardware.interfaces import CommandInterface, StateInterface
from linkwright.control.hardware.limits import CommandLimits
from linkwright.control.hardware.resources import Resources
from linkwright.control.manager.loaded import LoadedController
from linkwright.control.manager.nodes import ProcessArguments, create_controller_node, read_string_list
from linkwright.control.manager.switching import BEST_EFFORT, Switch, SwitchPlanner, SwitchRefusedError
from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.graph import Node, Parameter
from linkwright.graph.lifecycle.states import ACTIVE, FINALIZED, INACTIVE, UNCONFIGURED, LifecycleState
from linkwright.graph.stepped.exchange import Exchange
from linkwright.messages.distribution import is_before_iron
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND


@dataclass(frozen=True, slots=True)
class SavedState:
    """The state of a manager that another manager can resume.

    Attributes:
        parameters: the parameters of the manager's node, by name.
        controllers: the name and the state label of each loaded controller, in the order of updates.
    """

    parameters: dict[str, Any] = field(default_factory=dict)
    controllers: tuple[tuple[str, str], ...] = ()


class ControllerManager:
    """The manager of a robot's controllers, for use in the update thread only.

    Args:
        node: the manager's node, which accepts undeclared parameters.
        exchange: the exchange between the update thread and the graph.
        resources: the hardware.
        process: the arguments for the nodes of the controllers.
        update_rate: the update rate, in Hz.

    Attributes:
        node: the manager's node.
        resources: the hardware.
        update_rate: the update rate, in Hz.
        robot_description: the URDF of the robot.
        controllers: the loaded controllers by name, in the order in which they are updated.
        limits: the limiter of the commands to joints; None if limits are not enforced.
        on_change: called when the state of a controller or of hardware has changed.
    """

    def __init__(
        self,
        node: Node,
        exchange: Exchange,
        resources: Resources,
        process_arguments: ProcessArguments | None = None,
        *,
        update_rate: float = 100.0,
    ) -> None:
        self.node = node
        self.resources = resources
        self.update_rate = update_rate
        self.robot_description = ""
        self.controllers: dict[str, LoadedController] = {}
        self.limits: CommandLimits | None = None
        self.on_change: Callable[[], object] = lambda: None
        self._exchange = exchange
        self._process_arguments = process_arguments or ProcessArguments()
        self._logger = node.get_logger()
        self._active: list[LoadedController] = []

    # --- loading ------------------------------------------------------------------------------------------------------

    def load(self, name: str) -> bool:
        """Load a controller with the type in the parameter ``NAME.type``.

        Returns whether that succeeded; errors are logged.
        """
        logger = self._logger
        if name in self.controllers:
            logger.error(f"A controller named '{name}' was already loaded inside the controller manager")
            return False
        type_name = next(iter(read_string_list(self.node, f"{name}.type")), "")
        if not type_name:
            logger.error(f"The 'type' param was not defined for '{name}'.")
            return False
        logger.info(f"Loading controller '{name}'")
        try:
            controller_type = controller_class(str(type_name))
        except LinkwrightError as error:
            logger.error(f"Loader for controller '{name}' (type '{type_name}') not found.")  # noqa: TRY400 - `_log_error` says why
            self._log_error(error)
            logger.info("Available classes:")
            for available_type in controller_types():
                logger.info(f"  {available_type}")
            return False
        controller = self._create_controller(controller_type, name)
        if controller is None:
            logger.error(f"Could not initialize the controller named '{name}'")
            return False
        fallbacks = tuple(read_string_list(self.node, f"{name}.fallback_controllers"))
        self.controllers[name] = LoadedController(name, str(type_name), controller, fallbacks)
        self.on_change()
        return True

    def _create_controller(self, controller_type: type[Controller[Any]], name: str) -> Controller[Any] | None:
        node = None
        try:
            node = create_controller_node(self.node, name, self._process_arguments)
            rate = node.declare_parameter("update_rate", int(self.update_rate)).value
            if not is_before_iron() and node.declare_parameter("is_async", False).value:
                node.get_logger().info(
                    phrase("is_async is not supported, so the controller is updated in the control loop")
                )
            context = ControllerContext(name, ControllerNode(node, self._exchange), float(rate), self.robot_description)
            return controller_type.variant(node.undeclared_overrides())(context)
        except LinkwrightError as error:
            self._log_error(error)
        except Exception as error:  # noqa: BLE001 - an error of a controller must not stop other controllers
            self._logger.error(_add_traceback("Exception thrown during init stage with message", error))  # noqa: TRY400 - `_add_traceback` contains the traceback
        if node is not None:
            node.destroy_node()
        return None

    def unload(self, name: str) -> bool:
        """Unload a controller, unless it is active, and return whether that succeeded."""
        loaded_controller = self.controllers.get(name)
        if loaded_controller is None or loaded_controller.is_active:
            reason = "it is still active" if loaded_controller is not None else "no controller with this name exists"
            self._logger.error(f"Could not unload controller with name '{name}' because {reason}")
            return False
        if loaded_controller.is_inactive:
            self._clean_up(loaded_controller)
        loaded_controller.controller.node.close()
        del self.controllers[name]
        self.on_change()
        return True

    def reload(self, *, force: bool) -> bool:
        """Unload all controllers, and return whether that was permitted.

        If a controller is active, nothing is unloaded unless `force` is set. With `force`, active controllers are
        stopped first.
        """
        active = [controller.name for controller in self._active]
        if active and not force:
            self._logger.error(
                "Controller manager: Cannot reload controller libraries because there are still "
                f"{len(active)} active controllers"
            )
            return False
        if self.controllers:
            self._logger.info("Controller manager: Stopping all active controllers")
            self.switch((), active, BEST_EFFORT)
        for name in tuple(self.controllers):
            self.unload(name)
        self._logger.info("Controller manager: reloaded controller libraries for 'controller_interface'")
        return True

    def saved_state(self) -> SavedState:
        """Return the manager's parameters and the states of its controllers, for `resume`."""
        parameters = {
            name: node_parameter.value for name, node_parameter in self.node.get_parameters_by_prefix("").items()
        }
        states = tuple((controller.name, controller.controller.state.label) for controller in self.controllers.values())
        return SavedState(parameters, states)

    def resume(self, saved_state: SavedState) -> None:
        """Load another manager's controllers, and restore their states as far as possible.

        Parameters of the other manager that this manager lacks are set first.
        """
        missing_parameters = [
            Parameter(name, value=value)
            for name, value in saved_state.parameters.items()
            if not self.node.has_parameter(name)
        ]
        if missing_parameters:
            self.node.set_parameters(missing_parameters)
        for name, state in saved_state.controllers:
            if self.load(name) and state != UNCONFIGURED.label:
                self.configure(name)
        active = [name for name, state in saved_state.controllers if state == ACTIVE.label and name in self.controllers]
        if active:
            self.switch(active, (), BEST_EFFORT)

    def close(self) -> None:
        """Deactivate all controllers, and remove their nodes."""
        for loaded in reversed(tuple(self._active)):
            self._deactivate(loaded)
        for name in tuple(self.controllers):
            self.controllers.pop(name).controller.node.close()

    # --- configuration ------------------------------------------------------------------------------------------------

    def configure(self, name: str) -> bool:
        """Configure a controller that is not active, and return whether that succeeded."""
        self._logger.info(f"Configuring controller '{name}'")
        loaded = self.controllers.get(name)
        if loaded is None:
            self._logger.error(
                f"Could not configure controller with name '{name}' because no controller with this name exists"
            )
            return False
        controller = loaded.controller
        if controller.state in (ACTIVE, FINALIZED):
            self._logger.error(f"Controller '{name}' can not be configured from '{controller.state.label}' state.")
            return False
        if loaded.is_inactive and not self._clean_up(loaded):
            return False
        if not self._call_callback(loaded, "on_configure", controller.on_configure):
            label = controller.state.label
            self._logger.error(f"After configuring, controller '{name}' is in state '{label}' , expected inactive.")
            return False
        controller.state = INACTIVE
        self._set_update_period(loaded)
        references = [
            CommandInterface(name, reference_interface) for reference_interface in controller.reference_interfaces()
        ]
        exported = [StateInterface(name, exported_state) for exported_state in controller.exported_states()]
        controller.references, controller.exported = references, exported
        self.resources.add_exported_interfaces(name, references, exported)
        self._sort_controllers()
        self.on_change()
        return True

    def cleanup(self, name: str) -> bool:
        """Clean up an inactive controller, and return whether that succeeded."""
        loaded = self.controllers.get(name)
        if loaded is None or not loaded.is_inactive:
            reason = "it is not inactive" if loaded is not None else "no controller with this name exists"
            self._logger.error(f"Could not cleanup controller with name '{name}' because {reason}")
            return False
        is_clean = self._clean_up(loaded)
        self.on_change()
        return is_clean

    def _set_update_period(self, loaded: LoadedController) -> None:
        controller_rate, manager_rate = loaded.controller.update_rate, self.update_rate
        loaded.period_ns = (
            0
            if controller_rate >= manager_rate or controller_rate <= 0
            else round(NANOSECONDS_PER_SECOND / controller_rate)
        )
        if controller_rate > manager_rate:
            self._logger.warning(
                f"The controller : {loaded.name} update rate : {controller_rate:g} Hz should be less than "
                "or equal to controller "
                f"manager's update rate : {manager_rate:g} Hz!. The controller will be updated at "
                "controller_manager's update "
                "rate."
            )

    def _clean_up(self, loaded: LoadedController) -> bool:
        self.resources.remove_exported_interfaces(loaded.name)
        is_clean = self._call_callback(loaded, "on_cleanup", loaded.controller.on_cleanup)
        loaded.controller.node.clear()
        loaded.controller.references, loaded.controller.exported = [], []
        loaded.controller.state = UNCONFIGURED if is_clean else loaded.controller.state
        return is_clean

    def _sort_controllers(self) -> None:
        """Sort the controllers by their dependencies, into the order of updates.

        A controller precedes the controllers whose references it commands, and follows the controllers whose exported
        states it reads. If it does both, it precedes them, as a drive precedes the PID controllers that export wheel
        speeds.
        """
        order: dict[str, LoadedController] = {}
        names = self.resources.command_names

        def add(loaded: LoadedController, path: tuple[str, ...]) -> None:
            if loaded.name in order or loaded.name in path:
                return
            references = set(self.resources.reference_names(loaded.name))
            read_controllers: set[str] = set()
            if loaded.is_configured:
                read_controllers = _get_component_names(loaded.required_state_interfaces([])) - _get_component_names(
                    loaded.claimed_command_interfaces([])
                )
            for other in self.controllers.values():
                if other.name in read_controllers or (
                    references
                    and other.is_configured
                    and references.intersection(other.claimed_command_interfaces(names))
                ):
                    add(other, (*path, loaded.name))
            order[loaded.name] = loaded

        for loaded in self.controllers.values():
            add(loaded, ())
        self.controllers = order
        self._active = [controller for controller in order.values() if controller.is_active]

    # --- switching ----------------------------------------------------------------------------------------------------

    def switch(
        self, activate: Sequence[str], deactivate: Sequence[str], strictness: int = BEST_EFFORT
    ) -> tuple[bool, str]:
        """Deactivate some controllers and activate others.

        Returns:
            Whether that succeeded as far as the strictness requires, and a message for the user.
        """
        if strictness == 0:
            self._logger.warning(
                "Controller Manager: to switch controllers you need to specify a strictness level of "
                "controller_manager_msgs::SwitchController::STRICT (2) or ::BEST_EFFORT (1). Defaulting to "
                "::BEST_EFFORT"
            )
            strictness = BEST_EFFORT
        planner = SwitchPlanner(self.controllers, self.resources, self._logger, strictness)
        try:
            switch = planner.plan(activate, deactivate)
        except SwitchRefusedError as error:
            return False, str(error)
        if not switch.activate and not switch.deactivate:
            self._logger.info("Empty activate and deactivate list, not requesting switch")
            return True, "Empty activate and deactivate list, not requesting switch"
        start, stop = self._list_claimed_interfaces(switch.activate), self._list_claimed_interfaces(switch.deactivate)
        if start or stop:
            refusal = self.resources.prepare_switch(start, stop)
            if refusal:
                message = "Could not switch controllers since prepare command mode switch was rejected."
                self._logger.error(refusal)
                self._logger.error(message)
                return False, message
        failed = self._perform_switch(switch, start, stop)
        self.on_change()
        if failed:
            return False, "; ".join(failed)
        return True, "Successfully switched controllers!"

    def _list_claimed_interfaces(self, names: Sequence[str]) -> list[str]:
        all_names = self.resources.command_names
        return [
            command_name
            for name in names
            for command_name in self.controllers[name].claimed_command_interfaces(all_names)
        ]

    def _perform_switch(self, switch: Switch, start: list[str], stop: list[str]) -> list[str]:
        self.resources.perform_switch(start, stop)
        for name in switch.deactivate:
            self._deactivate(self.controllers[name])
        for name in switch.from_chained:
            self._set_chained(self.controllers[name], chained=False)
        for name in switch.to_chained:
            self._set_chained(self.controllers[name], chained=True)
        activation_order = [controller for controller in reversed(self.controllers) if controller in switch.activate]
        return [failure for name in activation_order if (failure := self._activate(self.controllers[name]))]

    def _set_chained(self, loaded: LoadedController, *, chained: bool) -> None:
        if self._call_callback(loaded, "on_set_chained_mode", lambda: loaded.controller.on_set_chained_mode(chained)):
            loaded.controller.is_chained = chained

    def _activate(self, loaded: LoadedController) -> str:
        """Activate a controller, and return an error message, or an empty string if that succeeded."""
        controller, resources, name = loaded.controller, self.resources, loaded.name
        claims = loaded.claimed_command_interfaces(
            [command_name for command_name in resources.command_names if resources.is_available(command_name)]
        )
        failure = next(
            (
                f"Resource conflict for controller '{name}'. Command interface '{claim}' is already claimed."
                for claim in claims
                if claim in resources.claims
            ),
            "",
        )
        if not failure:
            try:
                controller.commands = resources.commands(claims)
                controller.states = resources.states(controller.state_interfaces())
            except KeyError as error:
                failure = f"Can't activate controller '{name}': {error.args[0]}"
        if failure:
            self._logger.error(failure)
            controller.commands, controller.states = [], []
            return failure
        resources.claims.update(dict.fromkeys(claims, name))
        loaded.next_update_ns, loaded.last_commands = 0, [nan] * len(controller.commands)
        if not self._call_callback(loaded, "on_activate", controller.on_activate):
            label = controller.state.label
            failure = f"After activation, controller '{name}' is in state '{label}' (2), expected 'active' (3)."
            self._logger.error(failure)
            self._release(loaded)
            return failure
        controller.state = ACTIVE
        resources.set_available(name, available=True)
        self._active = [controller for controller in self.controllers.values() if controller.is_active]
        return ""

    def _deactivate(self, loaded: LoadedController, *, stop_joints: bool = False) -> None:
        controller = loaded.controller
        self._call_callback(loaded, "on_deactivate", controller.on_deactivate)
        loaded.replace_invalid_commands()
        if stop_joints:
            loaded.halt()
        controller.state = INACTIVE
        self._release(loaded)
        self.resources.set_available(loaded.name, available=False)
        self._active = [controller for controller in self._active if controller is not loaded]

    def _release(self, loaded: LoadedController) -> None:
        claims = self.resources.claims
        for name in [interface_name for interface_name, claimant in claims.items() if claimant == loaded.name]:
            del claims[name]
        loaded.controller.commands, loaded.controller.states = [], []

    def _call_callback(self, loaded: LoadedController, callback_name: str, callback: Callable[[], object]) -> bool:
        """Call a callback of a controller, and return whether it succeeded; errors are logged."""
        logger = loaded.controller.node.logger
        try:
            callback()
        except ControllerError as error:
            logger.error(error.diagnostics[0].message)  # noqa: TRY400 - the message is for users
            return False
        except Exception as error:  # noqa: BLE001 - an error of a controller must not stop other controllers
            logger.error(_add_traceback(f"Caught exception in callback for {callback_name}", error))  # noqa: TRY400 - `_add_traceback` contains the traceback
            self._on_error(loaded)
            return False
        return True

    def _on_error(self, loaded: LoadedController) -> None:
        try:
            loaded.controller.on_error()
        except Exception as error:  # noqa: BLE001 - an error of a controller must not stop other controllers
            logger = loaded.controller.node.logger
            logger.error(_add_traceback("Caught exception in callback for on_error", error))  # noqa: TRY400 - as above

    def set_hardware_state(self, name: str, target: LifecycleState) -> bool:
        """Bring hardware to a lifecycle state, and return whether the state was reached.

        If active hardware is deactivated, its controllers are deactivated first.
        """
        hardware = self.resources.components[name]
        if hardware.state is ACTIVE and target is not ACTIVE:
            self._stop(self._find_users([hardware]))
        is_reached = self.resources.set_state(name, target)
        self.on_change()
        return is_reached

    # --- updating -----------------------------------------------------------------------------------------------------

    def cycle(self, time_ns: int, period_s: float) -> None:
        """Read the hardware, update the controllers, and write to the hardware.

        Args:
            time_ns: the time, in nanoseconds.
            period_s: the time since the last cycle, in seconds.
        """
        failed = self.resources.read(time_ns, period_s)
        if failed:
            self._stop_users(failed)
        for loaded in self._active:
            if loaded.controller.state is not ACTIVE:
                continue  # The failure of an earlier controller deactivated it in this cycle.
            if loaded.period_ns:
                if time_ns < loaded.next_update_ns:
                    continue
                step_s = loaded.period_ns / NANOSECONDS_PER_SECOND
                loaded.next_update_ns = (
                    max(loaded.next_update_ns or time_ns, time_ns - loaded.period_ns) + loaded.period_ns
                )
            else:
                step_s = period_s
            try:
                if loaded.timing is None:
                    loaded.controller.step(time_ns, step_s)
                else:
                    loaded.timing.measure(loaded.controller.step, time_ns, step_s)
            except Exception as error:  # noqa: BLE001 - an error of a controller must not stop other controllers
                self._handle_failure(loaded, error)  # Safe in the loop: a new list replaces `_active`.
                continue
            replaced_name = loaded.replace_invalid_commands()
            if replaced_name:
                self._log_wrong_command(loaded, replaced_name)
        if self.limits is not None:
            self.limits.enforce(period_s, self.resources.claims)
        failed = self.resources.write(time_ns, period_s)
        if failed:
            self._stop_users(failed)

    def _log_wrong_command(self, loaded: LoadedController, name: str) -> None:
        loaded.controller.node.logger.error(
            f"The command '{name}' is not a number; the hardware gets the last position, or 0 for velocity and effort",
            throttle_duration_sec=1.0,
        )

    def _handle_failure(self, loaded: LoadedController, error: Exception) -> None:
        """Handle an exception in a controller's update.

        The controller and the controllers that command it are deactivated, their joints are stopped, and the fallbacks
        are activated.
        """
        message = _add_traceback("Caught exception while updating", error)
        if isinstance(error, ControllerError):
            message = error.diagnostics[0].message
        loaded.controller.node.logger.error(message)
        stopped_controllers = [loaded, *self._find_commanders(loaded)]
        names = " ".join(controller.name for controller in stopped_controllers)
        self._logger.error(f"Deactivating controllers : [ {names} ] as their update resulted in an error!")
        self._stop(stopped_controllers)
        self._on_error(loaded)
        if loaded.fallbacks:
            self._logger.error(f"Activating fallback controllers : [ {' '.join(loaded.fallbacks)} ]")
            self.switch(loaded.fallbacks, (), BEST_EFFORT)

    def _find_commanders(self, loaded: LoadedController) -> list[LoadedController]:
        """Return the active controllers that command a controller directly or indirectly."""
        references = self.resources.reference_names(loaded.name)
        claimants = dict.fromkeys(
            self.resources.claims[reference] for reference in references if reference in self.resources.claims
        )
        commanders = [self.controllers[claimant] for claimant in claimants]
        return [
            *commanders,
            *(indirect for controller in commanders for indirect in self._find_commanders(controller)),
        ]

    def _stop_users(self, failed: Sequence[Hardware]) -> None:
        users = self._find_users(failed)
        if users:
            self._logger.error(
                f"Deactivating controllers : [ {' '.join(controller.name for controller in users)} ] as their "
                f"hardware components failed: [ {' '.join(hardware.description.name for hardware in failed)} ]"
            )
            self._stop(users)
        self.on_change()

    def _find_users(self, hardware: Sequence[Hardware]) -> list[LoadedController]:
        """Return the active controllers that use hardware, and the controllers that command them."""
        names = {name for component in hardware for name in self.resources.list_interface_names(component)}
        users = [
            loaded
            for loaded in self._active
            if any(command.name in names for command in (*loaded.controller.commands, *loaded.controller.states))
        ]
        return [
            *users,
            *(
                controller
                for loaded in users
                for controller in self._find_commanders(loaded)
                if controller not in users
            ),
        ]

    def _stop(self, controllers: Sequence[LoadedController]) -> None:
        for controller in controllers:
            if controller.is_active:
                commanded_names = {command.component for command in controller.controller.commands}
                self._deactivate(controller, stop_joints=True)
                for name in commanded_names & self.controllers.keys():
                    self._set_chained(self.controllers[name], chained=False)
        self.on_change()

    def _log_error(self, error: LinkwrightError) -> None:
        for diagnostic in error.diagnostics:
            hint = f" ({diagnostic.hint})" if diagnostic.hint else ""
            self._logger.error(f"{diagnostic.message}{hint}")


def _get_component_names(interfaces: Iterable[str]) -> set[str]:
    """Return the joints or controllers at the beginning of interface names."""
    return {interface.partition("/")[0] for interface in interfaces}


def _add_traceback(message: str, error: Exception) -> str:
    """Return an error message with a traceback, for authors of controllers."""
    frames = traceback.format_exception(type(error), error, error.__traceback__)
    return f"{message}: {type(error).__name__}: {error}\n{''.join(frames).rstrip()}"
