"""Events of endpoints, as their callbacks receive them: mismatches, missed deadlines, lost messages, matches.

The containers of callbacks and what the callbacks are given have rclpy's names (``rclpy.event_handler``).
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
    """How often something happened.

    Attributes:
        total_count: since the beginning.
        total_count_change: since it was told last.
    """

    total_count: int
    total_count_change: int


class QoSRequestedDeadlineMissedInfo(EventCount):
    """How often no message came in time."""

    __slots__ = ()


class QoSOfferedDeadlineMissedInfo(EventCount):
    """How often no message was published in time."""

    __slots__ = ()


class QoSLivelinessLostInfo(EventCount):
    """How often a publisher did not show in time that it lives."""

    __slots__ = ()


class QoSMessageLostInfo(EventCount):
    """How many messages were lost."""

    __slots__ = ()


@dataclass(frozen=True, slots=True)
class QoSRequestedIncompatibleQoSInfo(EventCount):
    """How many endpoints of the other side are incompatible with this one, and the policy of the last."""

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
class QoSMatchedInfo(EventCount):
    """How many endpoints of the other side there were and are."""

    current_count: int
    current_count_change: int


QoSPublisherMatchedInfo = QoSMatchedInfo
QoSSubscriptionMatchedInfo = QoSMatchedInfo


class QoSPublisherEventType(IntEnum):
    """What a publisher can tell of; numbers and names are rcl's."""

    RCL_PUBLISHER_OFFERED_DEADLINE_MISSED = 0
    RCL_PUBLISHER_LIVELINESS_LOST = 1
    RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS = 2
    RCL_PUBLISHER_INCOMPATIBLE_TYPE = 3
    RCL_PUBLISHER_MATCHED = 4


class QoSSubscriptionEventType(IntEnum):
    """What a subscription can tell of; numbers and names are rcl's."""

    RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED = 0
    RCL_SUBSCRIPTION_LIVELINESS_CHANGED = 1
    RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS = 2
    RCL_SUBSCRIPTION_MESSAGE_LOST = 3
    RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE = 4
    RCL_SUBSCRIPTION_MATCHED = 5


class EventHandler(NamedTuple):
    """The handler of one kind of event.

    Attributes:
        event_type: the kind.
        callback: what is called; None where the event is only logged.
    """

    event_type: QoSPublisherEventType | QoSSubscriptionEventType
    callback: EventCallback | None


@dataclass(kw_only=True)
class EndpointEventCallbacks:
    """A user's callbacks for the events of a publisher or a subscription; each gets the information of its name.

    Attributes:
        deadline: nothing came, or nothing was published, in time.
        incompatible_qos: an endpoint of the other side asks for more than is offered, or offers less.
        liveliness: publishers began or ceased to show that they live; for a publisher, that it did not in time.
        incompatible_type: accepted as rclpy does; topics of different types are told of in the log.
        matched: endpoints of the other side came or went.
        use_default_callbacks: whether the log tells of an incompatible quality of service that has no callback.
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
        """The handlers: one for each kind of event that is listened for."""
        kinds = QoSPublisherEventType
        return _handlers(
            (kinds.RCL_PUBLISHER_OFFERED_DEADLINE_MISSED, self.deadline),
            (kinds.RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS, self.incompatible_qos),
            (kinds.RCL_PUBLISHER_LIVELINESS_LOST, self.liveliness),
            (kinds.RCL_PUBLISHER_MATCHED, self.matched),
            logged=kinds.RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS if self.use_default_callbacks else None,
        )


@dataclass(kw_only=True)
class SubscriptionEventCallbacks(EndpointEventCallbacks):
    """A user's callbacks for the events of a subscription.

    Attributes:
        message_lost: messages were lost on their way, or made room for later ones.
    """

    message_lost: EventCallback | None = None

    def handlers(self) -> list[EventHandler]:
        """The handlers: one for each kind of event that is listened for."""
        kinds = QoSSubscriptionEventType
        return _handlers(
            (kinds.RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED, self.deadline),
            (kinds.RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS, self.incompatible_qos),
            (kinds.RCL_SUBSCRIPTION_LIVELINESS_CHANGED, self.liveliness),
            (kinds.RCL_SUBSCRIPTION_MESSAGE_LOST, self.message_lost),
            (kinds.RCL_SUBSCRIPTION_MATCHED, self.matched),
            logged=kinds.RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS if self.use_default_callbacks else None,
        )


def _handlers(
    *wanted: tuple[QoSPublisherEventType | QoSSubscriptionEventType, EventCallback | None],
    logged: QoSPublisherEventType | QoSSubscriptionEventType | None,
) -> list[EventHandler]:
    return [EventHandler(kind, callback) for kind, callback in wanted if callback is not None or kind is logged]
