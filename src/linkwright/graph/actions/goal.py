"""Goal states, responses, and the server's handle to a goal (``rclpy.action.server``)."""

from __future__ import annotations

import threading
from collections.abc import Callable
from enum import Enum, IntEnum
from types import GenericAlias
from typing import Any, Protocol

from linkwright.graph.loop.future import Future


class GoalStatus(IntEnum):
    """The states of a goal, with the numbers of action_msgs/msg/GoalStatus."""

    UNKNOWN = 0
    ACCEPTED = 1
    EXECUTING = 2
    CANCELING = 3
    SUCCEEDED = 4
    CANCELED = 5
    ABORTED = 6


class GoalEvent(Enum):
    """The events that change the state of a goal, with the numbers of rcl_action."""

    EXECUTE = 1
    CANCEL_GOAL = 2
    SUCCEED = 3
    ABORT = 4
    CANCELED = 5


class GoalResponse(Enum):
    """A server's answer to a goal request: accept or reject."""

    REJECT = 1
    ACCEPT = 2


class CancelResponse(Enum):
    """A server's answer to a cancel request: accept or reject."""

    REJECT = 1
    ACCEPT = 2


ACTIVE_STATES = frozenset({GoalStatus.ACCEPTED, GoalStatus.EXECUTING, GoalStatus.CANCELING})
"""The states of a goal that has not ended."""

CANCELABLE_STATES = frozenset({GoalStatus.ACCEPTED, GoalStatus.EXECUTING})
"""The states in which a goal can be canceled."""

_TRANSITIONS = {
    (GoalStatus.ACCEPTED, GoalEvent.EXECUTE): GoalStatus.EXECUTING,
    (GoalStatus.ACCEPTED, GoalEvent.CANCEL_GOAL): GoalStatus.CANCELING,
    (GoalStatus.EXECUTING, GoalEvent.CANCEL_GOAL): GoalStatus.CANCELING,
    (GoalStatus.EXECUTING, GoalEvent.SUCCEED): GoalStatus.SUCCEEDED,
    (GoalStatus.EXECUTING, GoalEvent.ABORT): GoalStatus.ABORTED,
    (GoalStatus.CANCELING, GoalEvent.SUCCEED): GoalStatus.SUCCEEDED,
    (GoalStatus.CANCELING, GoalEvent.ABORT): GoalStatus.ABORTED,
    (GoalStatus.CANCELING, GoalEvent.CANCELED): GoalStatus.CANCELED,
}


class GoalOwner(Protocol):
    """The interface through which goal handles call their action server."""

    @property
    def action_type(self) -> Any:
        """The class of the action."""

    def start_execution(self, goal: ServerGoalHandle, callback: Callable[[ServerGoalHandle], Any] | None) -> None:
        """Schedule the execution of a goal."""

    def publish_feedback(self, goal_id: Any, feedback: Any) -> None:
        """Publish the feedback of a goal."""

    def on_goal_state_change(self, goal: ServerGoalHandle) -> None:
        """Publish the states of all goals after the state of one has changed."""

    def remove_goal(self, goal: ServerGoalHandle) -> None:
        """Remove a goal from the server."""


class ServerGoalHandle:
    """The server's handle to an accepted goal.

    The methods may be called from any thread.

    Attributes:
        request: the goal message.
        goal_info: the goal's ID and the time at which it was accepted (action_msgs/msg/GoalInfo).
        ended_ns: when the goal ended, in nanoseconds of the server's clock; None while it has not ended.
    """

    __class_getitem__: Any = classmethod(GenericAlias)  # As in rclpy, annotations may name the action type.

    def __init__(self, action_server: GoalOwner, goal_info: Any, goal_request: Any) -> None:
        self._server = action_server
        self._status = GoalStatus.ACCEPTED
        self._destroyed = False
        self._lock = threading.RLock()
        self.request = goal_request
        self.goal_info = goal_info
        self.ended_ns: int | None = None
        self.result: Future[Any] = Future()
        """The future response to the clients that request the result."""

    def __eq__(self, other: object) -> bool:
        return bytes(self.goal_id.uuid) == bytes(other.goal_id.uuid) if isinstance(other, ServerGoalHandle) else False

    def __hash__(self) -> int:
        return hash(bytes(self.goal_id.uuid))

    @property
    def goal_id(self) -> Any:
        """The goal's ID (unique_identifier_msgs/msg/UUID)."""
        return self.goal_info.goal_id

    @property
    def status(self) -> int:
        """The goal's state, or UNKNOWN once the handle has been destroyed."""
        return int(GoalStatus.UNKNOWN if self._destroyed else self._status)

    @property
    def is_active(self) -> bool:
        """Whether the goal has not ended."""
        return not self._destroyed and self._status in ACTIVE_STATES

    @property
    def is_cancel_requested(self) -> bool:
        """Whether the goal is in the state CANCELING."""
        return not self._destroyed and self._status is GoalStatus.CANCELING

    def execute(self, execute_callback: Callable[[ServerGoalHandle], Any] | None = None) -> None:
        """Mark the goal as executing, and schedule its execution.

        The given callback executes the goal, or by default the server's execute callback. A goal that was canceled
        before it starts stays in the state CANCELING.

        The callback receives such a goal, too, and decides how the goal ends.
        """
        with self._lock:
            if not self.is_cancel_requested:
                self.update(GoalEvent.EXECUTE)
        self._server.start_execution(self, execute_callback)

    def publish_feedback(self, feedback: Any) -> None:
        """Publish a feedback message for the goal.

        Raises:
            TypeError: `feedback` is not a feedback message of the action.
        """
        action_type = self._server.action_type
        if not isinstance(feedback, action_type.Feedback):
            raise TypeError(f"Expected {action_type.Feedback}, got {type(feedback)}")
        if not self._destroyed:
            self._server.publish_feedback(self.goal_id, feedback)

    def succeed(self, response: Any = None) -> None:
        """Mark the goal as succeeded.

        Args:
            response: the goal's result; None if the execute callback returns the result.

        Raises:
            RuntimeError: the goal cannot succeed in its current state.
        """
        self._end(GoalEvent.SUCCEED, response)

    def abort(self, response: Any = None) -> None:
        """Mark the goal as aborted. See `succeed`."""
        self._end(GoalEvent.ABORT, response)

    def canceled(self, response: Any = None) -> None:
        """Mark the goal as canceled, after a cancel request. See `succeed`."""
        self._end(GoalEvent.CANCELED, response)

    def update(self, event: GoalEvent) -> None:
        """Apply an event to the goal's state, and publish the new state.

        Does nothing once the handle is destroyed.

        Raises:
            RuntimeError: the event cannot happen in the goal's state.
        """
        with self._lock:
            if self._destroyed:
                return
            new_status = _TRANSITIONS.get((self._status, event))
            if new_status is None:
                raise RuntimeError(
                    "Failed to update goal state: goal_handle attempted invalid transition from state "
                    f"{self._status.name} with event {event.name}"
                )
            self._status = new_status
        self._server.on_goal_state_change(self)

    def destroy(self) -> None:
        """Deactivate the handle, and remove the goal from its server."""
        self._destroyed = True
        self._server.remove_goal(self)

    def retire(self) -> None:
        """Deactivate the handle after the server itself has removed the goal."""
        self._destroyed = True

    def set_result(self, result: Any) -> None:
        """Send the result to the clients that requested it, unless a result was set before."""
        if not self.result.ended():
            response = self._server.action_type.Impl.GetResultService.Response()
            response.status = int(self._status)
            response.result = result
            self.result.set_result(response)

    def _end(self, event: GoalEvent, response: Any) -> None:
        self.update(event)
        if response is not None:
            self.set_result(response)
