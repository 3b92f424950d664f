"""The action that requests several transitions of lifecycle nodes in sequence."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any, ClassVar

from linkwright.diagnostics import phrase
from linkwright.launch.errors.places import error_at
from linkwright.launch.model.action import Action
from linkwright.launch.model.actions import EmitEvent, OpaqueFunction, RegisterEventHandler
from linkwright.launch.model.event_handlers import BaseEventHandler, EventHandler
from linkwright.launch.model.substitution import normalize_to_list_of_substitutions, perform_substitutions
from linkwright.launch.ros.lifecycle import unknown_transition_error
from linkwright.launch.ros.lifecycle_events import (
    ChangeState,
    OnStateTransition,
    StateTransition,
    matches_node_name,
)

if TYPE_CHECKING:
    from linkwright.launch.model.context import LaunchContext
    from linkwright.launch.model.events import Event

_GOALS = {
    1: ("configuring", "inactive"),
    2: ("cleaningup", "unconfigured"),
    3: ("activating", "active"),
    4: ("deactivating", "inactive"),
    5: ("shuttingdown", "finalized"),
    6: ("shuttingdown", "finalized"),
    7: ("shuttingdown", "finalized"),
}
"""The states during and after a transition, by its number."""


class LifecycleTransition(Action):
    """Requests transitions of lifecycle nodes, one after another.

    An error ends the sequence of the node.

    Args:
        lifecycle_node_names: the names of the nodes; a missing leading slash is added.
        transition_ids: the IDs of the transitions.
    """

    transition_targets: ClassVar[dict[int, dict[str, str]]] = {
        number: {"start_state": start, "goal_state": goal} for number, (start, goal) in _GOALS.items()
    }

    def __init__(self, *, lifecycle_node_names: Sequence[Any], transition_ids: Sequence[Any], **kwargs: Any) -> None:
        super().__init__(**kwargs)
        for what, given in (("transition_ids", transition_ids), ("lifecycle_node_names", lifecycle_node_names)):
            if len(given) == 0:
                text = f"No {what} provided."
                raise error_at(
                    self.place, "LAUNCH138", phrase("No {what} provided", what=what), ros_error=ValueError(text)
                )
        self._names = [normalize_to_list_of_substitutions(name) for name in lifecycle_node_names]
        self._ids = [
            normalize_to_list_of_substitutions(str(transition) if isinstance(transition, int) else transition)
            for transition in transition_ids
        ]
        self._handlers: dict[str, list[BaseEventHandler]] = {}

    def execute(self, context: LaunchContext) -> list[Action]:
        """Return actions that request the first transition of each node and handle the later ones.

        Raises:
            LinkwrightError: LAUNCH138, a transition ID is not a number, or its transition has no known goal state.
        """
        names = [perform_substitutions(context, name) for name in self._names]
        numbers = [self._number(perform_substitutions(context, text)) for text in self._ids]
        registering: list[Action] = []
        asking: list[Action] = []
        for name in names:
            wishes = [_wish(name, number) for number in numbers]
            asking.append(wishes[0])
            for number, following in zip(numbers, [*wishes[1:], self._ending(name)], strict=True):
                start, goal = _GOALS[number]
                handler = OnStateTransition(
                    matcher=_transition_matcher(name, start, goal), entities=[following], handle_once=True
                )
                self._handlers.setdefault(name, []).append(handler)
                registering.append(RegisterEventHandler(handler))
            failing = EventHandler(
                matcher=_transition_matcher(name, None, "errorprocessing"),
                entities=[self._ending(name, "error occured during transitions")],
                handle_once=True,
            )
            self._handlers[name].append(failing)
            context.register_event_handler(failing)
        return [*registering, *asking]

    def _number(self, text: str) -> int:
        try:
            number = int(text)
        except ValueError:
            raise unknown_transition_error(self.place, text) from None
        if number not in _GOALS:
            message = phrase("transition {number} does not end in a state to wait for", number=number)
            raise error_at(self.place, "LAUNCH138", message, ros_error=KeyError(number))
        return number

    def _ending(self, name: str, reason: str | None = None) -> OpaqueFunction:
        def end(context: LaunchContext) -> None:
            if reason is not None:
                text = f"Stopping transitions for {name} because '{reason}'"
                context.session.log.info_line("launch_ros.actions.lifecycle_transition", text)
            for handler in self._handlers.pop(name, ()):
                with suppress(ValueError):  # raised if the handler was unregistered after its event
                    context.unregister_event_handler(handler)

        return OpaqueFunction(function=end)


def _wish(name: str, number: int) -> EmitEvent:
    return EmitEvent(event=ChangeState(lifecycle_node_matcher=matches_node_name(name), transition_id=number))


def _transition_matcher(name: str, start: str | None, goal: str) -> Any:
    full_name = name if name.startswith("/") else f"/{name}"

    def matches(event: Event) -> bool:
        return (
            isinstance(event, StateTransition)
            and event.action.node_name == full_name
            and event.goal_state == goal
            and start in (None, event.start_state)
        )

    return matches
