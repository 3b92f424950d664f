"""The streams of messages: which one a subscription awaits, and which ones it can receive."""

from __future__ import annotations

import pytest

from linkwright.bridge.streams import can_receive, find_awaited_streams, get_stream
from linkwright.graph.endpoints.base import EndpointInfo, EndpointKind
from linkwright.graph.names.rules import NodeIdentity
from linkwright.graph.qos.profile import QoSProfile, ReliabilityPolicy
from linkwright.messages import type_hash

OTHER_HASH = f"RIHS01_{0:064x}"


BEST_EFFORT = QoSProfile(10, reliability=ReliabilityPolicy.BEST_EFFORT)


def endpoint(kind: EndpointKind, type_name: str, hashed: str, qos: QoSProfile | None = None) -> EndpointInfo:
    return EndpointInfo(kind, NodeIdentity("node", "/"), "/topic", type_name, qos or QoSProfile(10), bytes(16), hashed)


@pytest.mark.parametrize("message", ["", OTHER_HASH], ids=["told no hash", "told its hash"])
@pytest.mark.parametrize("type_name", ["std_msgs/msg/String", "strange_msgs/msg/Odd"])
def test_subscription_awaits_the_stream_that_its_publisher_uses(type_name, message):
    """Otherwise its first messages would be lost while the bridge listens to another stream."""
    hashed = type_hash(type_name) if type_name.startswith("std_msgs") else OTHER_HASH
    publisher = endpoint(EndpointKind.PUBLISHER, type_name, hashed)
    subscription = endpoint(EndpointKind.SUBSCRIPTION, type_name, message and hashed)
    assert get_stream(publisher, is_keyed=True) in find_awaited_streams(subscription, is_keyed=True)


def test_type_hash_distinguishes_streams_only_when_keyed():
    linkwright_endpoint, other_endpoint = (
        endpoint(EndpointKind.PUBLISHER, "std_msgs/msg/String", type_hash) for type_hash in ("", OTHER_HASH)
    )
    assert get_stream(linkwright_endpoint, is_keyed=True) != get_stream(other_endpoint, is_keyed=True)
    assert get_stream(linkwright_endpoint, is_keyed=False) == get_stream(other_endpoint, is_keyed=False)


@pytest.mark.parametrize(
    ("type_name", "hashed", "qos", "over_dds", "over_zenoh"),
    [
        ("std_msgs/msg/String", "", None, True, True),
        ("std_msgs/msg/Bool", "", None, False, False),
        ("std_msgs/msg/String", OTHER_HASH, None, True, False),
        ("std_msgs/msg/String", "", BEST_EFFORT, False, True),
    ],
    ids=["alike", "another type", "another hash", "less reliable"],
)
def test_can_receive_depends_on_type_hash_and_reliability(type_name, hashed, qos, over_dds, over_zenoh):
    subscription = endpoint(EndpointKind.SUBSCRIPTION, "std_msgs/msg/String", "")
    publisher = endpoint(EndpointKind.PUBLISHER, type_name, hashed, qos)
    assert can_receive(subscription, publisher, is_keyed=False) == over_dds
    assert can_receive(subscription, publisher, is_keyed=True) == over_zenoh
