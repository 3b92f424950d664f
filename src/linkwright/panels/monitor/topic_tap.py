"""Subscribes to any topic, with the message type and QoS of its publishers."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

from linkwright.diagnostics import LinkwrightError
from linkwright.graph import (
    EndpointKind,
    MessageInfo,
    QoSCompatibility,
    QoSProfile,
    Subscription,
    qos_check_compatible,
)
from linkwright.graph.qos.compatibility import fit_profile
from linkwright.graph.qos.profile import QoSPresetProfiles
from linkwright.rviz.context import ViewerContext


class RateLimiter:
    """A limiter of the rate at which a function is called.

    Args:
        work: the function to call.
        period: the minimum time between two calls, in seconds.
    """

    def __init__(self, work: Callable[[], None], period_s: float) -> None:
        self._work = work
        self._period = period_s
        self._loop = asyncio.get_running_loop()
        self._last_call_time = float("-inf")
        self._timer: asyncio.TimerHandle | None = None

    def request(self) -> None:
        """Request a call as soon as the period since the last call has passed."""
        if self._timer is None:
            self._timer = self._loop.call_at(max(self._loop.time(), self._last_call_time + self._period), self._call)

    def cancel(self) -> None:
        """Cancel a requested call."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _call(self) -> None:
        self._timer = None
        self._last_call_time = self._loop.time()
        self._work()


_QUEUE_DEPTH = 500
"""The number of messages that can be queued while the event loop is busy."""


class TopicTap:
    """Receives the messages of a topic.

    The topic need not exist yet. Like ``ros2 topic echo``, the subscription requests the strongest QoS that all
    publishers offer. If a later publisher does not offer this QoS, the topic is subscribed to again.

    Args:
        context: the context of the node that subscribes, which has no remappings.
        topic: the absolute name of the topic.
        take: called with each message, or its bytes if `raw` is true, and the message info.
        raw: whether messages are passed on as CDR bytes.
        changed: called when `error` or `message_class` has changed; None for no callback.
    """

    def __init__(
        self,
        context: ViewerContext,
        topic: str,
        on_message: Callable[[Any, MessageInfo], None],
        *,
        raw: bool = False,
        on_change: Callable[[], None] | None = None,
    ) -> None:
        self.topic = topic
        self.error: str | None = None
        """The reason why no messages can be received, or None if there is no error, or no publisher yet."""
        self.message_class: Any = None
        """The class of the messages, or None while it is not known."""
        self._node = context.node
        self._changes = context.graph_changes
        self._take = on_message
        self._raw = raw
        self._changed = on_change
        self._subscription: Subscription[Any] | None = None
        self._qos: QoSProfile | None = None
        self._changes.watch(self._on_graph_change)
        self._update_subscription()

    def close(self) -> None:
        """Unsubscribe."""
        self._changes.unwatch(self._on_graph_change)
        self._unsubscribe()

    def _on_graph_change(self) -> None:
        previous_state = self.error, self.message_class
        self._update_subscription()
        if (self.error, self.message_class) != previous_state and self._changed is not None:
            self._changed()

    def _update_subscription(self) -> None:
        publishers = [
            endpoint
            for endpoint in self._node.graph.endpoints()
            if endpoint.name == self.topic and endpoint.kind is EndpointKind.PUBLISHER
        ]
        types = sorted({publisher.type_name for publisher in publishers})
        if not types:
            return  # The last known type remains valid until another publisher appears.
        if len(types) > 1:
            self.error = f"the topic carries more than one type: {', '.join(types)}"
            self._unsubscribe()
            return
        offered_profiles = [publisher.qos for publisher in publishers]
        if self._subscription is not None and self._matches(types[0], offered_profiles):
            return
        self._unsubscribe()
        self._subscribe(types[0], offered_profiles)

    def _matches(self, type_name: str, offered_profiles: list[QoSProfile]) -> bool:
        requested_qos = self._qos
        return (
            type_name == self.message_class.TYPE_NAME
            and requested_qos is not None
            and all(
                qos_check_compatible(offer, requested_qos)[0] is not QoSCompatibility.ERROR
                for offer in offered_profiles
            )
        )

    def _subscribe(self, type_name: str, offered_profiles: list[QoSProfile]) -> None:
        from linkwright.messages import get_message

        try:
            self.message_class = get_message(type_name)
        except LinkwrightError as error:
            self.error = error.diagnostics[0].message
            self.message_class = None
            return
        sensor_data = QoSPresetProfiles.get_from_short_key("sensor_data")
        self._qos = fit_profile(sensor_data, offered_profiles).profile
        self._qos.depth = _QUEUE_DEPTH
        self._subscription = Subscription(
            self._node.handle, self.message_class, self.topic, self._qos, self._receive, raw=self._raw
        )
        self._node.handle.add(self._subscription)
        self.error = None

    def _receive(self, message: Any, info: MessageInfo) -> None:
        self._take(message, info)

    def _unsubscribe(self) -> None:
        if self._subscription is not None:
            self._node.destroy_subscription(self._subscription)
            self._subscription = None
