"""The state machine of managed nodes, with the IDs and labels of lifecycle_msgs.

The design follows "Managed nodes" (design.ros2.org), and the tables are those of rcl_lifecycle.
"""

from __future__ import annotations

from enum import IntEnum
from typing import Any, NamedTuple


class TransitionCallbackReturn(IntEnum):
    """The results of transition callbacks, with the numbers of lifecycle_msgs/msg/Transition."""

    SUCCESS = 97
    FAILURE = 98
    ERROR = 99

    def to_label(self) -> str:
        """Return the label of the transition that this result triggers."""
        return f"transition_{self.name.lower()}"


class LifecycleState(NamedTuple):
    """A lifecycle state, as callbacks receive it."""

    label: str
    state_id: int


UNKNOWN = LifecycleState("unknown", 0)
UNCONFIGURED = LifecycleState("unconfigured", 1)
INACTIVE = LifecycleState("inactive", 2)
ACTIVE = LifecycleState("active", 3)
FINALIZED = LifecycleState("finalized", 4)
CONFIGURING = LifecycleState("configuring", 10)
CLEANINGUP = LifecycleState("cleaningup", 11)
SHUTTINGDOWN = LifecycleState("shuttingdown", 12)
ACTIVATING = LifecycleState("activating", 13)
DEACTIVATING = LifecycleState("deactivating", 14)
ERRORPROCESSING = LifecycleState("errorprocessing", 15)

STATES = (
    UNKNOWN,
    UNCONFIGURED,
    INACTIVE,
    ACTIVE,
    FINALIZED,
    CONFIGURING,
    CLEANINGUP,
    SHUTTINGDOWN,
    ACTIVATING,
    DEACTIVATING,
    ERRORPROCESSING,
)


class Transition(NamedTuple):
    """A transition from one state to another.

    Attributes:
        transition_id: the transition's ID.
        label: the label that triggers the transition. For a transition that ends another transition, the label depends
            on the result, such as ``transition_success``.
        start: the state in which the transition starts.
        goal: the state in which the transition ends.
    """

    transition_id: int
    label: str
    start: LifecycleState
    goal: LifecycleState


def _make_endings(
    number: int,
    transition_state: LifecycleState,
    success: LifecycleState,
    failure: LifecycleState,
    error: LifecycleState,
) -> list[Transition]:
    """Return the transitions for success, failure and error from a transition state."""
    end_states = (("success", success), ("failure", failure), ("error", error))
    return [
        Transition(number + index, f"transition_{name}", transition_state, end)
        for index, (name, end) in enumerate(end_states)
    ]


def _make_requestable_transition(
    number: int, label: str, start: LifecycleState, transition_state: LifecycleState, goal: LifecycleState
) -> list[Transition]:
    """Return a transition that users can request, and its endings.

    The IDs of the endings start at ten times the transition's ID.
    """
    return [
        Transition(number, label, start, transition_state),
        *_make_endings(number * 10, transition_state, goal, start, ERRORPROCESSING),
    ]


TRANSITIONS = (
    *_make_requestable_transition(1, "configure", UNCONFIGURED, CONFIGURING, INACTIVE),
    *_make_requestable_transition(2, "cleanup", INACTIVE, CLEANINGUP, UNCONFIGURED),
    *_make_requestable_transition(3, "activate", INACTIVE, ACTIVATING, ACTIVE),
    *_make_requestable_transition(4, "deactivate", ACTIVE, DEACTIVATING, INACTIVE),
    Transition(5, "shutdown", UNCONFIGURED, SHUTTINGDOWN),
    Transition(6, "shutdown", INACTIVE, SHUTTINGDOWN),
    Transition(7, "shutdown", ACTIVE, SHUTTINGDOWN),
    *_make_endings(50, SHUTTINGDOWN, FINALIZED, FINALIZED, ERRORPROCESSING),
    *_make_endings(60, ERRORPROCESSING, UNCONFIGURED, FINALIZED, FINALIZED),
)


class StateMachine:
    """The current state of a managed node, and the services that control the node.

    The services are None if the node does not offer them.
    """

    service_change_state: Any = None
    service_get_state: Any = None
    service_get_available_states: Any = None
    service_get_available_transitions: Any = None
    service_get_transition_graph: Any = None

    def __init__(self) -> None:
        self.state = UNCONFIGURED

    @property
    def current_state(self) -> tuple[int, str]:
        """The ID and label of the current state (rclpy)."""
        return self.state.state_id, self.state.label

    def available_transitions(self) -> list[Transition]:
        """Return the transitions that start from the current state."""
        return [transition for transition in TRANSITIONS if transition.start == self.state]

    def find_by_id(self, transition_id: int) -> Transition | None:
        """Return the available transition with an ID, or None if there is none."""
        return next(
            (transition for transition in self.available_transitions() if transition.transition_id == transition_id),
            None,
        )

    def find_by_label(self, label: str) -> Transition | None:
        """Return the available transition with a label, or None if there is none."""
        return next((transition for transition in self.available_transitions() if transition.label == label), None)
