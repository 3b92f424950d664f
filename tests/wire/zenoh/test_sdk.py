"""Nodes of zenoh-ros2-sdk.

It is another implementation of ROS 2's keys, tokens and hashes over Zenoh.

The tests run where LINKWRIGHT_ZENOH_SDK_PYTHON names an interpreter with it; see ``make test-zenoh-sdk``.
"""

from __future__ import annotations

import os
import threading

import pytest

from linkwright.graph.qos.profile import HistoryPolicy, QoSProfile
from linkwright.messages import String, get_service
from linkwright.wire.zenoh.settings import OVERRIDES_VARIABLE

PYTHON = os.environ.get("LINKWRIGHT_ZENOH_SDK_PYTHON", "")
CALL_COUNT = 1000
CLIENT_COUNT = 4
KEEP_ALL = QoSProfile(history=HistoryPolicy.KEEP_ALL)
SetBool = get_service("std_srvs/srv/SetBool")

pytestmark = pytest.mark.skipif(not PYTHON, reason="LINKWRIGHT_ZENOH_SDK_PYTHON names no interpreter with the SDK")


@pytest.fixture
def start_peer(programs, router_port, monkeypatch):
    """Start a program with the SDK that connects to a session of Linkwright.

    There is no router.
    """
    settings = os.environ[OVERRIDES_VARIABLE]
    monkeypatch.setenv(OVERRIDES_VARIABLE, f'connect/endpoints=[];listen/endpoints=["tcp/127.0.0.1:{router_port}"]')
    return lambda: programs(
        "sdk_peer",
        "sdk",
        python=PYTHON,
        **{OVERRIDES_VARIABLE: settings, "PYTHONPATH": ""},
    )


def ask_while_spinning(process, question):
    """Ask the peer a question, and run callbacks until it answers."""
    answers = []
    thread = threading.Thread(target=lambda: answers.append(question()))
    thread.start()
    process.spin_until(lambda: answers, 300)
    thread.join()
    return answers[0]


def test_messages_work_in_both_directions(processes, start_peer):
    process = processes("ours")
    texts = []
    process.node.create_subscription(String, "from_sdk", lambda message: texts.append(message.data), KEEP_ALL)
    publisher = process.node.create_publisher(String, "to_sdk", KEEP_ALL)
    sdk_peer = start_peer()
    process.spin_until(lambda: publisher.get_subscription_count() == 1)
    sdk_peer.ask_until(bool, "has_subscription")
    sdk_peer.ask("publish", 0, 100)
    for number in range(1000):
        publisher.publish(String(data=str(number)))
    process.spin_until(lambda: len(texts) == 100)
    assert texts == [str(number) for number in range(100)]
    assert sdk_peer.ask_until(lambda heard: len(heard) == 1000, "received") == [str(number) for number in range(1000)]


def test_sdk_and_linkwright_discover_endpoints(processes, start_peer):
    process = processes("ours")
    sdk_peer = start_peer()
    process.spin_until(lambda: "sdk" in process.node.get_node_names())
    process.spin_until(lambda: ("/flip_sdk", ["std_srvs/srv/SetBool"]) in process.node.get_service_names_and_types())
    (endpoint,) = process.node.get_publishers_info_by_topic("/from_sdk")
    assert (endpoint.node_name, endpoint.topic_type) == ("sdk", "std_msgs/msg/String")
    sdk_peer.end()
    process.spin_until(lambda: "sdk" not in process.node.get_node_names())
    assert not process.node.count_publishers("/from_sdk")


def test_thousand_calls_of_sdk_clients_get_their_own_responses(processes, start_peer):
    process = processes("ours")
    served = []

    def flip(request, response):
        served.append(request.data)
        response.success, response.message = not request.data, "flipped"
        return response

    process.node.create_service(SetBool, "flip", flip)
    sdk_peer = start_peer()
    message = ask_while_spinning(process, lambda: sdk_peer.ask("call", CLIENT_COUNT, CALL_COUNT // CLIENT_COUNT))
    assert message == [[f"{number % 2 == 0} flipped" for number in range(CALL_COUNT // CLIENT_COUNT)]] * CLIENT_COUNT
    assert len(served) == CALL_COUNT


def test_thousand_calls_of_linkwright_clients_get_their_own_responses(processes, start_peer):
    process = processes("ours")
    clients = [process.node.create_client(SetBool, "flip_sdk") for _ in range(CLIENT_COUNT)]
    sdk_peer = start_peer()
    process.spin_until(lambda: all(client.service_is_ready() for client in clients))
    answers = [[] for _ in clients]
    waiting = [None for _ in clients]

    def all_answered() -> bool:
        for which, client in enumerate(clients):
            if waiting[which] is not None and waiting[which].done():
                answers[which].append(waiting[which].result().success)
                waiting[which] = None
            if waiting[which] is None and len(answers[which]) < CALL_COUNT // CLIENT_COUNT:
                waiting[which] = client.call_async(SetBool.Request(data=len(answers[which]) % 2 == 1))
        return all(len(answer) == CALL_COUNT // CLIENT_COUNT for answer in answers)

    process.spin_until(all_answered, 300)
    assert answers == [[number % 2 == 0 for number in range(CALL_COUNT // CLIENT_COUNT)]] * CLIENT_COUNT
    assert sdk_peer.ask("request_count") == CALL_COUNT
