"""Reports of failed navigation goals to pages, with the reason from the server's log."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

from linkwright.graph import ROSOUT_QOS, DurabilityPolicy, EndpointKind, QoSProfile
from linkwright.page.audience import Page
from linkwright.page.protocol.message import ServerMessage
from linkwright.page.protocol.navigation import NO_GOAL_FAILED, GoalOutcome
from linkwright.panels.page_feature import FeatureHost, PageFeature

STATUS_TOPIC = "/navigate_to_pose/_action/status"
_ACTIVE_STATUSES, _ABORTED_STATUS = (1, 2, 3), 6
"""The status numbers of active and aborted goals in action_msgs/msg/GoalStatus."""
_STATUS_DEPTH = 10
"""The queue depth. A queue of one would lose the active state of a goal that fails immediately."""
_ERROR_LEVEL = 40
"""The level of errors in rcl_interfaces/msg/Log."""
_LOG_DELAY_S = 0.3
"""The seconds to wait for the logged reason after a goal is aborted, because it arrives on another topic."""


class GoalOutcomeFeature(PageFeature):
    """A page feature that notifies pages when a goal of ``navigate_to_pose`` is aborted.

    The reported reason is the last error that the node of the action has logged since the goal was accepted. Topics are
    subscribed to only while pages are open.
    """

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._subscriptions: list[Any] = []
        self._goal_id = b""
        self._is_active = False
        self._reasons: dict[str, str] = {}
        self._outcome: GoalOutcome = NO_GOAL_FAILED
        self._publish_timer: asyncio.TimerHandle | None = None

    def opening_messages(self) -> list[ServerMessage]:
        """Subscribe for the first page, and return the outcome of the last goal."""
        if not self._subscriptions:
            latched = QoSProfile(depth=_STATUS_DEPTH, durability=DurabilityPolicy.TRANSIENT_LOCAL)
            self._subscriptions = [
                self._subscribe("action_msgs/msg/GoalStatusArray", STATUS_TOPIC, self._on_status, latched),
                self._subscribe("rcl_interfaces/msg/Log", "/rosout", self._on_log_record, ROSOUT_QOS),
            ]
        return [self._outcome]

    def remove_page(self, page: Page) -> None:
        """Unsubscribe after the last page is closed."""
        if len(self.context.pages) == 0:
            self.close()

    def close(self) -> None:
        """Unsubscribe."""
        if self._publish_timer is not None:
            self._publish_timer.cancel()
            self._publish_timer = None
        for subscription in self._subscriptions:
            self.context.node.destroy_subscription(subscription)
        self._subscriptions.clear()

    def _subscribe(self, message_type: str, topic: str, callback: Callable[[Any], None], qos: QoSProfile) -> Any:
        return self.context.node.create_subscription(message_type, topic, callback, qos)

    def _on_status(self, message: Any) -> None:
        if not message.status_list:
            return
        latest = max(message.status_list, key=acceptance_time)
        goal_id = bytes(latest.goal_info.goal_id.uuid)
        if goal_id != self._goal_id:
            self._goal_id, self._is_active = goal_id, False
            self._reasons.clear()
            self._publish(NO_GOAL_FAILED)
        if latest.status in _ACTIVE_STATUSES:
            self._is_active = True
        elif self._is_active:
            self._is_active = False
            if latest.status == _ABORTED_STATUS:
                self._publish_timer = asyncio.get_running_loop().call_later(
                    _LOG_DELAY_S, self._publish_failure, goal_id
                )

    def _on_log_record(self, record: Any) -> None:
        if record.level >= _ERROR_LEVEL:
            self._reasons[record.name] = record.msg

    def _publish_failure(self, goal: bytes) -> None:
        self._publish_timer = None
        if goal != self._goal_id:
            return
        servers = {
            endpoint.node.name
            for endpoint in self.context.node.graph.endpoints()
            if endpoint.kind is EndpointKind.PUBLISHER and endpoint.name == STATUS_TOPIC and endpoint.node is not None
        }
        reasons = [reason for logger, reason in self._reasons.items() if logger.rpartition(".")[2] in servers]
        self._publish(GoalOutcome(reasons[-1] if reasons else "", failed=True))

    def _publish(self, outcome: GoalOutcome) -> None:
        if outcome != self._outcome:
            self._outcome = outcome
            self.context.pages.publish(outcome)


def acceptance_time(status: Any) -> tuple[int, int]:
    """Return the time at which a GoalStatus's goal was accepted, as (seconds, nanoseconds)."""
    stamp = status.goal_info.stamp
    return stamp.sec, stamp.nanosec
