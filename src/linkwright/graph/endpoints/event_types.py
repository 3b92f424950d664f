"""QoS events as callbacks receive them, with the class names of ``rclpy.event_handler``.

The events are incompatible QoS, missed deadlines, liveliness, lost messages and matches.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from typing import Any, NamedTuple

from linkwright.graph.qos.profile import QoSPolicyKind

EventCallback = Callable[[Any], object]


@dataclass(frozen=True, slots=True)
class EventCount:
    """The number of times that an event has occurred.

    Attributes:
        total_count: the count since the endpoint was created.
        total_count_change: the count since the last callback.
    """

    total_count: int
    total_count_change: int


class QoSRequestedDeadlineMissedInfo(EventCount):
    """The number of times that no message was received within the deadline."""

    __slots__ = ()


class QoSOfferedDeadlineMissedInfo(EventCount):
    """The number of times that no message was published within the deadline."""

    __slots__ = ()


class QoSLivelinessLostInfo(EventCount):
    """The number of times that a publisher failed to assert its liveliness within the lease."""

    __slots__ = ()


class QoSMessageLostInfo(EventCount):
    """The number of lost messages."""

    __slots__ = ()


@dataclass(frozen=True, slots=True)
class QoSRequestedIncompatibleQoSInfo(EventCount):
    """The number of endpoints with incompatible QoS, and the policy that was incompatible last."""

    last_policy_kind: QoSPolicyKind


QoSOfferedIncompatibleQoSInfo = QoSRequestedIncompatibleQoSInfo


@dataclass(frozen=True, slots=True)
class QoSLivelinessChangedInfo:
    """The numbers of publishers that are alive and not alive."""

    alive_count: int
    not_alive_count: int
    alive_count_change: int
    not_alive_count_change: int


@dataclass(frozen=True, slots=True)
class QoSMatchedInfo(EventCount):
    """The numbers of endpoints that have matched in total and that match now."""

    current_count: int
    current_count_change: int


QoSPublisherMatchedInfo = QoSMatchedInfo
QoSSubscriptionMatchedInfo = QoSMatchedInfo


class QoSPublisherEventType(IntEnum):
    """The kinds of publisher events, with the numbers and names of rcl."""

    RCL_PUBLISHER_OFFERED_DEADLINE_MISSED = 0
    RCL_PUBLISHER_LIVELINESS_LOST = 1
    RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS = 2
    RCL_PUBLISHER_INCOMPATIBLE_TYPE = 3
    RCL_PUBLISHER_MATCHED = 4


class QoSSubscriptionEventType(IntEnum):
    """The kinds of subscription events, with the numbers and names of rcl."""

    RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED = 0
    RCL_SUBSCRIPTION_LIVELINESS_CHANGED = 1
    RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS = 2
    RCL_SUBSCRIPTION_MESSAGE_LOST = 3
    RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE = 4
    RCL_SUBSCRIPTION_MATCHED = 5


class EventHandler(NamedTuple):
    """The handler of one kind of event.

    Attributes:
        event_type: the kind of event.
        callback: the callback; None if the event is only logged.
    """

    event_type: QoSPublisherEventType | QoSSubscriptionEventType
    callback: EventCallback | None


@dataclass(kw_only=True)
class EndpointEventCallbacks:
    """A user's callbacks for the events of a publisher or a subscription.

    Each callback receives the info object of its event.

    Attributes:
        deadline: called when no message was received, or published, within the deadline.
        incompatible_qos: called when an endpoint with incompatible QoS is found: a subscription that requests more than
            this publisher offers, or a publisher that offers less than this subscription requests.
        liveliness: called when publishers became alive or lost their liveliness; for a publisher, when it lost its own.
        incompatible_type: accepted as in rclpy but never called; topics with several types are reported in the log.
        matched: called when the number of matching endpoints changed.
        use_default_callbacks: whether incompatible QoS is logged if there is no callback for it.
    """

    deadline: EventCallback | None = None
    incompatible_qos: EventCallback | None = None
    liveliness: EventCallback | None = None
    incompatible_type: EventCallback | None = None
    matched: EventCallback | None = None
    use_default_callbacks: bool = True


class PublisherEventCallbacks(EndpointEventCallbacks):
    """A user's callbacks for the events of a publisher."""

    def handlers(self) -> list[EventHandler]:
        """Return one handler for each kind of event that is monitored."""
        kinds = QoSPublisherEventType
        return _make_handlers(
            (kinds.RCL_PUBLISHER_OFFERED_DEADLINE_MISSED, self.deadline),
            (kinds.RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS, self.incompatible_qos),
            (kinds.RCL_PUBLISHER_LIVELINESS_LOST, self.liveliness),
            (kinds.RCL_PUBLISHER_MATCHED, self.matched),
            logged_event=kinds.RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS if self.use_default_callbacks else None,
        )


@dataclass(kw_only=True)
class SubscriptionEventCallbacks(EndpointEventCallbacks):
    """A user's callbacks for the events of a subscription.

    Attributes:
        message_lost: called when messages were lost on the network, or dropped from the full queue.
    """

    message_lost: EventCallback | None = None

    def handlers(self) -> list[EventHandler]:
        """Return one handler for each kind of event that is monitored."""
        kinds = QoSSubscriptionEventType
        return _make_handlers(
            (kinds.RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED, self.deadline),
            (kinds.RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS, self.incompatible_qos),
            (kinds.RCL_SUBSCRIPTION_LIVELINESS_CHANGED, self.liveliness),
            (kinds.RCL_SUBSCRIPTION_MESSAGE_LOST, self.message_lost),
            (kinds.RCL_SUBSCRIPTION_MATCHED, self.matched),
            logged_event=kinds.RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS if self.use_default_callbacks else None,
        )


def _make_handlers(
    *candidates: tuple[QoSPublisherEventType | QoSSubscriptionEventType, EventCallback | None],
    logged_event: QoSPublisherEventType | QoSSubscriptionEventType | None,
) -> list[EventHandler]:
    return [
        EventHandler(event_type, callback)
        for event_type, callback in candidates
        if callback is not None or event_type is logged_event
    ]
