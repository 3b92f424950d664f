"""The server side of nav2's panel (nav2_rviz_plugins, "Navigation 2"): states, goal progress and commands.

The names of services and topics and the functions of the buttons are those of nav2's panel.
"""

from __future__ import annotations

import asyncio
import math
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from typing import Any

from linkwright.diagnostics import Phrase, phrase
from linkwright.graph import ACTION_STATUS_QOS, Client
from linkwright.messages import get_message, get_service
from linkwright.navigation.page.goal_outcome import accepted_at
from linkwright.nodes.answers import wait_for_future
from linkwright.page.audience import Page
from linkwright.page.protocol.navigation import (
    CommandNavigation,
    GoalState,
    ManagerState,
    NavigationCommand,
    NavigationState,
    WatchNavigation,
)
from linkwright.panels.page_feature import FeatureHost, PageFeature
from linkwright.rviz.context import ViewerContext

_PERIOD = 1.0
"""Seconds between two requests to a lifecycle manager."""

_ACTION = "navigate_to_pose/_action"
_MANAGERS = ("navigation", "localization")
_COMMANDS: dict[NavigationCommand, tuple[int, tuple[str, ...]]] = {
    "startup": (0, ("localization", "navigation")),
    "pause": (1, ("navigation", "localization")),
    "resume": (2, ("localization", "navigation")),
    "reset": (3, ("navigation", "localization")),
}
"""The numbers of nav2_msgs/srv/ManageLifecycleNodes, and the order of the managers."""

_GOALS: dict[int, GoalState] = {
    1: "active",
    2: "active",
    3: "canceling",
    4: "succeeded",
    5: "canceled",
    6: "aborted",
}
"""By the numbers of action_msgs/msg/GoalStatus."""


class NavigationFeature(PageFeature):
    """A page feature that monitors nav2 while a page shows the panel."""

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._pages: set[Page] = set()
        self._watch: _Watch | None = None

    def receive(self, page: Page, message: WatchNavigation | CommandNavigation) -> None:
        """Start or stop sending nav2's state to a page, or execute a command."""
        if isinstance(message, CommandNavigation):
            if self._watch is not None and page in self._pages:
                self._watch.command(message.command)
        elif message.open:
            self._pages.add(page)
            if self._watch is None:
                self._watch = _Watch(self.context, self._publish)
            page.send(self._watch.state)
        else:
            self.page_closed(page)

    def page_closed(self, page: Page) -> None:
        """Stop sending nav2's state to the page."""
        self._pages.discard(page)
        if not self._pages and self._watch is not None:
            self._watch.close()
            self._watch = None

    def close(self) -> None:
        """Stop monitoring nav2."""
        for page in tuple(self._pages):
            self.page_closed(page)

    def _publish(self, state: NavigationState) -> None:
        for page in self._pages:
            page.send(state)


class _Watch:
    """A monitor of nav2's state, from its topics and services.

    Attributes:
        state: the state that was last sent to pages.
    """

    def __init__(self, context: ViewerContext, publish: Callable[[NavigationState], None]) -> None:
        self._node = context.node
        self._publish = publish
        self.state = NavigationState("unknown", "unknown", "none", None, None, None, None, busy=False, problem="")
        self._active = {name: self._client("std_srvs/srv/Trigger", name, "is_active") for name in _MANAGERS}
        self._manage = {
            name: self._client("nav2_msgs/srv/ManageLifecycleNodes", name, "manage_nodes") for name in _MANAGERS
        }
        self._cancel = self._node.create_client(get_service("action_msgs/srv/CancelGoal"), f"{_ACTION}/cancel_goal")
        self._asked: set[str] = set()
        self._goal = b""
        feedback = get_message("nav2_msgs/action/NavigateToPose_FeedbackMessage")
        self._subscriptions = [
            self._node.create_subscription(feedback, f"{_ACTION}/feedback", self._on_feedback, 10),
            self._node.create_subscription(
                "action_msgs/msg/GoalStatusArray", f"{_ACTION}/status", self._goals_changed, ACTION_STATUS_QOS
            ),
        ]
        self._work: asyncio.Task[None] | None = None
        self._next: asyncio.TimerHandle | None = None
        self._ask()

    def command(self, command: NavigationCommand) -> None:
        """Start executing the command of a button, unless another command is running."""
        if self._work is None or self._work.done():
            self._change(busy=True, problem="")
            self._work = asyncio.get_running_loop().create_task(self._do(command))

    def close(self) -> None:
        """Stop monitoring."""
        if self._next is not None:
            self._next.cancel()
        if self._work is not None:
            self._work.cancel()
        with suppress(ValueError):  # The node may have been destroyed already.
            for client in (*self._active.values(), *self._manage.values(), self._cancel):
                self._node.destroy_client(client)
            for subscription in self._subscriptions:
                self._node.destroy_subscription(subscription)

    def _client(self, kind: str, manager: str, service: str) -> Client[Any, Any]:
        return self._node.create_client(get_service(kind), f"lifecycle_manager_{manager}/{service}")

    def _change(self, **fields: Any) -> None:
        known = {name: getattr(self.state, name) for name in NavigationState.__struct_fields__}
        changed = NavigationState(**{**known, **fields})
        if changed != self.state:
            self.state = changed
            self._publish(changed)

    # --- states ------------------------------------------------------------------------------------------------

    def _ask(self) -> None:
        self._next = asyncio.get_running_loop().call_later(_PERIOD, self._ask)
        for name, client in self._active.items():
            if not client.service_is_ready():
                self._asked.discard(name)
                self._change(**{name: "unknown"})
            elif name not in self._asked:
                self._asked.add(name)
                future = client.call_async(client.srv_type.Request())
                future.add_done_callback(partial(self._answered, name))

    def _answered(self, name: str, future: Any) -> None:
        self._asked.discard(name)
        if future.cancelled() or future.exception() is not None:
            return
        state: ManagerState = "active" if future.result().success else "inactive"
        self._change(**{name: state})

    # --- the goal ----------------------------------------------------------------------------------------------

    def _goals_changed(self, message: Any) -> None:
        if not message.status_list:
            return
        last = max(message.status_list, key=accepted_at)
        goal = bytes(last.goal_info.goal_id.uuid)
        fields: dict[str, Any] = {"goal": _GOALS.get(last.status, "none")}
        if goal != self._goal:
            self._goal = goal
            fields.update(eta=None, distance=None, taken=None, recoveries=None)
        self._change(**fields)

    def _on_feedback(self, message: Any) -> None:
        feedback = message.feedback
        distance = float(feedback.distance_remaining)
        self._change(
            eta=_seconds(feedback.estimated_time_remaining),
            taken=_seconds(feedback.navigation_time),
            distance=round(distance, 2) if math.isfinite(distance) else None,
            recoveries=int(feedback.number_of_recoveries),
        )

    # --- commands ----------------------------------------------------------------------------------------------

    async def _do(self, command: NavigationCommand) -> None:
        problem: Phrase | None = None
        if command in ("cancel", "reset"):
            problem = await self._cancel_goals() if self.state.goal == "active" else None
        if command != "cancel":
            number, managers = _COMMANDS[command]
            there = [name for name in managers if self._manage[name].service_is_ready()]
            if not there:
                problem = phrase("no lifecycle manager of nav2 is running")
            for name in there:
                client = self._manage[name]
                answer = await self._call(client, command=number)
                if answer is None or not answer.success:
                    problem = phrase(
                        "lifecycle_manager_{name} could not do this; see its log for the reason", name=name
                    )
                    break
        self._change(busy=False, problem="" if problem is None else str(problem))

    async def _call(self, client: Client[Any, Any], **fields: Any) -> Any:
        """Return the response of a service, or None if the server disappears meanwhile."""
        future = client.call_async(client.srv_type.Request(**fields))
        while not await wait_for_future(self._node, future, _PERIOD):
            if not client.service_is_ready():
                client.remove_pending_request(future)
                return None
        return future.result()

    async def _cancel_goals(self) -> Phrase | None:
        """Cancel all goals, and return an error message or None.

        A request with an empty id and time cancels all goals.
        """
        if not self._cancel.service_is_ready():
            return phrase("there is no action '{name}'", name="navigate_to_pose")
        answer = await self._call(self._cancel)
        if answer is None:
            return phrase("the goal could not be cancelled: the server does not respond")
        if answer.return_code != 0:
            return phrase("the goal could not be cancelled: code {code}", code=answer.return_code)
        return None


def _seconds(duration: Any) -> float:
    return round(float(duration.sec) + float(duration.nanosec) * 1e-9, 1)
