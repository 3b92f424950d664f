"""A subscription to any topic, with the type and QoS of the topic's publishers."""

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
from linkwright.graph.qos.compatibility import fit
from linkwright.graph.qos.profile import QoSPresetProfiles
from linkwright.rviz.context import ViewerContext


class Paced:
    """Limits how often work is done that may be requested more often.

    Args:
        work: the function that does the work.
        period: the minimum time between two calls, seconds.
    """

    def __init__(self, work: Callable[[], None], period: float) -> None:
        self._work = work
        self._period = period
        self._loop = asyncio.get_running_loop()
        self._done_at = float("-inf")
        self._due: asyncio.TimerHandle | None = None

    def ask(self) -> None:
        """Request the work, which is done as soon as the period since the last time has passed."""
        if self._due is None:
            self._due = self._loop.call_at(max(self._loop.time(), self._done_at + self._period), self._do)

    def cancel(self) -> None:
        """Cancel a request for which the work has not been done yet."""
        if self._due is not None:
            self._due.cancel()
            self._due = None

    def _do(self) -> None:
        self._due = None
        self._done_at = self._loop.time()
        self._work()


_DEPTH = 500
"""The number of messages that may wait while the loop is busy."""


class TopicTap:
    """Receives the messages of a topic until it is closed.

    The topic need not exist yet. Like ``ros2 topic echo``, the subscription requests the strongest QoS that all
    publishers offer. If a later publisher offers less, the topic is subscribed to again.

    Args:
        context: the context of the node that subscribes. The node has no remappings, so topics are named as in the
            graph.
        topic: the absolute name of the topic.
        take: called with each message, or its bytes, and the message info.
        raw: whether `take` is called with CDR bytes instead of messages.
        changed: called when `error` or `message_class` has changed.
    """

    def __init__(
        self,
        context: ViewerContext,
        topic: str,
        take: Callable[[Any, MessageInfo], None],
        *,
        raw: bool = False,
        changed: Callable[[], None] | None = None,
    ) -> None:
        self.topic = topic
        self.error: str | None = None
        """Why nothing can be received; None also while there is no publisher."""
        self.message_class: Any = None
        """The class of the messages; None while it is not known."""
        self._node = context.node
        self._changes = context.graph_changes
        self._take = take
        self._raw = raw
        self._changed = changed
        self._subscription: Subscription[Any] | None = None
        self._qos: QoSProfile | None = None
        self._changes.watch(self._look)
        self._review()

    def close(self) -> None:
        """Unsubscribe."""
        self._changes.unwatch(self._look)
        self._leave()

    def _look(self) -> None:
        before = self.error, self.message_class
        self._review()
        if (self.error, self.message_class) != before and self._changed is not None:
            self._changed()

    def _review(self) -> None:
        publishers = [
            endpoint
            for endpoint in self._node.graph.endpoints()
            if endpoint.name == self.topic and endpoint.kind is EndpointKind.PUBLISHER
        ]
        types = sorted({publisher.type_name for publisher in publishers})
        if not types:
            return  # the last known type remains valid until another publisher appears
        if len(types) > 1:
            self.error = f"the topic carries more than one type: {', '.join(types)}"
            self._leave()
            return
        offers = [publisher.qos for publisher in publishers]
        if self._subscription is not None and self._fits(types[0], offers):
            return
        self._leave()
        self._subscribe(types[0], offers)

    def _fits(self, type_name: str, offers: list[QoSProfile]) -> bool:
        asked = self._qos
        return (
            type_name == self.message_class.TYPE_NAME
            and asked is not None
            and all(qos_check_compatible(offer, asked)[0] is not QoSCompatibility.ERROR for offer in offers)
        )

    def _subscribe(self, type_name: str, offers: list[QoSProfile]) -> None:
        from linkwright.messages import get_message

        try:
            self.message_class = get_message(type_name)
        except LinkwrightError as error:
            self.error = error.diagnostics[0].message
            self.message_class = None
            return
        sensor_data = QoSPresetProfiles.get_from_short_key("sensor_data")
        self._qos = fit(sensor_data, offers).profile
        self._qos.depth = _DEPTH
        self._subscription = Subscription(
            self._node.handle, self.message_class, self.topic, self._qos, self._receive, raw=self._raw
        )
        self._node.handle.add(self._subscription)
        self.error = None

    def _receive(self, message: Any, info: MessageInfo) -> None:
        self._take(message, info)

    def _leave(self) -> None:
        if self._subscription is not None:
            self._node.destroy_subscription(self._subscription)
            self._subscription = None
