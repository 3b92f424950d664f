"""Planning of a controller switch, which determines the controllers to activate and deactivate.

Source: the controller manager of ros2_control (rules of chains, strictness, messages).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from linkwright.control.hardware.resources import Resources
from linkwright.control.manager.loaded import Loaded
from linkwright.graph.log.logger import Logger

BEST_EFFORT, STRICT, AUTO, FORCE_AUTO = 1, 2, 3, 4
"""The strictness of a request, in controller_manager_msgs/srv/SwitchController."""

_MORE = (
    "Check above warnings for more details. Check the state of the controllers and their required interfaces using "
    "`ros2 control list_controllers -v` CLI to get more information."
)


class SwitchRefusedError(Exception):
    """Raised when a switch is refused; the message gives the reason."""


@dataclass(slots=True)
class Switch:
    """A planned switch of controllers.

    Attributes:
        activate, deactivate: the names of the controllers to activate and deactivate, in order.
        to_chained, from_chained: names of the controllers whose references other controllers start or stop commanding.
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
        self, controllers: Mapping[str, Loaded], resources: Resources, logger: Logger, strictness: int
    ) -> None:
        self._controllers = controllers
        self._resources = resources
        self._logger = logger
        self._strict = strictness == STRICT
        self._auto = strictness in (AUTO, FORCE_AUTO)
        self._force = strictness == FORCE_AUTO
        self._switch = Switch()

    def plan(self, activate: Sequence[str], deactivate: Sequence[str]) -> Switch:
        """Plan a switch, without impossible parts of the request unless the switch is strict.

        Raises:
            SwitchRefusedError: a part of the request is impossible, and the strictness requires a refusal.
        """
        switch = self._switch
        switch.deactivate = self._known(deactivate, "deactivate")
        switch.activate = self._known(activate, "activate")
        if self._auto:
            self._add_following()
        if self._force:
            self._add_conflicting()
        for name in switch.deactivate:
            if self._controllers[name].is_active:
                switch.from_chained += [
                    each for each in self._following(self._controllers[name]) if each not in switch.from_chained
                ]
        switch.activate = [item for item in switch.activate if self._may(item, self._objection_to_activation(item))]
        switch.deactivate = [
            item for item in switch.deactivate if self._may(item, self._objection_to_deactivation(item), "deactivate")
        ]
        for name in (*switch.to_chained, *switch.from_chained):
            if self._controllers[name].is_active and name not in switch.deactivate:
                switch.deactivate.append(name)
                switch.activate.append(name)
        self._check_twice()
        return switch

    def _known(self, names: Sequence[str], action: str) -> list[str]:
        found = []
        for name in dict.fromkeys(names):
            if name in self._controllers:
                found.append(name)
                continue
            message = f"Could not '{action}' controller with name '{name}' because no controller with this name exists"
            self._logger.warning(message)
            if self._strict:
                self._logger.error("Aborting, no controller is switched! ('STRICT' switch)")
                raise SwitchRefusedError(message)
        return found

    def _may(self, name: str, objection: str, action: str = "activate") -> bool:
        if not objection:
            return True
        self._logger.warning(objection)
        self._logger.warning(f"Could not {action} controller with name '{name}'. {_MORE}")
        if self._strict:
            self._logger.error("Aborting, no controller is switched! (::STRICT switch)")
            raise SwitchRefusedError(objection)
        return False

    def _following(self, loaded: Loaded) -> Iterator[str]:
        """Iterate over the names of the controllers whose references a controller commands."""
        for interface in loaded.wanted_commands([]):
            name = interface.partition("/")[0]
            if name in self._controllers and name != loaded.name:
                yield name

    def _preceding(self, loaded: Loaded) -> Iterator[Loaded]:
        """Iterate over the controllers that command the references of a controller."""
        references = set(self._resources.references_of(loaded.name))
        for other in self._controllers.values():
            if references.intersection(other.wanted_commands([])):
                yield other

    def _add_following(self) -> None:
        switch = self._switch
        waiting = list(switch.activate)
        while waiting:
            for name in self._following(self._controllers[waiting.pop()]):
                if self._controllers[name].is_inactive and name not in switch.activate:
                    switch.activate.insert(0, name)
                    waiting.append(name)

    def _add_conflicting(self) -> None:
        for name in self._switch.activate:
            for interface in self._controllers[name].wanted_commands(self._resources.command_names):
                owner = self._resources.claims.get(interface)
                if owner is not None and owner not in self._switch.deactivate:
                    self._switch.deactivate.append(owner)

    def _objection_to_activation(self, name: str) -> str:
        loaded = self._controllers[name]
        if loaded.is_active and name in self._switch.deactivate:
            return ""
        if not loaded.is_inactive:
            return (
                f"Controller with name '{name}' is not inactive so its following controllers do not have to be "
                "checked, because it cannot be activated."
            )
        return self._objection_to_following(loaded)

    def _objection_to_following(self, loaded: Loaded) -> str:
        switch = self._switch
        for interface in loaded.wanted_commands([]):
            following = self._controllers.get(interface.partition("/")[0])
            if following is None or following is loaded:
                continue
            name = following.name
            if following.controller.state.label != "unconfigured" and not following.is_chainable:
                return (
                    f"No reference interface '{interface}' exist, since the following controller with name '{name}' "
                    "is not chainable."
                )
            if following.is_active and name in switch.deactivate and name not in switch.activate:
                return f"The following controller with name '{name}' will be deactivated."
            if not following.is_active and name not in switch.activate:
                return f"The following controller with name '{name}' is not active and will not be activated."
            objection = self._objection_to_following(following)
            if objection:
                return objection
            if name in switch.from_chained:
                switch.from_chained.remove(name)
            elif not following.controller.chained and name not in switch.to_chained:
                switch.to_chained.append(name)
        return ""

    def _objection_to_deactivation(self, name: str) -> str:
        loaded = self._controllers[name]
        if not loaded.is_active:
            return f"Controller with name '{name}' can not be deactivated since it is not active."
        if not loaded.controller.chained:
            return ""
        for other in self._preceding(loaded):
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

    def _check_twice(self) -> None:
        switch = self._switch
        for name in tuple(switch.activate):
            loaded = self._controllers[name]
            if loaded.is_active and name not in switch.deactivate:
                message = f"Could not activate controller '{name}' since it is already active"
            elif not loaded.is_inactive and name not in switch.deactivate:
                message = f"Could not activate controller '{name}' since it is not in inactive state"
            else:
                continue
            if self._strict:
                self._logger.error(message)
                raise SwitchRefusedError(message)
            self._logger.warning(message)
            switch.activate.remove(name)
