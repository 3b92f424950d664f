"""What quality of service has to tell the user's code: mismatches, missed deadlines, lost messages, matches.

The containers of callbacks and what the callbacks are given have rclpy's names (``rclpy.event_handler``).
"""

from __future__ import annotations

from abc import abstractmethod
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

from linkwright.graph.dispatch import Alarm, Dispatcher
from linkwright.graph.entity import Entity
from linkwright.graph.qos import QoSPolicyKind
from linkwright.graph.qos_compatibility import limit_ns

if TYPE_CHECKING:
    from linkwright.graph.dispatch import CallbackGroup
    from linkwright.graph.node import Node
    from linkwright.graph.publisher import Publisher
    from linkwright.graph.subscription import Subscription

EventCallback = Callable[[Any], object]


@dataclass(frozen=True, slots=True)
class QoSRequestedDeadlineMissedInfo:
    """How often no message came in time."""

    total_count: int
    total_count_change: int


@dataclass(frozen=True, slots=True)
class QoSOfferedDeadlineMissedInfo:
    """How often no message was published in time."""

    total_count: int
    total_count_change: int


@dataclass(frozen=True, slots=True)
class QoSRequestedIncompatibleQoSInfo:
    """How many endpoints of the other side do not go together with this one, and the policy of the last."""

    total_count: int
    total_count_change: int
    last_policy_kind: QoSPolicyKind


QoSOfferedIncompatibleQoSInfo = QoSRequestedIncompatibleQoSInfo


@dataclass(frozen=True, slots=True)
class QoSLivelinessChangedInfo:
    """How many of the publishers live, and how many do not."""

    alive_count: int
    not_alive_count: int
    alive_count_change: int
    not_alive_count_change: int


@dataclass(frozen=True, slots=True)
class QoSLivelinessLostInfo:
    """How often a publisher did not show in time that it lives."""

    total_count: int
    total_count_change: int


@dataclass(frozen=True, slots=True)
class QoSMessageLostInfo:
    """How many messages were lost."""

    total_count: int
    total_count_change: int


@dataclass(frozen=True, slots=True)
class QoSMatchedInfo:
    """How many endpoints of the other side there were and are."""

    total_count: int
    total_count_change: int
    current_count: int
    current_count_change: int


QoSPublisherMatchedInfo = QoSMatchedInfo
QoSSubscriptionMatchedInfo = QoSMatchedInfo


@dataclass(kw_only=True)
class SubscriptionEventCallbacks:
    """What a subscription's user wants to hear of; each callback gets the information of that name."""

    deadline: EventCallback | None = None
    incompatible_qos: EventCallback | None = None
    liveliness: EventCallback | None = None
    message_lost: EventCallback | None = None
    incompatible_type: EventCallback | None = None
    matched: EventCallback | None = None
    use_default_callbacks: bool = True


@dataclass(kw_only=True)
class PublisherEventCallbacks:
    """What a publisher's user wants to hear of; each callback gets the information of that name."""

    deadline: EventCallback | None = None
    liveliness: EventCallback | None = None
    incompatible_qos: EventCallback | None = None
    incompatible_type: EventCallback | None = None
    matched: EventCallback | None = None
    use_default_callbacks: bool = True


class _Watch:
    """Calls something whenever a span of time passes without a sign."""

    def __init__(self, owner: EndpointEvents, limit: int, missed: Callable[[], None]) -> None:
        self._owner = owner
        self._limit_ns = limit
        self._missed = missed
        self._last_ns = 0
        self._alarm: Alarm | None = None

    def sign(self) -> None:
        """There is one: the time counts from now."""
        self._last_ns = self._owner.node.timebase.steady_ns()
        if self._alarm is None:
            self._arm()

    def stop(self) -> None:
        """Watch no longer; the next sign begins anew."""
        if self._alarm is not None:
            self._alarm.cancel()
            self._alarm = None

    def _arm(self) -> None:
        dispatcher = self._owner.dispatcher
        if dispatcher is not None:
            self._alarm = dispatcher.call_at(self._last_ns + self._limit_ns, self._look)

    def _look(self) -> None:
        self._alarm = None
        now_ns = self._owner.node.timebase.steady_ns()
        if now_ns >= self._last_ns + self._limit_ns:
            self._last_ns = now_ns
            self._missed()
        self._arm()


class EndpointEvents(Entity):
    """The events of one endpoint, which wait for their callbacks as messages do."""

    def __init__(self, node: Node, name: str, callback_group: CallbackGroup | None) -> None:
        super().__init__(node, callback_group)
        self._name = name
        self._waiting: deque[Callable[[], object]] = deque()
        self._totals: dict[str, int] = {}
        self._current = 0
        self._watches: list[_Watch] = []

    @property
    def what(self) -> str:
        """What it is, for messages."""
        return f"event callback of topic '{self._name}'"

    @property
    @abstractmethod
    def _matched_callback(self) -> EventCallback | None: ...

    @property
    @abstractmethod
    def _incompatible_callback(self) -> EventCallback | None: ...

    @property
    @abstractmethod
    def _is_quiet(self) -> bool: ...

    def matched(self, change: int) -> None:
        """Endpoints of the other side came or went."""
        self._current += change
        total = self._count("matched", max(change, 0))
        if self._matched_callback is not None:
            self._tell(self._matched_callback, QoSMatchedInfo(total, max(change, 0), self._current, change))

    def incompatible(self, policy: str) -> bool:
        """An endpoint of the other side does not go together with this one.

        Returns:
            Whether nothing else has to be said about it.
        """
        total = self._count("incompatible", 1)
        if self._incompatible_callback is None:
            return self._is_quiet
        kind = QoSPolicyKind[policy.removesuffix("_QOS_POLICY")]
        self._tell(self._incompatible_callback, QoSRequestedIncompatibleQoSInfo(total, 1, kind))
        return True

    def has_work(self) -> bool:
        """Whether events wait."""
        return bool(self._waiting)

    def take(self) -> Callable[[], object] | None:
        """The callback of the event that waits longest."""
        self._announced = False
        try:
            call = self._waiting.popleft()
        except IndexError:
            return None
        if self._waiting:
            self.announce()
        return call

    def retire(self) -> None:
        """Never call back again."""
        for watch in self._watches:
            watch.stop()
        super().retire()
        self._waiting.clear()

    def set_dispatcher(self, dispatcher: Dispatcher | None) -> None:
        """Have the callbacks run, and time watched, by a dispatcher."""
        for watch in self._watches:
            watch.stop()
        super().set_dispatcher(dispatcher)
        for watch in self._watches:
            watch.sign()

    def _count(self, what: str, change: int) -> int:
        self._totals[what] = total = self._totals.get(what, 0) + change
        return total

    def _tell(self, callback: EventCallback, info: object) -> None:
        if not self.destroyed:
            self._waiting.append(partial(callback, info))
            self.announce()


class SubscriptionEvents(EndpointEvents):
    """The events of a subscription."""

    def __init__(self, subscription: Subscription[Any], callbacks: SubscriptionEventCallbacks) -> None:
        super().__init__(subscription.node, subscription.name, subscription.callback_group)
        self._callbacks = callbacks
        self._alive = 0
        self._not_alive = 0
        deadline_ns = limit_ns(subscription.qos_profile.deadline)
        self._deadline: _Watch | None = None
        if deadline_ns is not None and callbacks.deadline is not None:
            self._deadline = _Watch(self, deadline_ns, self._deadline_missed)
            self._watches.append(self._deadline)

    @property
    def _matched_callback(self) -> EventCallback | None:
        return self._callbacks.matched

    @property
    def _incompatible_callback(self) -> EventCallback | None:
        return self._callbacks.incompatible_qos

    @property
    def _is_quiet(self) -> bool:
        return not self._callbacks.use_default_callbacks

    def received(self, full: bool) -> None:
        """A message came; `full` says that another one had to make room for it."""
        if self._deadline is not None:
            self._deadline.sign()
        if full:
            self.lost(1)

    def lost(self, count: int) -> None:
        """Messages were lost."""
        total = self._count("lost", count)
        if self._callbacks.message_lost is not None:
            self._tell(self._callbacks.message_lost, QoSMessageLostInfo(total, count))

    def matched(self, change: int) -> None:
        """Publishers came or went; those that are there live until they are said not to."""
        super().matched(change)
        self.liveliness(change, 0)

    def liveliness(self, alive_change: int, not_alive_change: int) -> None:
        """Publishers began or ceased to show that they live."""
        self._alive += alive_change
        self._not_alive += not_alive_change
        if self._callbacks.liveliness is not None:
            info = QoSLivelinessChangedInfo(self._alive, self._not_alive, alive_change, not_alive_change)
            self._tell(self._callbacks.liveliness, info)

    def _deadline_missed(self) -> None:
        if self._callbacks.deadline is not None:
            total = self._count("deadline", 1)
            self._tell(self._callbacks.deadline, QoSRequestedDeadlineMissedInfo(total, 1))


class PublisherEvents(EndpointEvents):
    """The events of a publisher."""

    def __init__(self, publisher: Publisher[Any], callbacks: PublisherEventCallbacks) -> None:
        super().__init__(publisher.node, publisher.name, publisher.callback_group)
        self._publisher = publisher
        self._callbacks = callbacks
        self._deadline: _Watch | None = None
        self._lease: _Watch | None = None
        self._is_alive = True
        deadline_ns = limit_ns(publisher.qos_profile.deadline)
        if deadline_ns is not None and callbacks.deadline is not None:
            self._deadline = _Watch(self, deadline_ns, self._deadline_missed)
            self._watches.append(self._deadline)
        lease_ns = limit_ns(publisher.qos_profile.liveliness_lease_duration)
        if publisher.is_manually_alive and lease_ns is not None:
            self._lease = _Watch(self, lease_ns, self._liveliness_lost)
            self._watches.append(self._lease)
        if self._watches:
            publisher.watch()

    @property
    def _matched_callback(self) -> EventCallback | None:
        return self._callbacks.matched

    @property
    def _incompatible_callback(self) -> EventCallback | None:
        return self._callbacks.incompatible_qos

    @property
    def _is_quiet(self) -> bool:
        return not self._callbacks.use_default_callbacks

    def published(self) -> None:
        """A message was published."""
        if self._deadline is not None:
            self._deadline.sign()
        self.assert_liveliness()

    def assert_liveliness(self) -> None:
        """The publisher showed that it lives."""
        if self._lease is not None:
            self._lease.sign()
            if not self._is_alive:
                self._is_alive = True
                self._tell_subscriptions(1)

    def _deadline_missed(self) -> None:
        if self._callbacks.deadline is not None:
            total = self._count("deadline", 1)
            self._tell(self._callbacks.deadline, QoSOfferedDeadlineMissedInfo(total, 1))

    def _liveliness_lost(self) -> None:
        if self._is_alive:
            self._is_alive = False
            self._tell_subscriptions(-1)
            total = self._count("liveliness", 1)
            if self._callbacks.liveliness is not None:
                self._tell(self._callbacks.liveliness, QoSLivelinessLostInfo(total, 1))

    def _tell_subscriptions(self, alive_change: int) -> None:
        for subscription in self._publisher.matched():
            if subscription.events is not None:
                subscription.events.liveliness(alive_change, -alive_change)
