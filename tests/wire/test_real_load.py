"""Many simultaneous calls and goals between nodes of real ROS 2 on Fast DDS and of Linkwright.

See `test_real_ros`.

Both sides run one program, `load_peer`: one with the real rclpy, one with ours.
"""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor

import pytest

from linkwright.standins.process import create_environment

PYTHON = os.environ.get("LINKWRIGHT_ROS_PYTHON", "")
CALL_COUNT = 1000
CLIENTS = ("theirs_1", "theirs_2", "ours_1")
GOAL_COUNT = 13
RATE_HZ = 100.0

pytestmark = pytest.mark.skipif(not PYTHON, reason="LINKWRIGHT_ROS_PYTHON names no interpreter with rclpy")


@pytest.fixture
def start_peer(programs):
    """Return a function that starts the program; its name says on which side."""

    def start(name):
        if name.startswith("theirs"):
            return programs("load_peer", name, python=PYTHON, RMW_IMPLEMENTATION="rmw_fastrtps_cpp")
        return programs("load_peer", name, PYTHONPATH=create_environment()["PYTHONPATH"])

    return start


@pytest.mark.parametrize("server", ["theirs", "ours"])
def test_thousand_mixed_calls_from_three_clients_are_answered(start_peer, server):
    """Every call gets its own response."""
    start_peer(server)
    clients = [start_peer(name) for name in CLIENTS]
    with ThreadPoolExecutor(len(clients)) as threads:
        share = CALL_COUNT // len(clients) + 1
        asking = [
            threads.submit(client.ask_slowly, "count_correct_calls", server, share, name)
            for name, client in zip(CLIENTS, clients, strict=True)
        ]
        assert [future.result() for future in asking] == [share] * len(clients)


@pytest.mark.parametrize(("asks", "answers"), [("theirs", "ours"), ("ours", "theirs")])
def test_goals_are_canceled_and_preempted_under_load(start_peer, asks, answers):
    client, server, other = start_peer(asks), start_peer(answers), start_peer(f"{asks}_2")
    client.ask("exchange_states", RATE_HZ, answers)
    server.ask("exchange_states", RATE_HZ, asks)
    for peer in (client, server):
        peer.ask_until(lambda heard: heard > RATE_HZ, "received_count")
    with ThreadPoolExecutor(1) as threads:
        storm = threads.submit(other.ask_slowly, "count_correct_calls", answers, CALL_COUNT // 4, "other")
        ends = client.ask_slowly("run_goals", answers, GOAL_COUNT)
        assert storm.result() == CALL_COUNT // 4
    cancelled = ["CANCELED" if number % 3 == 2 else "ABORTED" for number in range(GOAL_COUNT - 1)]
    assert ends == [*cancelled, "SUCCEEDED"]
