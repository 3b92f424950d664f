"""Actions, managed nodes and parameter events with nodes of real ROS 2 on Fast DDS; see `test_real_ros`.

Both sides run one program, `managed_peer`: one with the real rclpy, one with ours.
"""

from __future__ import annotations

import os
from itertools import pairwise

import pytest

from linkwright.standins.process import environment
from tests.waiting import wait_until
from tests.wire.programs import linkwright

PYTHON = os.environ.get("LINKWRIGHT_ROS_PYTHON", "")
GOALS = 100
SIDES = [("theirs", "ours"), ("ours", "theirs")]
"""Who asks, and who is asked."""

pytestmark = pytest.mark.skipif(not PYTHON, reason="LINKWRIGHT_ROS_PYTHON names no interpreter with rclpy")


@pytest.fixture
def peers(programs):
    """Starts the program on one side or the other, under the name of its side."""

    def start(side):
        if side == "theirs":
            return programs("managed_peer", side, python=PYTHON, RMW_IMPLEMENTATION="rmw_fastrtps_cpp")
        return programs("managed_peer", side, PYTHONPATH=environment()["PYTHONPATH"])

    return start


@pytest.mark.parametrize(("asking", "asked"), SIDES)
@pytest.mark.parametrize("server_is_first", [True, False])
def test_goal_is_executed_with_feedback(peers, asking, asked, server_is_first):
    first, second = (asked, asking) if server_is_first else (asking, asked)
    both = {first: peers(first), second: peers(second)}
    message = both[asking].ask("act", f"/{asked}/fibonacci", 5)
    assert (message["accepted"], message["status"], message["sequence"]) == (True, "SUCCEEDED", [0, 1, 1, 2, 3, 5])


@pytest.mark.parametrize(("asking", "asked"), SIDES)
def test_goals_are_rejected_aborted_and_canceled(peers, asking, asked):
    peers(asked)
    asks = peers(asking)
    action = f"/{asked}/fibonacci"
    assert asks.ask("act", action, -1) == {"accepted": False}
    assert asks.ask("act", action, 0)["status"] == "ABORTED"
    message = asks.ask("act", action, 500, 3)
    assert message["status"] == "CANCELED"
    assert 4 < len(message["sequence"]) < 500
    assert message["feedback"][0] == [0, 1, 1]


@pytest.mark.parametrize(("asking", "asked"), SIDES)
def test_simultaneous_goals_get_their_own_results(peers, asking, asked):
    peers(asked)
    assert peers(asking).ask("acts_are_right", f"/{asked}/fibonacci", GOALS) == GOALS


@pytest.mark.parametrize(("asking", "asked"), SIDES)
def test_managed_node_changes_states(peers, asking, asked):
    answers, asks = peers(asked), peers(asking)
    asks.ask("watch", asked)
    for peer in (asks, answers):
        peer.ask_until(lambda known: known == [1, 1], "ends_of", f"/{asked}/transition_event")
    assert asks.ask("state", asked) == "unconfigured"
    assert asks.ask("possible", asked) == ["configure", "shutdown"]
    for transition, state in (("configure", "inactive"), ("activate", "active"), ("deactivate", "inactive")):
        assert asks.ask("change", asked, transition) is True
        assert asks.ask("state", asked) == state
    assert asks.ask("change", asked, "activate") is True
    assert asks.ask("change", asked, "configure") is False
    states = ["unconfigured", "configuring", "inactive", "activating", "active", "deactivating", "inactive"]
    states += ["activating", "active"]
    steps = [[asked, *step] for step in pairwise(states)]
    assert asks.ask_until(lambda seen: len(seen) >= len(steps), "changes_seen") == steps


@pytest.mark.parametrize(("asking", "asked"), SIDES)
def test_parameter_events_are_received(peers, asking, asked):
    hears, tells = peers(asking), peers(asked)
    for peer in (hears, tells):
        peer.ask_until(lambda known: known == [2, 2], "ends_of", "/parameter_events")
    tells.ask("declare", "speed", 1.5)
    tells.ask("set", "speed", 2.5)
    events = hears.ask_until(lambda events: len(events) >= 2, "events_of", asked, "speed")
    assert events == [["new", "speed", 1.5], ["changed", "speed", 2.5]]


def test_verbs_use_actions_and_lifecycle_of_real_node(peers):
    peers("theirs")
    out, err, status = linkwright(
        "action", "send_goal", "--feedback", "/theirs/fibonacci", "test_msgs/action/Fibonacci", "{order: 3}"
    )
    assert "Goal finished with status: SUCCEEDED" in out
    assert (err, status) == ("", 0)
    # A verb that lists does not wait long for nodes that a busy machine has not let speak yet.
    wait_until(lambda: linkwright("action", "list")[0] == "/theirs/fibonacci\n")
    wait_until(lambda: "    /theirs\n" in linkwright("action", "info", "/theirs/fibonacci")[0])
    wait_until(lambda: linkwright("lifecycle", "nodes")[0] == "/theirs\n")
    assert linkwright("lifecycle", "get", "/theirs") == ("unconfigured [1]\n", "", 0)
    assert linkwright("lifecycle", "set", "/theirs", "configure") == ("Transitioning successful\n", "", 0)
    assert linkwright("lifecycle", "get", "/theirs") == ("inactive [2]\n", "", 0)
