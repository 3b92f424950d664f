"""Action servers of controllers.

Goals arrive on the event loop, and are executed in the update thread.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from linkwright.control.controllers.node import ControllerNode
from linkwright.graph.actions.goal import CancelResponse, GoalEvent, GoalResponse, ServerGoalHandle
from linkwright.graph.actions.server import ActionServer


class _Server(ActionServer):
    """An action server that reports a cancel request after the base class has handled it.

    The order matters because a goal may end as soon as the request is reported.
    """

    on_cancel_requested: Callable[[ServerGoalHandle], object]

    def on_goal_state_change(self, goal: ServerGoalHandle) -> None:
        super().on_goal_state_change(goal)
        if goal.is_cancel_requested:
            self.on_cancel_requested(goal)


class Goal:
    """An accepted goal, for use in the update thread.

    The goal ends with the first call of `succeed`, `abort` or `cancel`; later calls have no effect.

    Attributes:
        request: the goal message.
        has_ended: whether the goal has ended.
    """

    def __init__(self, handle: ServerGoalHandle, node: ControllerNode) -> None:
        self.request = handle.request
        self.has_ended = False
        self._handle = handle
        self._node = node

    def belongs_to(self, handle: ServerGoalHandle) -> bool:
        """Return whether the goal has this handle."""
        return self._handle is handle

    def publish_feedback(self, message: Any) -> None:
        """Publish a feedback message for the goal."""
        self._node.call_on_loop(partial(self._handle.publish_feedback, message))

    def succeed(self, result: Any) -> None:
        """End the goal with the status succeeded."""
        self._end(self._handle.succeed, result)

    def abort(self, result: Any) -> None:
        """End the goal with the status aborted."""
        self._end(self._handle.abort, result)

    def cancel(self, result: Any) -> None:
        """End the goal with the status canceled, even if its client did not request that."""
        self._end(self._cancel_goal, result)

    def _cancel_goal(self, result: Any) -> None:
        if not self._handle.is_cancel_requested:
            self._handle.update(GoalEvent.CANCEL_GOAL)
        self._handle.canceled(result)

    def _end(self, end: Callable[[Any], object], result: Any) -> None:
        if not self.has_ended:
            self.has_ended = True
            self._node.call_on_loop(partial(self._end_on_loop, end, result))

    def _end_on_loop(self, end: Callable[[Any], object], result: Any) -> None:
        if self._handle.is_active:
            end(result)


class ControllerAction:
    """An action server of a controller.

    Args:
        node: the controller's node.
        action_type: the name of the action type.
        name: the action's name.
        is_allowed: returns whether a goal message is accepted; called on the event loop.
        begin: called with each accepted goal, in the update thread.
        cancel: called with the goal to cancel, in the update thread, if it is the latest goal that `begin`
            received.
    """

    def __init__(
        self,
        node: ControllerNode,
        action_type: str,
        name: str,
        *,
        is_allowed: Callable[[Any], bool],
        begin: Callable[[Goal], None],
        cancel: Callable[[Goal], None],
    ) -> None:
        self._node = node
        self._is_allowed = is_allowed
        self._begin = begin
        self._cancel = cancel
        self._goal: Goal | None = None
        self._server = _Server(
            node.graph_node,
            action_type,
            name,
            lambda _: None,
            goal_callback=self._on_goal,
            handle_accepted_callback=self._on_accepted,
            cancel_callback=lambda _: CancelResponse.ACCEPT,
        )
        self._server.on_cancel_requested = self._on_cancel_requested

    def close(self) -> None:
        """Remove the action server from the graph."""
        self._server.destroy()

    def _on_goal(self, request: Any) -> GoalResponse:
        return GoalResponse.ACCEPT if self._is_allowed(request) else GoalResponse.REJECT

    def _on_accepted(self, handle: ServerGoalHandle) -> None:
        handle.update(GoalEvent.EXECUTE)
        self._node.post(partial(self._begin_goal, handle))

    def _begin_goal(self, handle: ServerGoalHandle) -> None:
        self._goal = Goal(handle, self._node)
        self._begin(self._goal)

    def _on_cancel_requested(self, handle: ServerGoalHandle) -> None:
        self._node.post(partial(self._cancel_goal, handle))

    def _cancel_goal(self, handle: ServerGoalHandle) -> None:
        if self._goal is not None and self._goal.belongs_to(handle) and not self._goal.has_ended:
            self._cancel(self._goal)
