"""Actions, managed nodes and parameter events with nodes of real ROS 2 on Fast DDS.

See `test_real_ros`.

Both sides run one program, `managed_peer`: one with the real rclpy, one with ours.
"""

from __future__ import annotations

import os
from itertools import pairwise

import pytest

from linkwright.standins.process import create_environment
from tests.waiting import wait_until
from tests.wire.programs import linkwright

PYTHON = os.environ.get("LINKWRIGHT_ROS_PYTHON", "")
GOAL_COUNT = 100
SIDES = [("theirs", "ours"), ("ours", "theirs")]
"""The side of the client, and the side of the server."""

pytestmark = pytest.mark.skipif(not PYTHON, reason="LINKWRIGHT_ROS_PYTHON names no interpreter with rclpy")


@pytest.fixture
def start_peer(programs):
    """Return a function that starts the program on a side.

    The side's name is the node's name.
    """

    def start(side):
        if side == "theirs":
            return programs("managed_peer", side, python=PYTHON, RMW_IMPLEMENTATION="rmw_fastrtps_cpp")
        return programs("managed_peer", side, PYTHONPATH=create_environment()["PYTHONPATH"])

    return start


@pytest.mark.parametrize(("client_side", "server_side"), SIDES)
@pytest.mark.parametrize("server_is_first", [True, False])
def test_goal_is_executed_with_feedback(start_peer, client_side, server_side, server_is_first):
    first, second = (server_side, client_side) if server_is_first else (client_side, server_side)
    peers_by_side = {first: start_peer(first), second: start_peer(second)}
    message = peers_by_side[client_side].ask("send_goal", f"/{server_side}/fibonacci", 5)
    assert (message["accepted"], message["status"], message["sequence"]) == (True, "SUCCEEDED", [0, 1, 1, 2, 3, 5])


@pytest.mark.parametrize(("client_side", "server_side"), SIDES)
def test_goals_are_rejected_aborted_and_canceled(start_peer, client_side, server_side):
    start_peer(server_side)
    client = start_peer(client_side)
    action = f"/{server_side}/fibonacci"
    assert client.ask("send_goal", action, -1) == {"accepted": False}
    assert client.ask("send_goal", action, 0)["status"] == "ABORTED"
    message = client.ask("send_goal", action, 500, 3)
    assert message["status"] == "CANCELED"
    assert 4 < len(message["sequence"]) < 500
    assert message["feedback"][0] == [0, 1, 1]


@pytest.mark.parametrize(("client_side", "server_side"), SIDES)
def test_simultaneous_goals_get_their_own_results(start_peer, client_side, server_side):
    start_peer(server_side)
    assert start_peer(client_side).ask("count_correct_goals", f"/{server_side}/fibonacci", GOAL_COUNT) == GOAL_COUNT


@pytest.mark.parametrize(("client_side", "server_side"), SIDES)
def test_managed_node_changes_states(start_peer, client_side, server_side):
    server, client = start_peer(server_side), start_peer(client_side)
    client.ask("watch", server_side)
    for peer in (client, server):
        peer.ask_until(lambda counts: counts == [1, 1], "endpoint_counts", f"/{server_side}/transition_event")
    assert client.ask("state", server_side) == "unconfigured"
    assert client.ask("available_transitions", server_side) == ["configure", "shutdown"]
    for transition, state in (("configure", "inactive"), ("activate", "active"), ("deactivate", "inactive")):
        assert client.ask("change", server_side, transition) is True
        assert client.ask("state", server_side) == state
    assert client.ask("change", server_side, "activate") is True
    assert client.ask("change", server_side, "configure") is False
    states = ["unconfigured", "configuring", "inactive", "activating", "active", "deactivating", "inactive"]
    states += ["activating", "active"]
    steps = [[server_side, *step] for step in pairwise(states)]
    assert client.ask_until(lambda transitions: len(transitions) >= len(steps), "watched_transitions") == steps


@pytest.mark.parametrize(("client_side", "server_side"), SIDES)
def test_parameter_events_are_received(start_peer, client_side, server_side):
    observer, node = start_peer(client_side), start_peer(server_side)
    for peer in (observer, node):
        peer.ask_until(lambda counts: counts == [2, 2], "endpoint_counts", "/parameter_events")
    node.ask("declare", "speed", 1.5)
    node.ask("set", "speed", 2.5)
    events = observer.ask_until(lambda events: len(events) >= 2, "events_of", server_side, "speed")
    assert events == [["new", "speed", 1.5], ["changed", "speed", 2.5]]


def test_verbs_use_actions_and_lifecycle_of_real_node(start_peer):
    start_peer("theirs")
    out, err, status = linkwright(
        "action", "send_goal", "--feedback", "/theirs/fibonacci", "test_msgs/action/Fibonacci", "{order: 3}"
    )
    assert "Goal finished with status: SUCCEEDED" in out
    assert (err, status) == ("", 0)
    # A verb that lists waits only briefly; on a busy machine, nodes may announce themselves later.
    wait_until(lambda: linkwright("action", "list")[0] == "/theirs/fibonacci\n")
    wait_until(lambda: "    /theirs\n" in linkwright("action", "info", "/theirs/fibonacci")[0])
    wait_until(lambda: linkwright("lifecycle", "nodes")[0] == "/theirs\n")
    assert linkwright("lifecycle", "get", "/theirs") == ("unconfigured [1]\n", "", 0)
    assert linkwright("lifecycle", "set", "/theirs", "configure") == ("Transitioning successful\n", "", 0)
    assert linkwright("lifecycle", "get", "/theirs") == ("inactive [2]\n", "", 0)
