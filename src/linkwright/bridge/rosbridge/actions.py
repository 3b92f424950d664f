"""Goals that clients send to actions, and actions that clients offer."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import dataclass
from itertools import count
from typing import Any

from linkwright.bridge.rosbridge.requests import Request, RequestError, full_type_name
from linkwright.bridge.rosbridge.values import Now, from_json_arguments, from_json_values
from linkwright.graph import ActionClient, ActionServer, CancelResponse, ClientGoalHandle, GoalStatus, Node
from linkwright.graph import ServerGoalHandle as GoalHandle
from linkwright.graph.loop.node_handle import ReentrantCallbackGroup
from linkwright.messages import get_action
from linkwright.nodes.service_waits import wait_for_future, wait_for_graph

_SERVER_TIMEOUT_S = 5.0
_POLL_PERIOD_S = 0.1
_ENDS = {GoalStatus.SUCCEEDED: GoalHandle.succeed, GoalStatus.CANCELED: GoalHandle.canceled}

Send = Callable[[dict[str, Any]], object]
"""A function that sends a message to the client."""


class SentGoal:
    """A goal that a client sends to an action of the graph.

    Args:
        node: the node that sends the goal.
        action: the name in the client's request.
        type_name: the type in the client's request.
    """

    def __init__(self, node: Node, action: str, type_name: str) -> None:
        self._node = node
        self._action = action
        self._class: Any = get_action(full_type_name(type_name, "action"))
        self._handle: ClientGoalHandle | None = None
        self._is_canceled = False

    async def run(
        self, arguments: Any, now: Now, on_feedback: Callable[[dict[str, Any]], object] | None
    ) -> tuple[dict[str, Any], int]:
        """Send the goal, and return the values of its result and its final state.

        If the task is canceled because the client has gone, the goal continues, as that of any action client.

        Args:
            arguments: the values of the goal, as a dictionary or a list.
            now: returns the current time.
            on_feedback: called with the values of each feedback message; None to receive none.

        Raises:
            RequestError: a value is not valid, there is no such action, or the goal is rejected.
        """
        goal = from_json_arguments(arguments, self._class.Goal, now)
        client = ActionClient(self._node, self._class, self._action, callback_group=ReentrantCallbackGroup())
        try:
            if not await self._wait_for_server(client):
                raise RequestError(f"Action {self._action} does not exist")
            forward = None
            if on_feedback is not None:
                send_feedback = on_feedback

                def forward(message: Any) -> None:
                    send_feedback(message.feedback)

            sent = client.send_goal_async(goal, feedback_callback=forward)
            await wait_for_future(self._node, sent, None)
            self._handle = sent.result()
            if self._handle is None or not self._handle.accepted:
                raise RequestError("Action goal was rejected")
            if self._is_canceled:
                self._handle.cancel_goal_async()
            result = self._handle.get_result_async()
            await wait_for_future(self._node, result, None)
            response: Any = result.result()
            return response.result, int(response.status)
        finally:
            client.destroy()

    async def _wait_for_server(self, client: ActionClient) -> bool:
        """Wait until the action is available, and return whether it is.

        The graph announces services, but not every match of a topic in another process. So this also polls.
        """
        for _ in range(round(_SERVER_TIMEOUT_S / _POLL_PERIOD_S)):
            if await wait_for_graph(self._node, client.server_is_ready, _POLL_PERIOD_S):
                return True
        return client.server_is_ready()

    def cancel(self) -> None:
        """Request the cancellation of the goal, also of one that the server has not accepted yet."""
        self._is_canceled = True
        if self._handle is not None:
            self._handle.cancel_goal_async()


@dataclass(slots=True)
class _OpenGoal:
    handle: GoalHandle
    end: asyncio.Future[tuple[GoalStatus, Any]]


class OfferedAction:
    """An action that a client of rosbridge offers to the graph.

    Args:
        node: the node that offers the action.
        name: the name in the client's request.
        type_name: the type in the client's request.
        send: sends a message to the client.
        now: returns the current time.

    Raises:
        LinkwrightError: the name is not valid, or the type is unknown.
    """

    def __init__(self, node: Node, name: str, type_name: str, send: Send, now: Now) -> None:
        self._name = name
        self._type_name = type_name
        self._send = send
        self._now = now
        self._class: Any = get_action(full_type_name(type_name, "action"))
        self._goals: dict[str, _OpenGoal] = {}
        self._numbers = count(1)
        self._server = ActionServer(
            node,
            self._class,
            name,
            self._execute,
            cancel_callback=self._on_cancel,
            callback_group=ReentrantCallbackGroup(),
        )

    def send_feedback(self, request: Request) -> None:
        """Publish feedback of the client.

        Raises:
            RequestError: there is no such goal, or a value is not valid.
        """
        goal = self._find_goal(request)
        goal.handle.publish_feedback(from_json_values(request.get("values") or {}, self._class.Feedback, self._now))

    def end_goal(self, request: Request) -> None:
        """End a goal with the client's result.

        Raises:
            RequestError: there is no such goal, or a value is not valid.
        """
        goal = self._find_goal(request)
        has_result = request.read("result", bool)
        status = request.read("status", int, int(GoalStatus.ABORTED)) if has_result else int(GoalStatus.ABORTED)
        values = request.get("values")
        result = from_json_values(values if isinstance(values, dict) else {}, self._class.Result, self._now)
        if not goal.end.done():
            goal.end.set_result((GoalStatus(status) if status in _ENDS else GoalStatus.ABORTED, result))

    def close(self) -> None:
        """Abort the goals, and end the action."""
        for goal in self._goals.values():
            if not goal.end.done():
                goal.handle.abort(self._class.Result())
                goal.end.cancel()
        self._server.destroy()

    def _find_goal(self, request: Request) -> _OpenGoal:
        goal = self._goals.get(str(request.identity))
        if goal is None:
            raise RequestError(f"Action {self._name} has no goal with the id {str(request.identity)[:200]}")
        return goal

    async def _execute(self, handle: GoalHandle) -> Any:
        identity = f"action_goal:{self._name}:{next(self._numbers)}"
        end: asyncio.Future[tuple[GoalStatus, Any]] = asyncio.get_running_loop().create_future()
        self._goals[identity] = _OpenGoal(handle, end)
        self._send(
            {
                "op": "send_action_goal",
                "id": identity,
                "action": self._name,
                "action_type": self._type_name,
                "args": handle.request,
                "feedback": True,
            }
        )
        try:
            status, result = await end
        finally:
            del self._goals[identity]
        if status is GoalStatus.CANCELED and not handle.is_cancel_requested:
            status = GoalStatus.ABORTED
        _ENDS.get(status, GoalHandle.abort)(handle)
        return result

    def _on_cancel(self, handle: GoalHandle) -> CancelResponse:
        for identity, goal in self._goals.items():
            if goal.handle == handle:
                self._send({"op": "cancel_action_goal", "id": identity, "action": self._name})
        return CancelResponse.ACCEPT
