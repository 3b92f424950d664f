"""Streams: groups of publishers of a topic that a single subscription can receive from."""

from __future__ import annotations

from typing import NamedTuple

from linkwright.graph.endpoints.base import EndpointInfo
from linkwright.graph.qos.compatibility import find_incompatible_policies
from linkwright.graph.qos.profile import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
)
from linkwright.messages import InterfaceNotFoundError, type_hash

HISTORY_DEPTH = 1000
"""The queue length for messages that must not be lost: messages for late joiners and of new publishers."""

_ASSUMED_DEPTH = 10
"""The depth of a publisher that does not announce its history, such as a publisher of Fast DDS."""


class Stream(NamedTuple):
    """A topic with a type and a quality of service.

    One subscription receives from all publishers of a stream.

    Attributes:
        name: the topic.
        type_name: the type of the topic.
        type_hash: the hash of the type; empty if hashes do not separate topics, so that a subscription receives all.
        reliability: the reliability that the publishers offer.
        durability: the durability that the publishers offer.
        history: the history that the publishers offer.
    """

    name: str
    type_name: str
    type_hash: str
    reliability: ReliabilityPolicy
    durability: DurabilityPolicy
    history: HistoryPolicy

    @property
    def has_history(self) -> bool:
        """Whether late joiners receive earlier messages."""
        return self.durability is DurabilityPolicy.TRANSIENT_LOCAL


def get_stream(publisher: EndpointInfo, *, is_keyed: bool) -> Stream:
    """Return the stream that a publisher is part of.

    Args:
        publisher: the publisher.
        is_keyed: whether topics are separated by the hash of their type, and endpoints are not separated by quality of
            service, as over Zenoh.
    """
    qos = make_offered_profile(publisher.qos)
    reliability = ReliabilityPolicy.RELIABLE if is_keyed else qos.reliability
    return _make_stream(publisher, reliability, qos.durability, qos.history, is_keyed=is_keyed)


def find_awaited_streams(subscription: EndpointInfo, *, is_keyed: bool) -> set[Stream]:
    """Return the streams of volatile publishers that may still appear and reach a subscription.

    Streams with history are subscribed to only after their publishers have appeared.

    Args:
        subscription: the subscription.
        is_keyed: see `get_stream`; if false, few subscriptions announce their history.
    """
    volatile, keep_last = DurabilityPolicy.VOLATILE, HistoryPolicy.KEEP_LAST
    reliable = ReliabilityPolicy.RELIABLE
    streams = {_make_stream(subscription, reliable, volatile, keep_last, is_keyed=is_keyed)}
    if is_keyed or subscription.qos.history is HistoryPolicy.KEEP_ALL:
        streams.add(_make_stream(subscription, reliable, volatile, HistoryPolicy.KEEP_ALL, is_keyed=is_keyed))
    if not is_keyed and subscription.qos.reliability is not reliable:
        streams.add(_make_stream(subscription, ReliabilityPolicy.BEST_EFFORT, volatile, keep_last, is_keyed=is_keyed))
    return streams


def can_receive(subscription: EndpointInfo, publisher: EndpointInfo, *, is_keyed: bool) -> bool:
    """Return whether a subscription can receive from the mirror of a topic's publisher.

    Args:
        subscription: the subscription, in the target network.
        publisher: the publisher in the source network, whose offered profile the mirror has.
        is_keyed: see `get_stream`, for the target network.
    """
    if subscription.type_name != publisher.type_name:
        return False
    if is_keyed:
        return len({find_type_hash(subscription), find_type_hash(publisher)} - {""}) <= 1
    return not find_incompatible_policies(make_offered_profile(publisher.qos), subscription.qos)


def find_type_hash(endpoint: EndpointInfo) -> str:
    """Return the hash of an endpoint's type, or an empty string if it is unknown.

    The hash is the announced hash, or the hash of the local definition.
    """
    return endpoint.type_hash or _find_local_hash(endpoint)


def _find_local_hash(endpoint: EndpointInfo) -> str:
    try:
        return type_hash(endpoint.type_name)
    except InterfaceNotFoundError:
        return ""


def _make_stream(
    endpoint: EndpointInfo,
    reliability: ReliabilityPolicy,
    durability: DurabilityPolicy,
    history: HistoryPolicy,
    *,
    is_keyed: bool,
) -> Stream:
    # An endpoint whose type is unknown here may not announce the hash, but still receives from publishers of its type.
    stream_hash = find_type_hash(endpoint) if is_keyed and _find_local_hash(endpoint) else ""
    return Stream(endpoint.name, endpoint.type_name, stream_hash, reliability, durability, history)


def make_offered_profile(qos: QoSProfile) -> QoSProfile:
    """Return the profile that a publisher offers.

    Values that discovery does not provide are ROS's defaults.
    """
    is_transient_local = qos.durability is DurabilityPolicy.TRANSIENT_LOCAL
    keeps_all = qos.history is HistoryPolicy.KEEP_ALL
    is_announced = qos.history in (HistoryPolicy.KEEP_LAST, HistoryPolicy.KEEP_ALL)
    is_best_effort = qos.reliability is ReliabilityPolicy.BEST_EFFORT
    is_manual = qos.liveliness is LivelinessPolicy.MANUAL_BY_TOPIC
    return QoSProfile(
        depth=qos.depth if is_announced else HISTORY_DEPTH if is_transient_local else _ASSUMED_DEPTH,
        history=HistoryPolicy.KEEP_ALL if keeps_all else HistoryPolicy.KEEP_LAST,
        reliability=ReliabilityPolicy.BEST_EFFORT if is_best_effort else ReliabilityPolicy.RELIABLE,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if is_transient_local else DurabilityPolicy.VOLATILE,
        deadline=qos.deadline,
        lifespan=qos.lifespan,
        liveliness=LivelinessPolicy.MANUAL_BY_TOPIC if is_manual else LivelinessPolicy.AUTOMATIC,
        liveliness_lease_duration=qos.liveliness_lease_duration,
    )
