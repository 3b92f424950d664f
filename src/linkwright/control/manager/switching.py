"""Plan a controller switch: which controllers to activate and deactivate.

Source: the controller manager of ros2_control (rules of chains, strictness, messages).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from linkwright.control.hardware.resources import Resources
from linkwright.control.manager.loaded import LoadedController
from linkwright.graph.log.logger import Logger

BEST_EFFORT, STRICT, AUTO, FORCE_AUTO = 1, 2, 3, 4
"""The values of the strictness in controller_manager_msgs/srv/SwitchController."""

_ADVICE = (
    "Check above warnings for more details. Check the state of the controllers and their required interfaces using "
    "`ros2 control list_controllers -v` CLI to get more information."
)


class SwitchRefusedError(Exception):
    """Raised when a switch is refused.

    The message gives the reason.
    """


@dataclass(slots=True)
class Switch:
    """A planned switch of controllers.

    Attributes:
        activate, deactivate: the names of the controllers to activate and deactivate, in order.
        to_chained: the names of the controllers that other controllers start commanding.
        from_chained: the names of the controllers that other controllers stop commanding.
    """

    activate: list[str] = field(default_factory=list)
    deactivate: list[str] = field(default_factory=list)
    to_chained: list[str] = field(default_factory=list)
    from_chained: list[str] = field(default_factory=list)


class SwitchPlanner:
    """A planner of one controller switch.

    Args:
        controllers: the loaded controllers, by name.
        resources: the hardware.
        logger: the manager's logger.
        strictness: `BEST_EFFORT`, `STRICT`, `AUTO` or `FORCE_AUTO`.
    """

    def __init__(
        self, controllers: Mapping[str, LoadedController], resources: Resources, logger: Logger, strictness: int
    ) -> None:
        self._controllers = controllers
        self._resources = resources
        self._logger = logger
        self._is_strict = strictness == STRICT
        self._adds_following = strictness in (AUTO, FORCE_AUTO)
        self._force = strictness == FORCE_AUTO
        self._switch = Switch()

    def plan(self, activate: Sequence[str], deactivate: Sequence[str]) -> Switch:
        """Plan a switch.

        Impossible parts of the request are left out unless the switch is strict.

        Raises:
            SwitchRefusedError: a part of the request is impossible, and the switch is strict.
        """
        switch = self._switch
        switch.deactivate = self._filter_existing_names(deactivate, "deactivate")
        switch.activate = self._filter_existing_names(activate, "activate")
        if self._adds_following:
            self._add_following()
        if self._force:
            self._add_conflicting()
        for name in switch.deactivate:
            if self._controllers[name].is_active:
                switch.from_chained += [
                    following_name
                    for following_name in self._find_following_names(self._controllers[name])
                    if following_name not in switch.from_chained
                ]
        switch.activate = [
            item for item in switch.activate if self._is_permitted(item, self._find_activation_obstacle(item))
        ]
        switch.deactivate = [
            item
            for item in switch.deactivate
            if self._is_permitted(item, self._find_deactivation_obstacle(item), "deactivate")
        ]
        for name in (*switch.to_chained, *switch.from_chained):
            if self._controllers[name].is_active and name not in switch.deactivate:
                switch.deactivate.append(name)
                switch.activate.append(name)
        self._check_current_states()
        return switch

    def _filter_existing_names(self, names: Sequence[str], action: str) -> list[str]:
        existing_names = []
        for name in dict.fromkeys(names):
            if name in self._controllers:
                existing_names.append(name)
                continue
            message = f"Could not '{action}' controller with name '{name}' because no controller with this name exists"
            self._logger.warning(message)
            if self._is_strict:
                self._logger.error("Aborting, no controller is switched! ('STRICT' switch)")
                raise SwitchRefusedError(message)
        return existing_names

    def _is_permitted(self, name: str, obstacle: str, action: str = "activate") -> bool:
        if not obstacle:
            return True
        self._logger.warning(obstacle)
        self._logger.warning(f"Could not {action} controller with name '{name}'. {_ADVICE}")
        if self._is_strict:
            self._logger.error("Aborting, no controller is switched! (::STRICT switch)")
            raise SwitchRefusedError(obstacle)
        return False

    def _find_following_names(self, loaded: LoadedController) -> Iterator[str]:
        """Yield the names of the controllers whose references a controller commands."""
        for interface in loaded.claimed_command_interfaces([]):
            name = interface.partition("/")[0]
            if name in self._controllers and name != loaded.name:
                yield name

    def _find_preceding_controllers(self, loaded: LoadedController) -> Iterator[LoadedController]:
        """Yield the controllers that command the references of a controller."""
        references = set(self._resources.reference_names(loaded.name))
        for other in self._controllers.values():
            if references.intersection(other.claimed_command_interfaces([])):
                yield other

    def _add_following(self) -> None:
        switch = self._switch
        pending = list(switch.activate)
        while pending:
            for name in self._find_following_names(self._controllers[pending.pop()]):
                if self._controllers[name].is_inactive and name not in switch.activate:
                    switch.activate.insert(0, name)
                    pending.append(name)

    def _add_conflicting(self) -> None:
        for name in self._switch.activate:
            for interface in self._controllers[name].claimed_command_interfaces(self._resources.command_names):
                claimant = self._resources.claims.get(interface)
                if claimant is not None and claimant not in self._switch.deactivate:
                    self._switch.deactivate.append(claimant)

    def _find_activation_obstacle(self, name: str) -> str:
        loaded = self._controllers[name]
        if loaded.is_active and name in self._switch.deactivate:
            return ""
        if not loaded.is_inactive:
            return (
                f"Controller with name '{name}' is not inactive so its following controllers do not have to be "
                "checked, because it cannot be activated."
            )
        return self._chain_following_controllers(loaded)

    def _chain_following_controllers(self, loaded: LoadedController) -> str:
        """Plan chained mode for the controllers that a controller commands.

        Returns an error message, or an empty string if that is possible.
        """
        switch = self._switch
        for interface in loaded.claimed_command_interfaces([]):
            commanded = self._controllers.get(interface.partition("/")[0])
            if commanded is None or commanded is loaded:
                continue
            name = commanded.name
            if commanded.controller.state.label != "unconfigured" and not commanded.is_chainable:
                return (
                    f"No reference interface '{interface}' exist, since the following controller with name '{name}' "
                    "is not chainable."
                )
            if commanded.is_active and name in switch.deactivate and name not in switch.activate:
                return f"The following controller with name '{name}' will be deactivated."
            if not commanded.is_active and name not in switch.activate:
                return f"The following controller with name '{name}' is not active and will not be activated."
            obstacle = self._chain_following_controllers(commanded)
            if obstacle:
                return obstacle
            if name in switch.from_chained:
                switch.from_chained.remove(name)
            elif not commanded.controller.is_chained and name not in switch.to_chained:
                switch.to_chained.append(name)
        return ""

    def _find_deactivation_obstacle(self, name: str) -> str:
        loaded = self._controllers[name]
        if not loaded.is_active:
            return f"Controller with name '{name}' can not be deactivated since it is not active."
        if not loaded.controller.is_chained:
            return ""
        for other in self._find_preceding_controllers(loaded):
            if other.is_inactive and other.name in self._switch.activate:
                return (
                    f"Could not deactivate controller with name '{name}' because preceding controller with name "
                    f"'{other.name}' will be activated. "
                )
            if other.is_active and other.name not in self._switch.deactivate:
                return (
                    f"Could not deactivate controller with name '{name}' because preceding controller with name "
                    f"'{other.name}' is active and will not be deactivated."
                )
        return ""

    def _check_current_states(self) -> None:
        switch = self._switch
        for name in tuple(switch.activate):
            loaded = self._controllers[name]
            if loaded.is_active and name not in switch.deactivate:
                message = f"Could not activate controller '{name}' since it is already active"
            elif not loaded.is_inactive and name not in switch.deactivate:
                message = f"Could not activate controller '{name}' since it is not in inactive state"
            else:
                continue
            if self._is_strict:
                self._logger.error(message)
                raise SwitchRefusedError(message)
            self._logger.warning(message)
            switch.activate.remove(name)
