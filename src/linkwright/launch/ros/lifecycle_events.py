"""Events of lifecycle nodes, and a handler for them (``launch_ros.events.lifecycle``)."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from typing import Any

from linkwright.diagnostics import phrase
from linkwright.launch.errors.locations import SourceLocation, error_at
from linkwright.launch.model.event_handlers import EventHandler
from linkwright.launch.model.events import Event

TRANSITIONS = OrderedDict(
    (
        (0, "TRANSITION_CREATE"),
        (1, "TRANSITION_CONFIGURE"),
        (2, "TRANSITION_CLEANUP"),
        (3, "TRANSITION_ACTIVATE"),
        (4, "TRANSITION_DEACTIVATE"),
        (5, "TRANSITION_UNCONFIGURED_SHUTDOWN"),
        (6, "TRANSITION_INACTIVE_SHUTDOWN"),
        (7, "TRANSITION_ACTIVE_SHUTDOWN"),
        (8, "TRANSITION_DESTROY"),
    )
)
"""Maps the IDs of transitions in ``lifecycle_msgs/msg/Transition`` to their names."""

STATES = OrderedDict(
    (
        (0, "PRIMARY_STATE_UNKNOWN"),
        (1, "PRIMARY_STATE_UNCONFIGURED"),
        (2, "PRIMARY_STATE_INACTIVE"),
        (3, "PRIMARY_STATE_ACTIVE"),
        (4, "PRIMARY_STATE_FINALIZED"),
        (10, "TRANSITION_STATE_CONFIGURING"),
        (11, "TRANSITION_STATE_CLEANINGUP"),
        (12, "TRANSITION_STATE_SHUTTINGDOWN"),
        (13, "TRANSITION_STATE_ACTIVATING"),
        (14, "TRANSITION_STATE_DEACTIVATING"),
        (15, "TRANSITION_STATE_ERRORPROCESSING"),
    )
)
"""Maps the IDs of states in ``lifecycle_msgs/msg/State`` to their names."""

NodeMatcher = Callable[[Any], bool]


class ChangeState(Event):
    """A request for a transition of the lifecycle nodes that a matcher accepts.

    Args:
        lifecycle_node_matcher: called with the action of each lifecycle node; returns whether the request is for that
            node.
        transition_id: the ID of the transition, see `TRANSITIONS`.
    """

    name = "launch_ros.events.lifecycle.ChangeState"
    valid_transitions = TRANSITIONS
    valid_states = STATES

    def __init__(self, *, lifecycle_node_matcher: NodeMatcher, transition_id: int) -> None:
        super().__init__()
        if transition_id not in TRANSITIONS:
            transitions_text = ", ".join(f"{name}: {number}" for number, name in TRANSITIONS.items())
            ros_error = ValueError(f"given transition_id of '{transition_id}', expected one of {{{transitions_text}}}")
            message = phrase(
                "there is no lifecycle transition with the ID {transition_id}", transition_id=repr(transition_id)
            )
            raise error_at(
                SourceLocation.of_caller(),
                "LAUNCH138",
                message,
                phrase("the available transitions are {transitions}", transitions=transitions_text),
                ros_error=ros_error,
            )
        self.lifecycle_node_matcher = lifecycle_node_matcher
        self.transition_id = transition_id


class StateTransition(Event):
    """The event that a lifecycle node has made a transition.

    Args:
        action: the action of the node.
        msg: the ``lifecycle_msgs/msg/TransitionEvent`` that the node published.
    """

    name = "launch_ros.events.lifecycle.StateTransition"

    def __init__(self, *, action: Any, msg: Any) -> None:
        super().__init__()
        self.action = action
        self.msg = msg

    @property
    def timestamp(self) -> int:
        """The time of the transition in nanoseconds on the node's clock."""
        return int(self.msg.timestamp)

    @property
    def transition(self) -> str:
        """The name of the transition, such as ``configure``."""
        return str(self.msg.transition.label)

    @property
    def start_state(self) -> str:
        """The name of the state before the transition, such as ``unconfigured``."""
        return str(self.msg.start_state.label)

    @property
    def goal_state(self) -> str:
        """The name of the state after the transition, such as ``inactive``."""
        return str(self.msg.goal_state.label)


class OnStateTransition(EventHandler):
    """An event handler that visits entities when a lifecycle node has made a transition.

    An argument that is omitted matches any value.

    Args:
        entities: the entities to visit.
        target_lifecycle_node: the action of the node.
        transition: the name of the transition.
        start_state: the name of the state before the transition.
        goal_state: the name of the state after the transition.
        matcher: called with the event; replaces the comparison with the target, transition and states.
    """

    def __init__(
        self,
        *,
        entities: Any,
        target_lifecycle_node: Any = None,
        transition: str | None = None,
        start_state: str | None = None,
        goal_state: str | None = None,
        matcher: Callable[[Event], bool] | None = None,
        **kwargs: Any,
    ) -> None:
        if target_lifecycle_node is not None and not getattr(target_lifecycle_node, "is_lifecycle_node", False):
            text = "OnStateTransition requires a 'LifecycleNode' action as the target"
            message = phrase(
                "OnStateTransition requires a 'LifecycleNode' action as the target, not a {type}",
                type=type(target_lifecycle_node).__name__,
            )
            raise error_at(SourceLocation.of_caller(), "LAUNCH138", message, ros_error=RuntimeError(text))
        self._target = target_lifecycle_node
        expected_values = {"transition": transition, "start_state": start_state, "goal_state": goal_state}

        def matches(event: Event) -> bool:
            if not isinstance(event, StateTransition):
                return False
            if target_lifecycle_node is not None and event.action is not target_lifecycle_node:
                return False
            return all(value is None or getattr(event, name) == value for name, value in expected_values.items())

        super().__init__(matcher=matcher or matches, entities=entities, **kwargs)

    @property
    def handler_description(self) -> str:
        """A text that describes the reaction."""
        return "<actions>"

    @property
    def matcher_description(self) -> str:
        """A text that describes the accepted events."""
        if self._target is None:
            return "event == StateTransition"
        return f"event == StateTransition and event.action == LifecycleNode({hex(id(self._target))})"


def matches_node_name(node_name: str) -> NodeMatcher:
    """Return a matcher that accepts the action of the node with the given full name.

    If the name has no leading slash, one is added.
    """
    full_name = node_name if node_name.startswith("/") else f"/{node_name}"
    return lambda action: action.node_name == full_name
