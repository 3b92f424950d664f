"""The action that requests several transitions of lifecycle nodes in sequence."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any, ClassVar

from linkwright.diagnostics import phrase
from linkwright.launch.errors.locations import error_at
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

_STATES_BY_TRANSITION = {
    1: ("configuring", "inactive"),
    2: ("cleaningup", "unconfigured"),
    3: ("activating", "active"),
    4: ("deactivating", "inactive"),
    5: ("shuttingdown", "finalized"),
    6: ("shuttingdown", "finalized"),
    7: ("shuttingdown", "finalized"),
}
"""Maps the ID of a transition to the states during and after it."""


class LifecycleTransition(Action):
    """Requests transitions of lifecycle nodes, one after another.

    An error ends the sequence of transitions of the node.

    Args:
        lifecycle_node_names: the names of the nodes; a missing leading slash is added.
        transition_ids: the IDs of the transitions.
    """

    transition_targets: ClassVar[dict[int, dict[str, str]]] = {
        number: {"start_state": start, "goal_state": goal} for number, (start, goal) in _STATES_BY_TRANSITION.items()
    }

    def __init__(self, *, lifecycle_node_names: Sequence[Any], transition_ids: Sequence[Any], **kwargs: Any) -> None:
        super().__init__(**kwargs)
        for argument_name, values in (
            ("transition_ids", transition_ids),
            ("lifecycle_node_names", lifecycle_node_names),
        ):
            if len(values) == 0:
                text = f"No {argument_name} provided."
                raise error_at(
                    self.source_location,
                    "LAUNCH138",
                    phrase("'{name}' is empty", name=argument_name),
                    ros_error=ValueError(text),
                )
        self._names = [normalize_to_list_of_substitutions(name) for name in lifecycle_node_names]
        self._ids = [
            normalize_to_list_of_substitutions(str(transition) if isinstance(transition, int) else transition)
            for transition in transition_ids
        ]
        self._handlers: dict[str, list[BaseEventHandler]] = {}

    def execute(self, context: LaunchContext) -> list[Action]:
        """Return actions that request the transitions of each node in sequence.

        Raises:
            LinkwrightError: LAUNCH138, a transition ID is not a number, or the state after the transition is unknown.
        """
        names = [perform_substitutions(context, name) for name in self._names]
        transition_ids = [self._parse_transition_id(perform_substitutions(context, text)) for text in self._ids]
        register_actions: list[Action] = []
        request_actions: list[Action] = []
        for name in names:
            requests = [_create_request(name, number) for number in transition_ids]
            request_actions.append(requests[0])
            for transition_id, next_action in zip(
                transition_ids, [*requests[1:], self._create_end_action(name)], strict=True
            ):
                start, goal = _STATES_BY_TRANSITION[transition_id]
                handler = OnStateTransition(
                    matcher=_create_transition_matcher(name, start, goal), entities=[next_action], handle_once=True
                )
                self._handlers.setdefault(name, []).append(handler)
                register_actions.append(RegisterEventHandler(handler))
            error_handler = EventHandler(
                matcher=_create_transition_matcher(name, None, "errorprocessing"),
                entities=[self._create_end_action(name, "error occured during transitions")],
                handle_once=True,
            )
            self._handlers[name].append(error_handler)
            context.register_event_handler(error_handler)
        return [*register_actions, *request_actions]

    def _parse_transition_id(self, text: str) -> int:
        try:
            transition_id = int(text)
        except ValueError:
            raise unknown_transition_error(self.source_location, text) from None
        if transition_id not in _STATES_BY_TRANSITION:
            message = phrase("the goal state of transition {number} is unknown", number=transition_id)
            raise error_at(self.source_location, "LAUNCH138", message, ros_error=KeyError(transition_id))
        return transition_id

    def _create_end_action(self, name: str, reason: str | None = None) -> OpaqueFunction:
        def end_sequence(context: LaunchContext) -> None:
            if reason is not None:
                text = f"Stopping transitions for {name} because '{reason}'"
                context.session.log.write_info("launch_ros.actions.lifecycle_transition", text)
            for handler in self._handlers.pop(name, ()):
                with suppress(ValueError):  # raised if the handler was unregistered after its event
                    context.unregister_event_handler(handler)

        return OpaqueFunction(function=end_sequence)


def _create_request(name: str, transition_id: int) -> EmitEvent:
    return EmitEvent(event=ChangeState(lifecycle_node_matcher=matches_node_name(name), transition_id=transition_id))


def _create_transition_matcher(name: str, start_state: str | None, goal_state: str) -> Any:
    full_name = name if name.startswith("/") else f"/{name}"

    def matches(event: Event) -> bool:
        return (
            isinstance(event, StateTransition)
            and event.action.node_name == full_name
            and event.goal_state == goal_state
            and start_state in (None, event.start_state)
        )

    return matches
