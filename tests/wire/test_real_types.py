"""All types that real ROS 2 and Linkwright have in common, in both directions.

The values are compared one by one. See `test_real_ros`.

Both sides run one program, `typed_peer`: one with the real rclpy, one with ours.
"""

from __future__ import annotations

import os

import pytest

from linkwright.messages import interface_names, type_hash
from linkwright.standins.process import create_environment
from tests.wire.values import make_bytes, sha256_of

PYTHON = os.environ.get("LINKWRIGHT_ROS_PYTHON", "")
SEED_COUNT = 6
"""The number of seeds: default, minimum and maximum values, and three random ones."""
LARGE_BYTES, LARGE_MESSAGE_COUNT = 8_000_000, 5
SIDES = [("theirs", "ours"), ("ours", "theirs")]
"""The side of the publisher or client, and the side of the subscription or server."""
INTERNAL_TYPES = "rmw_dds_common/"
"""Types that only the transport uses; Linkwright's are those of Humble."""

pytestmark = pytest.mark.skipif(not PYTHON, reason="LINKWRIGHT_ROS_PYTHON names no interpreter with rclpy")


@pytest.fixture
def start_peer(programs, monkeypatch):
    """Return a function that starts the program on a side.

    The side's name is the node's name.
    """
    monkeypatch.setenv("ROS_DISTRO", "jazzy")  # all later distributions have the same form of types so far

    def start(side):
        if side == "theirs":
            return programs("typed_peer", side, python=PYTHON, RMW_IMPLEMENTATION="rmw_fastrtps_cpp")
        return programs("typed_peer", side, PYTHONPATH=create_environment()["PYTHONPATH"])

    return start


def find_common_types(kind, peer):
    """Return the types of a kind that the real side has, too."""
    names = [name for name in interface_names(kind) if not name.startswith(INTERNAL_TYPES)]
    return peer.ask("available_types", names)


@pytest.mark.parametrize(("publisher_side", "subscriber_side"), SIDES)
def test_messages_have_same_values_on_both_sides(start_peer, publisher_side, subscriber_side):
    peers_by_side = {side: start_peer(side) for side in ("theirs", "ours")}
    types = find_common_types("msg", peers_by_side["theirs"])
    assert {"test_msgs/msg/WStrings", "test_msgs/msg/BoundedSequences", "sensor_msgs/msg/PointCloud2"} <= set(types)
    for name in types:
        assert peers_by_side["ours"].ask("fields", name) == peers_by_side["theirs"].ask("fields", name)
    peers_by_side[subscriber_side].ask("subscribe", types)
    peers_by_side[publisher_side].ask("publish", types, SEED_COUNT)
    peers_by_side[subscriber_side].ask_until(lambda counts: set(counts.values()) == {SEED_COUNT}, "counts")
    for name in types:
        assert peers_by_side[subscriber_side].ask("received", name) == peers_by_side["theirs"].ask(
            "expected", name, SEED_COUNT
        ), name
    hashes = (
        {name: peers_by_side["theirs"].ask("hashes", name)[0] for name in types} if publisher_side == "ours" else {}
    )
    assert [
        name for name, announced_hash in hashes.items() if type_hash(name).removeprefix("RIHS01_") not in announced_hash
    ] == []


@pytest.mark.parametrize(("client_side", "server_side"), SIDES)
def test_services_have_same_values_on_both_sides(start_peer, client_side, server_side):
    peers_by_side = {side: start_peer(side) for side in ("theirs", "ours")}
    services = find_common_types("srv", peers_by_side["theirs"])
    assert {"test_msgs/srv/Arrays", "test_msgs/srv/Empty", "nav_msgs/srv/GetPlan"} <= set(services)
    peers_by_side[server_side].ask("serve", services)
    for name in services:
        requests, responses = peers_by_side["theirs"].ask("expected_calls", name, SEED_COUNT)
        assert peers_by_side[client_side].ask("call", name, SEED_COUNT) == responses, name
        assert peers_by_side[server_side].ask("requests", name) == requests, name


@pytest.mark.parametrize(("client_side", "server_side"), SIDES)
@pytest.mark.parametrize("action", ["test_msgs/action/NestedMessage", "test_msgs/action/Fibonacci"])
def test_actions_have_same_values_on_both_sides(start_peer, client_side, server_side, action):
    peers_by_side = {side: start_peer(side) for side in ("theirs", "ours")}
    peers_by_side[server_side].ask("serve_action", action)
    feedback, result, (goal, meant_feedback, meant_result) = peers_by_side[client_side].ask("send_goal", action)
    assert peers_by_side[server_side].ask("requests", action) == [goal]
    assert feedback == [meant_feedback]
    assert result == meant_result


@pytest.mark.parametrize(("publisher_side", "subscriber_side"), SIDES)
def test_arrays_of_eight_megabytes_arrive_complete(start_peer, publisher_side, subscriber_side):
    peers_by_side = {side: start_peer(side) for side in ("theirs", "ours")}
    peers_by_side[subscriber_side].ask("subscribe_large", "/large")
    peers_by_side[publisher_side].ask_until(lambda count: count == 1, "subscription_count", "/large")
    # A reader of Cyclone misses samples that a writer of Fast DDS sends directly after the discovery.
    while not peers_by_side[subscriber_side].ask("received_large"):
        peers_by_side[publisher_side].ask("publish_large", "/large", LARGE_MESSAGE_COUNT, 1)
    for number in range(LARGE_MESSAGE_COUNT):
        peers_by_side[publisher_side].ask("publish_large", "/large", number, LARGE_BYTES)
        peers_by_side[subscriber_side].ask_until(
            lambda images, number=number: images[-1][0] == number, "received_large"
        )
    samples = [
        sample for sample in peers_by_side[subscriber_side].ask("received_large") if sample[0] < LARGE_MESSAGE_COUNT
    ]
    assert samples == [
        [number, LARGE_BYTES, sha256_of(make_bytes(number, LARGE_BYTES))] for number in range(LARGE_MESSAGE_COUNT)
    ]
