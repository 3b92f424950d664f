"""Services, parameters and verbs with nodes of real ROS 2 on Fast DDS; see `test_real_ros`."""

from __future__ import annotations

import os
import threading

import pytest

from linkwright.graph.parameters.client import AsyncParameterClient
from linkwright.graph.qos.profile import HistoryPolicy
from linkwright.messages import get_service
from tests.wire.programs import linkwright

PYTHON = os.environ.get("LINKWRIGHT_ROS_PYTHON", "")
CALL_COUNT = 1000
LARGE_TEXT_LENGTH = 1_000_000
SetBool = get_service("std_srvs/srv/SetBool")
SetCameraInfo = get_service("sensor_msgs/srv/SetCameraInfo")

pytestmark = pytest.mark.skipif(not PYTHON, reason="LINKWRIGHT_ROS_PYTHON names no interpreter with rclpy")


@pytest.fixture
def start_real_node(programs):
    def start(name="real_node", **variables):
        return programs("real_peer", name, python=PYTHON, RMW_IMPLEMENTATION="rmw_fastrtps_cpp", **variables)

    return start


def echo(request, response):
    response.success, response.status_message = True, request.camera_info.distortion_model
    return response


def camera_request(text):
    request = SetCameraInfo.Request()
    request.camera_info.distortion_model = text
    return request


def wait_for_result(process, future):
    process.spin_until(future.done, 30)
    return future.result()


def ask_while_spinning(process, peer, *question):
    """Ask the peer a question, and run callbacks until it answers."""
    answers = []
    thread = threading.Thread(target=lambda: answers.append(peer.ask(*question)))
    thread.start()
    process.spin_until(lambda: answers, 120)
    thread.join()
    return answers[0]


@pytest.mark.parametrize("we_are_first", [True, False])
def test_thousand_calls_to_real_service_get_their_own_responses(processes, start_real_node, we_are_first):
    process = processes("ours") if we_are_first else None
    start_real_node()
    process = process or processes("ours")
    client = process.node.create_client(SetCameraInfo, "/echo")
    process.spin_until(client.service_is_ready)
    for number in range(CALL_COUNT):
        assert (
            wait_for_result(process, client.call_async(camera_request(f"call {number}"))).status_message
            == f"call {number}"
        )


def test_thousand_calls_from_real_client_get_their_own_responses(processes, start_real_node):
    process = processes("ours")
    process.node.create_service(SetCameraInfo, "/linkwright_echo", echo)
    peer = start_real_node()
    assert (
        ask_while_spinning(process, peer, "count_correct_echoes", "/linkwright_echo", "call", CALL_COUNT) == CALL_COUNT
    )


def test_first_call_of_first_real_node_is_answered(processes, start_real_node):
    """The first call of the first real node is answered.

    The node calls as soon as it has read Cyclone's announcement, before Linkwright has discovered it.
    """
    process = processes("ours")
    process.node.create_service(SetCameraInfo, "/linkwright_echo", echo)
    for attempt in range(3):
        peer = start_real_node(f"real_node_{attempt}")
        assert ask_while_spinning(process, peer, "echoes", "/linkwright_echo", ["one", "two"]) == ["one", "two"]
        peer.end()


def test_simultaneous_real_and_linkwright_clients_are_answered(processes, start_real_node):
    process = processes("ours")
    process.node.create_service(SetCameraInfo, "/linkwright_echo", echo)
    client = process.node.create_client(SetCameraInfo, "/echo")
    peers = [start_real_node(f"real_node_{number}") for number in range(3)]
    counts = []
    threads = [
        threading.Thread(
            target=lambda peer=peer, number=number: counts.append(
                peer.ask("count_correct_echoes", "/linkwright_echo", f"client {number}", CALL_COUNT // 5)
            )
        )
        for number, peer in enumerate(peers)
    ]
    for thread in threads:
        thread.start()
    process.spin_until(client.service_is_ready)
    own_futures = [
        wait_for_result(process, client.call_async(camera_request(f"mine {number}"))).status_message
        for number in range(20)
    ]
    process.spin_until(lambda: len(counts) == 3, 120)
    for thread in threads:
        thread.join()
    assert counts == [CALL_COUNT // 5] * 3
    assert own_futures == [f"mine {number}" for number in range(20)]


def test_history_of_real_publisher_is_unknown(processes, start_real_node):
    process = processes("ours")
    start_real_node()
    process.spin_until(lambda: process.node.get_publishers_info_by_topic("/from_ros"))
    (info,) = process.node.get_publishers_info_by_topic("/from_ros")
    assert info.qos_profile.history is HistoryPolicy.UNKNOWN


@pytest.mark.parametrize("ours", [{"ROS_LOCALHOST_ONLY": "1"}, {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}])
@pytest.mark.parametrize("we_are_first", [True, False])
def test_calls_work_in_both_directions_on_localhost(processes, start_real_node, monkeypatch, ours, we_are_first):
    peer = None if we_are_first else start_real_node(ROS_AUTOMATIC_DISCOVERY_RANGE="LOCALHOST")
    for name, value in ours.items():
        monkeypatch.setenv(name, value)
    process = processes("ours")
    process.node.create_service(SetCameraInfo, "/linkwright_echo", echo)
    client = process.node.create_client(SetCameraInfo, "/echo")
    peer = peer or start_real_node(ROS_AUTOMATIC_DISCOVERY_RANGE="LOCALHOST")
    process.spin_until(client.service_is_ready)
    assert wait_for_result(process, client.call_async(camera_request("hej"))).status_message == "hej"
    assert ask_while_spinning(process, peer, "echoes", "/linkwright_echo", ["hej"]) == ["hej"]


def test_calls_larger_than_packet_work_in_both_directions(processes, start_real_node):
    process = processes("ours")
    process.node.create_service(SetCameraInfo, "/linkwright_echo", echo)
    client = process.node.create_client(SetCameraInfo, "/echo")
    peer = start_real_node()
    process.spin_until(client.service_is_ready)
    large = "".join(chr(ord("a") + number % 26) for number in range(LARGE_TEXT_LENGTH))
    assert wait_for_result(process, client.call_async(camera_request(large))).status_message == large
    assert ask_while_spinning(process, peer, "echoes", "/linkwright_echo", [large, "small"]) == [large, "small"]


def test_killed_real_server_disappears_and_successor_is_called(processes, start_real_node):
    process = processes("ours")
    client = process.node.create_client(SetCameraInfo, "/echo")
    first = start_real_node()
    process.spin_until(client.service_is_ready)
    assert wait_for_result(process, client.call_async(camera_request("first"))).status_message == "first"
    first.kill()
    start_real_node()
    process.spin_until(client.service_is_ready)
    process.spin_until(
        lambda: wait_for_result(process, client.call_async(camera_request("again"))).status_message == "again"
    )


def test_successor_of_killed_linkwright_server_answers(processes, programs, start_real_node):
    ours = programs("linkwright_program", "ours")
    peer = start_real_node()
    assert "use_sim_time" in peer.ask("parameters_of", "ours")
    ours.kill()
    process = processes("ours")
    process.node.declare_parameter("second", 1.0)
    # Until the peer discovers the new node, its requests go to the killed one.
    while "second" not in ask_while_spinning(process, peer, "parameters_of", "ours"):
        pass


def test_parameters_are_read_and_set_in_both_directions(processes, start_real_node):
    process = processes("ours")
    process.node.declare_parameter("speed", 1.5)
    peer = start_real_node()
    assert "speed" in ask_while_spinning(process, peer, "parameters_of", "ours")
    assert ask_while_spinning(process, peer, "set_parameter_of", "ours", "speed", 2.5) == [True, 2.5]
    assert process.node.get_parameter("speed").value == 2.5
    parameters = AsyncParameterClient(process.node, "/real_node")
    process.spin_until(parameters.services_are_ready)
    assert wait_for_result(process, parameters.get_parameters(["speed"])).values[0].double_value == 1.5


def test_verbs_use_services_and_parameters_of_real_node(start_real_node):
    start_real_node()
    out, err, status = linkwright("service", "call", "/flip", "std_srvs/srv/SetBool", "{data: false}")
    assert "success=True, message='by ROS'" in out
    assert (err, status) == ("", 0)
    assert linkwright("param", "get", "/real_node", "speed") == ("Double value is: 1.5\n", "", 0)
    assert linkwright("param", "set", "/real_node", "speed", "2.5") == ("Set parameter successful\n", "", 0)
    assert "speed: 2.5" in linkwright("param", "dump", "/real_node")[0]
    assert "  speed\n" in linkwright("param", "list", "/real_node")[0]
