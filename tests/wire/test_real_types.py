"""Every type that nodes of real ROS 2 and ours have in common, value by value, both ways; see `test_real_ros`.

Both sides run one program, `typed_peer`: one with the real rclpy, one with ours.
"""

from __future__ import annotations

import os

import pytest

from linkwright.messages import interface_names, type_hash
from linkwright.standins.process import environment
from tests.wire.values import digest, large

PYTHON = os.environ.get("LINKWRIGHT_ROS_PYTHON", "")
SEEDS = 6
"""As constructed, the least and the most of everything, and three more."""
LARGE, LARGE_ONES = 8_000_000, 5
SIDES = [("theirs", "ours"), ("ours", "theirs")]
"""Who says or asks, and who hears or is asked."""
OWN_BUSINESS = "rmw_dds_common/"
"""Types of the transport, which others never see; ours are Humble's."""

pytestmark = pytest.mark.skipif(not PYTHON, reason="LINKWRIGHT_ROS_PYTHON names no interpreter with rclpy")


@pytest.fixture
def peers(programs, monkeypatch):
    """Starts the program on one side or the other, under the name of its side."""
    monkeypatch.setenv("ROS_DISTRO", "jazzy")  # whose forms of types are those of all later ones so far

    def start(side):
        if side == "theirs":
            return programs("typed_peer", side, python=PYTHON, RMW_IMPLEMENTATION="rmw_fastrtps_cpp")
        return programs("typed_peer", side, PYTHONPATH=environment()["PYTHONPATH"])

    return start


def common(kind, peer):
    """The types of a kind that the real side has, too."""
    names = [name for name in interface_names(kind) if not name.startswith(OWN_BUSINESS)]
    return peer.ask("knows", names)


@pytest.mark.parametrize(("says", "hears"), SIDES)
def test_messages_have_same_values_on_both_sides(peers, says, hears):
    both = {side: peers(side) for side in ("theirs", "ours")}
    types = common("msg", both["theirs"])
    assert {"test_msgs/msg/WStrings", "test_msgs/msg/BoundedSequences", "sensor_msgs/msg/PointCloud2"} <= set(types)
    for name in types:
        assert both["ours"].ask("fields", name) == both["theirs"].ask("fields", name)
    both[hears].ask("hear", types)
    both[says].ask("say", types, SEEDS)
    both[hears].ask_until(lambda counts: set(counts.values()) == {SEEDS}, "counts")
    for name in types:
        assert both[hears].ask("heard", name) == both["theirs"].ask("meant", name, SEEDS), name
    message = {name: both["theirs"].ask("hashes", name)[0] for name in types} if says == "ours" else {}
    assert [
        name for name, told_hash in message.items() if type_hash(name).removeprefix("RIHS01_") not in told_hash
    ] == []


@pytest.mark.parametrize(("asks", "answers"), SIDES)
def test_services_have_same_values_on_both_sides(peers, asks, answers):
    both = {side: peers(side) for side in ("theirs", "ours")}
    services = common("srv", both["theirs"])
    assert {"test_msgs/srv/Arrays", "test_msgs/srv/Empty", "nav_msgs/srv/GetPlan"} <= set(services)
    both[answers].ask("answer", services)
    for name in services:
        requests, responses = both["theirs"].ask("meant_by", name, SEEDS)
        assert both[asks].ask("ask", name, SEEDS) == responses, name
        assert both[answers].ask("asked", name) == requests, name


@pytest.mark.parametrize(("asks", "answers"), SIDES)
@pytest.mark.parametrize("action", ["test_msgs/action/NestedMessage", "test_msgs/action/Fibonacci"])
def test_actions_have_same_values_on_both_sides(peers, asks, answers, action):
    both = {side: peers(side) for side in ("theirs", "ours")}
    both[answers].ask("act", action)
    feedback, result, (goal, meant_feedback, meant_result) = both[asks].ask("send_goal", action)
    assert both[answers].ask("asked", action) == [goal]
    assert feedback == [meant_feedback]
    assert result == meant_result


@pytest.mark.parametrize(("says", "hears"), SIDES)
def test_arrays_of_eight_megabytes_arrive_complete(peers, says, hears):
    both = {side: peers(side) for side in ("theirs", "ours")}
    both[hears].ask("hear_large", "/large")
    both[says].ask_until(lambda count: count == 1, "said_to", "/large")
    # A reader of Cyclone misses what a writer of Fast DDS says in the first moments that it knows it.
    while not both[hears].ask("heard_large"):
        both[says].ask("say_large", "/large", LARGE_ONES, 1)
    for number in range(LARGE_ONES):
        both[says].ask("say_large", "/large", number, LARGE)
        both[hears].ask_until(lambda heard, number=number: heard[-1][0] == number, "heard_large")
    samples = [sample for sample in both[hears].ask("heard_large") if sample[0] < LARGE_ONES]
    assert samples == [[number, LARGE, digest(large(number, LARGE))] for number in range(LARGE_ONES)]
