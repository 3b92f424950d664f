"""The server side of nav2's panel: states, goal progress and commands.

Services, topics and buttons are the same as in nav2's panel (nav2_rviz_plugins, "Navigation 2").
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
from linkwright.navigation.page.goal_outcome import acceptance_time
from linkwright.nodes.service_waits import wait_for_future
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

_POLL_PERIOD_S = 1.0
"""The period of the requests to the lifecycle managers, in seconds."""

_ACTION = "navigate_to_pose/_action"
_MANAGERS = ("navigation", "localization")
_COMMANDS: dict[NavigationCommand, tuple[int, tuple[str, ...]]] = {
    "startup": (0, ("localization", "navigation")),
    "pause": (1, ("navigation", "localization")),
    "resume": (2, ("localization", "navigation")),
    "reset": (3, ("navigation", "localization")),
}
"""For each button, its number in nav2_msgs/srv/ManageLifecycleNodes, and the order of the managers."""

_GOAL_STATES: dict[int, GoalState] = {
    1: "active",
    2: "active",
    3: "canceling",
    4: "succeeded",
    5: "canceled",
    6: "aborted",
}
"""The state of a goal for each status number of action_msgs/msg/GoalStatus."""


class NavigationFeature(PageFeature):
    """A page feature that monitors nav2 while a page shows the panel."""

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._pages: set[Page] = set()
        self._watch: _NavigationMonitor | None = None

    def receive(self, page: Page, message: WatchNavigation | CommandNavigation) -> None:
        """Start or stop sending nav2's state to a page, or execute a command."""
        if isinstance(message, CommandNavigation):
            if self._watch is not None and page in self._pages:
                self._watch.command(message.command)
        elif message.open:
            self._pages.add(page)
            if self._watch is None:
                self._watch = _NavigationMonitor(self.context, self._publish)
            page.send(self._watch.state)
        else:
            self.remove_page(page)

    def remove_page(self, page: Page) -> None:
        """Stop sending nav2's state to the page."""
        self._pages.discard(page)
        if not self._pages and self._watch is not None:
            self._watch.close()
            self._watch = None

    def close(self) -> None:
        """Stop monitoring nav2."""
        for page in tuple(self._pages):
            self.remove_page(page)

    def _publish(self, state: NavigationState) -> None:
        for page in self._pages:
            page.send(state)


class _NavigationMonitor:
    """Follows nav2's state through its topics and services.

    Attributes:
        state: the state that was last sent to pages.
    """

    def __init__(self, context: ViewerContext, publish: Callable[[NavigationState], None]) -> None:
        self._node = context.node
        self._publish = publish
        self.state = NavigationState("unknown", "unknown", "none", None, None, None, None, busy=False, problem="")
        self._active = {name: self._create_client("std_srvs/srv/Trigger", name, "is_active") for name in _MANAGERS}
        self._manage_clients = {
            name: self._create_client("nav2_msgs/srv/ManageLifecycleNodes", name, "manage_nodes") for name in _MANAGERS
        }
        self._cancel_client = self._node.create_client(
            get_service("action_msgs/srv/CancelGoal"), f"{_ACTION}/cancel_goal"
        )
        self._pending_managers: set[str] = set()
        self._goal_id = b""
        feedback = get_message("nav2_msgs/action/NavigateToPose_FeedbackMessage")
        self._subscriptions = [
            self._node.create_subscription(feedback, f"{_ACTION}/feedback", self._on_feedback, 10),
            self._node.create_subscription(
                "action_msgs/msg/GoalStatusArray", f"{_ACTION}/status", self._on_status, ACTION_STATUS_QOS
            ),
        ]
        self._work: asyncio.Task[None] | None = None
        self._request_timer: asyncio.TimerHandle | None = None
        self._request_states()

    def command(self, command: NavigationCommand) -> None:
        """Start executing the command of a button, unless another command is running."""
        if self._work is None or self._work.done():
            self._update_state(busy=True, problem="")
            self._work = asyncio.get_running_loop().create_task(self._execute(command))

    def close(self) -> None:
        """Stop monitoring."""
        if self._request_timer is not None:
            self._request_timer.cancel()
        if self._work is not None:
            self._work.cancel()
        with suppress(ValueError):  # The node may have been destroyed already.
            for client in (*self._active.values(), *self._manage_clients.values(), self._cancel_client):
                self._node.destroy_client(client)
            for subscription in self._subscriptions:
                self._node.destroy_subscription(subscription)

    def _create_client(self, service_type: str, manager: str, service: str) -> Client[Any, Any]:
        return self._node.create_client(get_service(service_type), f"lifecycle_manager_{manager}/{service}")

    def _update_state(self, **fields: Any) -> None:
        old_fields = {name: getattr(self.state, name) for name in NavigationState.__struct_fields__}
        new_state = NavigationState(**{**old_fields, **fields})
        if new_state != self.state:
            self.state = new_state
            self._publish(new_state)

    # --- states ------------------------------------------------------------------------------------------------

    def _request_states(self) -> None:
        self._request_timer = asyncio.get_running_loop().call_later(_POLL_PERIOD_S, self._request_states)
        for name, client in self._active.items():
            if not client.service_is_ready():
                self._pending_managers.discard(name)
                self._update_state(**{name: "unknown"})
            elif name not in self._pending_managers:
                self._pending_managers.add(name)
                future = client.call_async(client.srv_type.Request())
                future.add_done_callback(partial(self._on_state_response, name))

    def _on_state_response(self, name: str, future: Any) -> None:
        self._pending_managers.discard(name)
        if future.cancelled() or future.exception() is not None:
            return
        state: ManagerState = "active" if future.result().success else "inactive"
        self._update_state(**{name: state})

    # --- goal ------------------------------------------------------------------------------------------------

    def _on_status(self, message: Any) -> None:
        if not message.status_list:
            return
        latest = max(message.status_list, key=acceptance_time)
        goal_id = bytes(latest.goal_info.goal_id.uuid)
        fields: dict[str, Any] = {"goal": _GOAL_STATES.get(latest.status, "none")}
        if goal_id != self._goal_id:
            self._goal_id = goal_id
            fields.update(eta=None, distance=None, elapsed=None, recoveries=None)
        self._update_state(**fields)

    def _on_feedback(self, message: Any) -> None:
        feedback = message.feedback
        distance = float(feedback.distance_remaining)
        self._update_state(
            eta=_seconds_from_duration(feedback.estimated_time_remaining),
            elapsed=_seconds_from_duration(feedback.navigation_time),
            distance=round(distance, 2) if math.isfinite(distance) else None,
            recoveries=int(feedback.number_of_recoveries),
        )

    # --- commands ----------------------------------------------------------------------------------------------

    async def _execute(self, command: NavigationCommand) -> None:
        problem: Phrase | None = None
        if command in ("cancel", "reset"):
            problem = await self._cancel_goals() if self.state.goal == "active" else None
        if command != "cancel":
            number, managers = _COMMANDS[command]
            available = [name for name in managers if self._manage_clients[name].service_is_ready()]
            if not available:
                problem = phrase("no lifecycle manager of nav2 is running; start nav2 first")
            for name in available:
                client = self._manage_clients[name]
                response = await self._call(client, command=number)
                if response is None or not response.success:
                    problem = phrase(
                        "lifecycle_manager_{name} could not execute the command; see its log for the reason", name=name
                    )
                    break
        self._update_state(busy=False, problem="" if problem is None else str(problem))

    async def _call(self, client: Client[Any, Any], **fields: Any) -> Any:
        """Return the response of a service, or None if the server disappears before it responds."""
        future = client.call_async(client.srv_type.Request(**fields))
        while not await wait_for_future(self._node, future, _POLL_PERIOD_S):
            if not client.service_is_ready():
                client.remove_pending_request(future)
                return None
        return future.result()

    async def _cancel_goals(self) -> Phrase | None:
        """Cancel all goals, and return an error message, or None after success.

        A request with an empty id and time cancels all goals.
        """
        if not self._cancel_client.service_is_ready():
            return phrase(
                "the goal could not be canceled: no node provides the action '{name}'", name="navigate_to_pose"
            )
        response = await self._call(self._cancel_client)
        if response is None:
            return phrase("the goal could not be canceled: the server does not respond")
        if response.return_code != 0:
            return phrase("the goal could not be canceled: code {code}", code=response.return_code)
        return None


def _seconds_from_duration(duration: Any) -> float:
    return round(float(duration.sec) + float(duration.nanosec) * 1e-9, 1)
