"""Action servers that execute one goal at a time, as in nav2.

A new goal replaces the previous one.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from linkwright.graph import ActionServer
from linkwright.graph.actions.goal import CancelResponse, GoalEvent, GoalResponse, ServerGoalHandle
from linkwright.messages import get_action
from linkwright.navigation.nodes.managed import ManagedNode


class GoalError(Exception):
    """Raised when a goal cannot be reached.

    The message gives the reason.

    Attributes:
        code: the name of nav2's error code.
    """

    def __init__(self, code: str, reason: str) -> None:
        super().__init__(reason)
        self.code = code


class GoalServer:
    """The action server of a managed node.

    Goals are rejected while the node is not active.

    The code that executes the goal must check `is_canceled` regularly, and then call `end_canceled`.

    Args:
        node: the node that offers the action.
        action_type: the type of the action.
        name: the name of the action.
        on_accepted: called with each accepted goal, after the previous goal was aborted.
        accepts_goal: returns whether to accept a goal; by default every goal is accepted.

    Attributes:
        active_goal: the active goal; None if there is none.
    """

    def __init__(
        self,
        node: ManagedNode,
        action_type: str,
        name: str,
        on_accepted: Callable[[ServerGoalHandle], None],
        *,
        accepts_goal: Callable[[Any], bool] | None = None,
    ) -> None:
        self.active_goal: ServerGoalHandle | None = None
        self._type = get_action(action_type)
        self._on_goal_accepted = on_accepted
        self._accepts_goal = accepts_goal
        self._node = node
        self._server = ActionServer(
            node,
            self._type,
            name,
            _do_not_execute,
            goal_callback=self._on_goal,
            handle_accepted_callback=self._on_accepted,
            cancel_callback=lambda _goal: CancelResponse.ACCEPT,
        )

    @property
    def goal(self) -> Any:
        """The goal message of the active goal."""
        assert self.active_goal is not None, "there is an active goal"
        return self.active_goal.request

    @property
    def is_canceled(self) -> bool:
        """Whether cancellation of the active goal was requested."""
        return self.active_goal is not None and self.active_goal.is_cancel_requested

    def publish_feedback(self, **fields: Any) -> None:
        """Publish feedback for the active goal, if there is one.

        The arguments are the fields of the feedback.
        """
        if self.active_goal is not None:
            message = self._type.Feedback()
            for name, value in fields.items():
                setattr(message, name, value)
            self.active_goal.publish_feedback(message)

    def succeed(self, **fields: Any) -> None:
        """End the active goal with the status succeeded.

        The arguments are the fields of the result.
        """
        if (goal := self._take_active_goal()) is not None:
            goal.succeed(self._make_result("", "", fields))

    def abort(self, code: str, reason: str, **fields: Any) -> None:
        """End the active goal with the status aborted.

        Args:
            code: the name of the error code, for results that have an error code (Jazzy).
            reason: the error message.
            fields: the fields of the result.
        """
        if (goal := self._take_active_goal()) is not None:
            goal.abort(self._make_result(code, reason, fields))

    def end_canceled(self, **fields: Any) -> None:
        """End the active goal as canceled, or as aborted if no cancellation was requested."""
        if (goal := self._take_active_goal()) is not None:
            if goal.is_cancel_requested:
                goal.canceled(self._make_result("", "", fields))
            else:
                goal.abort(self._make_result("", "", fields))

    def destroy(self) -> None:
        """Abort the active goal, and destroy the action server."""
        self.abort("UNKNOWN", "the server was destroyed")
        self._server.destroy()

    def _take_active_goal(self) -> ServerGoalHandle | None:
        goal, self.active_goal = self.active_goal, None
        return goal if goal is not None and goal.is_active else None

    def _on_goal(self, goal: Any) -> GoalResponse:
        if not self._node.is_active:
            self._node.get_logger().warning("Action server is inactive. Rejecting the goal.")
            return GoalResponse.REJECT
        is_accepted = self._accepts_goal is None or self._accepts_goal(goal)
        return GoalResponse.ACCEPT if is_accepted else GoalResponse.REJECT

    def _on_accepted(self, goal: ServerGoalHandle) -> None:
        self.abort("UNKNOWN", "another goal replaced it")
        goal.update(GoalEvent.EXECUTE)
        self.active_goal = goal
        self._on_goal_accepted(goal)

    def _make_result(self, code: str, reason: str, fields: dict[str, Any]) -> Any:
        result = self._type.Result()
        if code and hasattr(result, "error_code"):
            result.error_code = getattr(result, code, 0)
        if code and hasattr(result, "error_msg"):
            result.error_msg = reason
        for name, value in fields.items():
            setattr(result, name, value)
        return result


def _do_not_execute(_goal: ServerGoalHandle) -> None:
    """Do nothing, because goals are executed by timers instead of this callback."""
