"""QoS events of an endpoint: counting, time limits, and the queue for the user's callbacks."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from functools import partial
from typing import Any

from linkwright.graph.endpoints.base import TopicEndpoint
from linkwright.graph.endpoints.event_types import (
    EndpointEventCallbacks,
    EventCallback,
    EventCount,
    PublisherEventCallbacks,
    QoSLivelinessChangedInfo,
    QoSLivelinessLostInfo,
    QoSMatchedInfo,
    QoSMessageLostInfo,
    QoSOfferedDeadlineMissedInfo,
    QoSRequestedDeadlineMissedInfo,
    QoSRequestedIncompatibleQoSInfo,
    SubscriptionEventCallbacks,
)
from linkwright.graph.loop.dispatcher import Entity
from linkwright.graph.loop.node_handle import Dispatcher
from linkwright.graph.qos.compatibility import limit_ns
from linkwright.graph.qos.profile import LivelinessPolicy, QoSPolicyKind
from linkwright.graph.time.clock import Alarm


class _Watchdog:
    """A watchdog that calls a function each time a time limit passes without activity.

    The first activity starts the watchdog.
    """

    def __init__(self, owner: EndpointEvents, limit: int, on_missed: Callable[[], None]) -> None:
        self._owner = owner
        self._limit_ns = limit
        self._on_missed = on_missed
        self._last_ns: int | None = None
        self._alarm: Alarm | None = None
        self._lock = threading.Lock()

    def restart(self) -> None:
        """Restart the time limit after activity of the endpoint.

        Callable from any thread.
        """
        with self._lock:
            self._last_ns = self._owner.node.timebase.steady_ns()
            self._arm()

    def resume(self) -> None:
        """Rearm the watchdog on the owner's current dispatcher, if it was started before."""
        with self._lock:
            self._arm()

    def stop(self) -> None:
        """Stop the watchdog until the next call of `restart` or `resume`."""
        with self._lock:
            if self._alarm is not None:
                self._alarm.cancel()
                self._alarm = None

    def _arm(self) -> None:
        dispatcher = self._owner.dispatcher
        if dispatcher is not None and self._alarm is None and self._last_ns is not None:
            self._alarm = dispatcher.call_at(self._last_ns + self._limit_ns, self._check_deadline)

    def _check_deadline(self) -> None:
        with self._lock:
            self._alarm = None
            now_ns = self._owner.node.timebase.steady_ns()
            is_missed = self._last_ns is not None and now_ns >= self._last_ns + self._limit_ns
            if is_missed:
                self._last_ns = now_ns
            self._arm()
        if is_missed:
            self._on_missed()


class EndpointEvents(Entity):
    """The QoS events of an endpoint, queued for their callbacks like messages."""

    _deadline_info: type[EventCount]

    def __init__(self, endpoint: TopicEndpoint[Any], callbacks: EndpointEventCallbacks) -> None:
        super().__init__(endpoint.node, endpoint.callback_group)
        self._name = endpoint.name
        self._callbacks = callbacks
        self._waiting: deque[Callable[[], object]] = deque()
        self._totals: dict[str, int] = {}
        self._match_count = 0
        self._watchdogs: list[_Watchdog] = []
        self._deadline: _Watchdog | None = None
        deadline_ns = limit_ns(endpoint.qos_profile.deadline)
        if deadline_ns is not None and callbacks.deadline is not None:
            self._deadline = self._watch(deadline_ns, self._on_deadline_missed)

    @property
    def description(self) -> str:
        """The description of this entity in log messages."""
        return f"event callback of topic '{self._name}'"

    def on_match_change(self, change: int) -> None:
        """Count a change in the number of matching endpoints, and queue the callback."""
        self._match_count += change
        total = self._count("matched", max(change, 0))
        self._notify(self._callbacks.matched, QoSMatchedInfo(total, max(change, 0), self._match_count, change))

    def report_incompatible(self, policy: str) -> bool:
        """Count an endpoint with incompatible QoS, and queue the callback if there is one.

        Returns:
            True if no warning must be logged: a callback exists, or the user disabled the default callbacks.
        """
        total = self._count("incompatible", 1)
        if self._callbacks.incompatible_qos is None:
            return not self._callbacks.use_default_callbacks
        kind = QoSPolicyKind[policy.removesuffix("_QOS_POLICY")]
        self._notify(self._callbacks.incompatible_qos, QoSRequestedIncompatibleQoSInfo(total, 1, kind))
        return True

    def has_work(self) -> bool:
        """Return whether events are queued."""
        return bool(self._waiting)

    def take(self) -> Callable[[], object] | None:
        """Remove the oldest event from the queue and return the call of its callback.

        Returns None if the queue is empty.
        """
        return self._take_from(self._waiting)

    def retire(self) -> None:
        """Stop calling callbacks, and drop the queued events."""
        for watchdog in self._watchdogs:
            watchdog.stop()
        super().retire()
        self._waiting.clear()

    def set_dispatcher(self, dispatcher: Dispatcher | None) -> None:
        """Set the dispatcher that runs the callbacks and monitors the time limits."""
        for watchdog in self._watchdogs:
            watchdog.stop()
        super().set_dispatcher(dispatcher)
        for watchdog in self._watchdogs:
            watchdog.resume()

    def _count(self, event: str, change: int) -> int:
        self._totals[event] = total = self._totals.get(event, 0) + change
        return total

    def _watch(self, limit: int, on_missed: Callable[[], None]) -> _Watchdog:
        watchdog = _Watchdog(self, limit, on_missed)
        self._watchdogs.append(watchdog)
        return watchdog

    def _on_deadline_missed(self) -> None:
        self._notify(self._callbacks.deadline, self._deadline_info(self._count("deadline", 1), 1))

    def _notify(self, callback: EventCallback | None, info: object) -> None:
        if callback is not None and not self.destroyed:
            self._waiting.append(partial(callback, info))
            self.announce()


class SubscriptionEvents(EndpointEvents):
    """The events of a subscription."""

    _deadline_info = QoSRequestedDeadlineMissedInfo

    def __init__(self, subscription: TopicEndpoint[Any], callbacks: SubscriptionEventCallbacks) -> None:
        super().__init__(subscription, callbacks)
        self._message_lost = callbacks.message_lost
        self._alive_count = 0
        self._not_alive_count = 0
        self._remote_counts = (0, 0)

    def record_message(self) -> None:
        """Record the arrival of a message, from this process or another."""
        if self._deadline is not None:
            self._deadline.restart()

    def count_lost(self, count: int) -> None:
        """Count lost messages, and queue the callback."""
        self._notify(self._message_lost, QoSMessageLostInfo(self._count("lost", count), count))

    def set_remote_liveliness(self, alive: int, not_alive: int) -> None:
        """Set the numbers of publishers in other processes that are alive and not alive."""
        (previous_alive, previous_not_alive), self._remote_counts = self._remote_counts, (alive, not_alive)
        self.on_liveliness_change(alive - previous_alive, not_alive - previous_not_alive)

    def on_liveliness_change(self, alive_change: int, not_alive_change: int) -> None:
        """Update the numbers of publishers that are alive and not alive, and queue the callback."""
        if not alive_change and not not_alive_change:
            return
        self._alive_count += alive_change
        self._not_alive_count += not_alive_change
        info = QoSLivelinessChangedInfo(self._alive_count, self._not_alive_count, alive_change, not_alive_change)
        self._notify(self._callbacks.liveliness, info)


class PublisherEvents(EndpointEvents):
    """The events of a publisher.

    Args:
        publisher: the publisher.
        callbacks: the user's callbacks.
        liveliness_changed: called with -1 when the publisher loses its liveliness, with 1 when it is alive again.
    """

    _deadline_info = QoSOfferedDeadlineMissedInfo

    def __init__(
        self,
        publisher: TopicEndpoint[Any],
        callbacks: PublisherEventCallbacks,
        liveliness_changed: Callable[[int], None],
    ) -> None:
        super().__init__(publisher, callbacks)
        self._liveliness_changed = liveliness_changed
        self._lease_watchdog: _Watchdog | None = None
        self._is_alive = True
        qos = publisher.qos_profile
        lease_ns = limit_ns(qos.liveliness_lease_duration)
        if qos.liveliness is LivelinessPolicy.MANUAL_BY_TOPIC and lease_ns is not None:
            self._lease_watchdog = self._watch(lease_ns, self._on_liveliness_lost)

    @property
    def wants_messages(self) -> bool:
        """Whether `record_publication` must be called for every message."""
        return bool(self._watchdogs)

    def record_publication(self) -> None:
        """Record that a message was published."""
        if self._deadline is not None:
            self._deadline.restart()
        self.assert_liveliness()

    def assert_liveliness(self) -> None:
        """Record that the publisher asserted its liveliness."""
        if self._lease_watchdog is not None:
            self._lease_watchdog.restart()
            if not self._is_alive:
                self._is_alive = True
                self._liveliness_changed(1)

    def set_dispatcher(self, dispatcher: Dispatcher | None) -> None:
        """Set the dispatcher that runs the callbacks and monitors the time limits.

        A new dispatcher also restarts the liveliness lease.
        """
        super().set_dispatcher(dispatcher)
        if self._lease_watchdog is not None:
            self._lease_watchdog.restart()

    def _on_liveliness_lost(self) -> None:
        if self._is_alive:
            self._is_alive = False
            self._liveliness_changed(-1)
            self._notify(self._callbacks.liveliness, QoSLivelinessLostInfo(self._count("liveliness", 1), 1))
