"""All QoS profiles between nodes of real ROS 2 on Fast DDS and of Linkwright.

The tests also cover their events. See `test_real_ros`.

Both sides run one program, `qos_peer`: one with the real rclpy, one with ours.
"""

from __future__ import annotations

import os
from functools import partial
from itertools import product

import pytest

from linkwright.graph.qos.profile import QoSPolicyKind
from linkwright.standins.process import create_environment

PYTHON = os.environ.get("LINKWRIGHT_ROS_PYTHON", "")
SIDES = [("theirs", "ours"), ("ours", "theirs")]
"""The side of the publisher, and the side of the subscription."""
SENSOR_DATA = {"preset": "sensor_data"}
LATCHED = {"durability": "transient_local", "depth": 1}
LIVELY = {"lease": 1.0}
PROFILES = {
    "reliable": {},
    "best effort": SENSOR_DATA,
    "lasting": {"durability": "transient_local"},
    "lasting, best effort": {"durability": "transient_local", "reliability": "best_effort"},
    "often": {"deadline": 60.0},
    "seldom": {"deadline": 300.0},
    "by hand": {"liveliness": "manual_by_topic", "lease": 300.0},
    "lively": {"lease": 600.0},
}
SERVED_BY = {
    "reliable": PROFILES.keys() - {"best effort", "lasting, best effort"},
    "best effort": PROFILES.keys(),
    "lasting": {"lasting"},
    "lasting, best effort": {"lasting", "lasting, best effort"},
    "often": {"often"},
    "seldom": {"often", "seldom"},
    "by hand": {"by hand"},
    "lively": {"by hand", "lively"},
}
"""The indices of the offered profiles that match each requested profile."""

pytestmark = pytest.mark.skipif(not PYTHON, reason="LINKWRIGHT_ROS_PYTHON names no interpreter with rclpy")


@pytest.fixture
def start_peer(programs, monkeypatch):
    """Return a function that starts the program on a side.

    The side's name is the node's name.
    """
    monkeypatch.setenv("ROS_DISTRO", "jazzy")  # rclpy's module of events has had its name since Iron

    def start(side):
        if side == "theirs":
            return programs("qos_peer", side, python=PYTHON, RMW_IMPLEMENTATION="rmw_fastrtps_cpp")
        return programs("qos_peer", side, PYTHONPATH=create_environment()["PYTHONPATH"])

    return start


@pytest.mark.parametrize(("publisher_side", "subscriber_side"), SIDES)
@pytest.mark.parametrize(
    ("offered", "requested", "policy"),
    [
        ({"reliability": "best_effort"}, {}, QoSPolicyKind.RELIABILITY),
        ({}, {"durability": "transient_local"}, QoSPolicyKind.DURABILITY),
        ({}, {"deadline": 0.5}, QoSPolicyKind.DEADLINE),
        ({"deadline": 1.0}, {"deadline": 0.5}, QoSPolicyKind.DEADLINE),
        ({}, {"liveliness": "manual_by_topic"}, QoSPolicyKind.LIVELINESS),
    ],
    ids=lambda value: str(getattr(value, "name", value)),
)
def test_incompatible_qos_is_reported_on_both_sides(
    start_peer, publisher_side, subscriber_side, offered, requested, policy
):
    publishes, subscribes = start_peer(publisher_side), start_peer(subscriber_side)
    publishes.ask("publisher", "/topic", offered)
    subscribes.ask("subscription", "/topic", requested)
    for peer in (publishes, subscribes):
        assert peer.ask_until(bool, "events", "/topic") == [["incompatible", int(policy)]]


@pytest.mark.parametrize(("publisher_side", "subscriber_side"), SIDES)
def test_only_compatible_qos_profiles_match(start_peer, publisher_side, subscriber_side):
    publishes, subscribes = start_peer(publisher_side), start_peer(subscriber_side)
    fits = {}
    for number, (offered, requested) in enumerate(product(PROFILES, PROFILES)):
        topic = f"/topic_{number}"
        fits[topic] = offered in SERVED_BY[requested]
        publishes.ask("publisher", topic, PROFILES[offered])
        subscribes.ask("subscription", topic, PROFILES[requested])
    publishes.ask_until(
        lambda counts: counts == {topic: int(fit) for topic, fit in fits.items()}, "subscription_counts"
    )
    for topic in fits:
        publishes.ask("keep_publishing", topic, 1.0)
    for topic, fit in fits.items():
        for peer in (publishes, subscribes):
            answer = peer.ask_until(partial(has_event, "matched" if fit else "incompatible"), "events", topic)
            assert not has_event("incompatible" if fit else "matched", answer)
    for topic, fit in fits.items():
        if fit:
            subscribes.ask_until(bool, "received", topic)
    assert [topic for topic, fit in fits.items() if not fit and subscribes.ask("received", topic)] == []


def has_event(kind, events):
    """Return whether an endpoint's events have one of a kind."""
    return kind in [event for event, *_ in events]


@pytest.mark.parametrize(("publisher_side", "subscriber_side"), SIDES)
def test_best_available_qos_always_matches(start_peer, publisher_side, subscriber_side):
    publishes, subscribes = start_peer(publisher_side), start_peer(subscriber_side)
    for number, offered in enumerate(({}, SENSOR_DATA, LATCHED, LIVELY)):
        publishes.ask("publisher", f"/topic_{number}", offered)
        publishes.ask("publish", f"/topic_{number}", "before")
    subscribes.ask("subscription", "/asks", LATCHED)
    for number in range(4):
        # The best available profile depends on the publishers that are known at this time.
        subscribes.ask_until(lambda count: count == 1, "publisher_count", f"/topic_{number}")
        subscribes.ask("subscription", f"/topic_{number}", {"preset": "best_available"})
    publishes.ask_until(lambda counts: set(counts.values()) == {1}, "subscription_counts")
    publishes.ask("publisher", "/asks", {"preset": "best_available"})
    publishes.ask_until(lambda counts: counts["/asks"] == 1, "subscription_counts")


@pytest.mark.parametrize(("publisher_side", "subscriber_side"), SIDES)
def test_missed_deadline_is_reported_on_both_sides(start_peer, publisher_side, subscriber_side):
    """A missed deadline is reported on both sides.

    A deadline begins with the first message, and is not missed while messages arrive in time.
    """
    publishes, subscribes = start_peer(publisher_side), start_peer(subscriber_side)
    for topic in ("/topic", "/silent"):
        publishes.ask("publisher", topic, {"deadline": 2.0})
        subscribes.ask("subscription", topic, {"deadline": 3.0})
    publishes.ask_until(lambda counts: set(counts.values()) == {1}, "subscription_counts")
    publishes.ask("keep_publishing", "/topic", 0.1)
    subscribes.ask_until(lambda texts: len(texts) > 40, "received", "/topic")
    for peer in (publishes, subscribes):
        assert count_missed_deadlines(peer, "/topic") == 0
    publishes.ask("stop_publishing", "/topic")
    for peer in (publishes, subscribes):
        peer.ask_until(lambda events: [kind for kind, *_ in events].count("deadline") >= 2, "events", "/topic")
        assert count_missed_deadlines(peer, "/silent") == 0


def count_missed_deadlines(peer, topic):
    """Return the number of missed deadlines that a side reported."""
    return [kind for kind, *_ in peer.ask("events", topic)].count("deadline")


@pytest.mark.parametrize(("publisher_side", "subscriber_side"), SIDES)
def test_liveliness_is_lost_and_regained(start_peer, publisher_side, subscriber_side):
    """The liveliness is asserted manually, and then expires."""
    publishes, subscribes = start_peer(publisher_side), start_peer(subscriber_side)
    by_hand = {"liveliness": "manual_by_topic", "lease": 1.0}
    publishes.ask("publisher", "/topic", by_hand)
    subscribes.ask("subscription", "/topic", by_hand)
    publishes.ask_until(lambda counts: counts["/topic"] == 1, "subscription_counts")
    publishes.ask("assert_liveliness", "/topic")
    subscribes.ask_until(lambda events: ["alive", 1, 0] in events, "events", "/topic")
    subscribes.ask_until(lambda events: ["alive", 0, 1] in events, "events", "/topic")
    publishes.ask_until(lambda events: "lost" in [kind for kind, *_ in events], "events", "/topic")
    publishes.ask("publish", "/topic", "still here")
    subscribes.ask_until(lambda events: events.count(["alive", 1, 0]) >= 2, "events", "/topic")


@pytest.mark.parametrize(("publisher_side", "subscriber_side"), SIDES)
def test_killed_publisher_loses_liveliness(start_peer, publisher_side, subscriber_side):
    publishes, subscribes = start_peer(publisher_side), start_peer(subscriber_side)
    publishes.ask("publisher", "/topic", LIVELY)
    subscribes.ask("subscription", "/topic", LIVELY)
    subscribes.ask_until(lambda text: ["alive", 1, 0] in text, "events", "/topic")
    publishes.kill()
    subscribes.ask_until(lambda text: text[-1][:2] == ["alive", 0] or ["alive", 0, 1] in text, "events", "/topic")
    subscribes.ask_until(lambda text: ["matched", 0] in text, "events", "/topic")


@pytest.mark.parametrize(("publisher_side", "subscriber_side"), SIDES)
def test_message_beyond_its_lifespan_is_not_delivered(start_peer, publisher_side, subscriber_side):
    publishes = start_peer(publisher_side)
    for topic, lifespan in (("/short", 0.5), ("/long", 300.0)):
        publishes.ask("publisher", topic, {"durability": "transient_local", "lifespan": lifespan})
        publishes.ask("publish", topic, "old")
    publishes.ask("publisher", "/clock", {})
    publishes.ask("keep_publishing", "/clock", 0.1)
    subscribes = start_peer(subscriber_side)  # its start takes longer than the short lifespan
    subscribes.ask("subscription", "/clock", {})
    subscribes.ask_until(lambda texts: len(texts) > 10, "received", "/clock")
    for topic in ("/short", "/long"):
        subscribes.ask("subscription", topic, {"durability": "transient_local"})
    assert subscribes.ask_until(bool, "received", "/long") == ["old"]
    publishes.ask("publish", "/short", "new")
    assert subscribes.ask_until(bool, "received", "/short") == ["new"]
