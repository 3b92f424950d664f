"""Nodes of real ROS 2, imitated by a process.

It behaves on the wire like rmw_cyclonedds_cpp.
"""

from __future__ import annotations

import os

import pytest

from linkwright.graph.endpoints.base import EndpointKind
from linkwright.graph.names.rules import NodeIdentity
from linkwright.messages import String, get_service, type_hash

pytest.importorskip("cyclonedds", reason="cyclonedds is not installed")

SetBool = get_service("std_srvs/srv/SetBool")
DISTRIBUTIONS = ("humble", "jazzy")


@pytest.fixture(params=DISTRIBUTIONS)
def distribution(request):
    return request.param


def test_ros_node_and_endpoints_are_discovered(processes, programs, distribution):
    programs("ros_peer", distribution, "real_node", "localhost")
    process = processes("ours")
    process.spin_until(lambda: NodeIdentity("real_node", "/") in process.transport.remote_nodes())
    process.spin_until(lambda: len(process.transport.remote_endpoints()) >= 4)
    endpoints_by_name = {
        (remote_endpoint.kind, remote_endpoint.name): remote_endpoint
        for remote_endpoint in process.transport.remote_endpoints()
    }
    assert endpoints_by_name[EndpointKind.PUBLISHER, "/from_ros"].type_name == "std_msgs/msg/String"
    assert endpoints_by_name[EndpointKind.SUBSCRIPTION, "/to_ros"].node == NodeIdentity("real_node", "/")
    assert endpoints_by_name[EndpointKind.SERVICE, "/ros_flip"].type_name == "std_srvs/srv/SetBool"
    assert endpoints_by_name[EndpointKind.CLIENT, "/linkwright_flip"].node == NodeIdentity("real_node", "/")
    hashes = endpoints_by_name[EndpointKind.PUBLISHER, "/from_ros"].type_hash
    assert hashes == ("" if distribution == "humble" else type_hash(String))


@pytest.mark.parametrize("other", ["", "humble", "jazzy"])
def test_ros_node_sees_gids_of_its_own_size(processes, programs, distribution, other, monkeypatch):
    """The size follows the messages of the other node, whatever ROS_DISTRO says."""
    monkeypatch.setenv("ROS_DISTRO", other)
    process = processes("ours")
    publisher = process.node.create_publisher(String, "/to_ros", 10)
    peer = programs("ros_peer", distribution, "real_node", "localhost")
    nodes = peer.ask_until(lambda nodes: any(node[1] == "ours" for node in nodes), "nodes")
    namespace, name, readers, writers = next(node for node in nodes if node[1] == "ours")
    assert (namespace, name) == ("/", "ours")
    size = 24 if distribution == "humble" else 16
    assert publisher.gid.ljust(size, b"\0").hex() in writers
    assert all(len(gid) == 2 * size for gid in readers + writers)


def test_older_gid_size_is_used_with_mixed_distributions(processes, programs):
    process = processes("ours")
    programs("ros_peer", "jazzy", "new_node", "localhost")
    process.spin_until(lambda: NodeIdentity("new_node", "/") in process.transport.remote_nodes())
    old = programs("ros_peer", "humble", "old_node", "localhost")
    process.spin_until(lambda: NodeIdentity("old_node", "/") in process.transport.remote_nodes())
    old.ask_until(lambda nodes: any(node[1] == "ours" for node in nodes), "nodes")


def test_topics_work_in_both_directions(processes, programs, distribution):
    process = processes("ours")
    texts: list[str] = []
    process.node.create_subscription(String, "/from_ros", lambda message: texts.append(message.data), 10)
    publisher = process.node.create_publisher(String, "/to_ros", 10)
    peer = programs("ros_peer", distribution, "real_node", "localhost")
    process.spin_until(lambda: publisher.get_subscription_count() == 1)
    process.spin_until(lambda: process.node.count_publishers("/from_ros") == 1)
    publisher.publish(String(data="hej"))
    assert peer.ask_until(bool, "received") == ["hej"]
    for number in range(3):
        peer.ask("publish", f"från {number}")
    process.spin_until(lambda: len(texts) == 3)
    assert texts == ["från 0", "från 1", "från 2"]


def test_service_answers_ros_client(processes, programs, distribution):
    process = processes("ours")

    def flip(request, response):
        response.success, response.message = not request.data, "by us"
        return response

    process.node.create_service(SetBool, "/linkwright_flip", flip)
    peer = programs("ros_peer", distribution, "real_node", "localhost")
    process.spin_until(lambda: process.node.count_clients("/linkwright_flip") == 1)
    peer.ask("call", False, 41)
    process.spin_until(lambda: peer.ask("replies") == [[0x0123456789ABCDEF, 41, True, "by us"]])


def test_client_is_answered_by_ros_service(processes, programs, distribution):
    process = processes("ours")
    client = process.node.create_client(SetBool, "/ros_flip")
    future = client.call_async(SetBool.Request(data=False))
    peer = programs("ros_peer", distribution, "real_node", "localhost")
    process.spin_until(lambda: peer.ask("answer_requests") or future.done())
    process.spin_until(future.done)
    assert future.result() == SetBool.Response(success=True, message="by ROS")
    assert client.service_is_ready()
    peer.kill()


def test_endpoints_announce_type_hashes_and_client_ids(processes, programs):
    process = processes("ours")
    process.node.create_publisher(String, "/named", 10)
    process.node.create_service(SetBool, "/asked", lambda _request, response: response)
    process.node.create_client(SetBool, "/asking")
    peer = programs("ros_peer", "jazzy", "real_node", "localhost")
    expected = {"rt/named", "rq/askedRequest", "rr/askedReply", "rq/askingRequest", "rr/askingReply"}
    endpoints = peer.ask_until(
        lambda endpoints: expected <= {endpoint[0] for endpoint in endpoints.values()}, "remote_endpoints"
    )
    facts = {topic: (kind, data) for topic, kind, data, _ in endpoints.values()}
    assert facts["rt/named"] == ("std_msgs::msg::dds_::String_", f"typehash={type_hash(String)};")
    for key, topics in (
        ("serviceid", ("rq/askedRequest", "rr/askedReply")),
        ("clientid", ("rq/askingRequest", "rr/askingReply")),
    ):
        kinds, data = zip(*(facts[topic] for topic in topics), strict=True)
        assert kinds == ("std_srvs::srv::dds_::SetBool_Request_", "std_srvs::srv::dds_::SetBool_Response_")
        assert data[0] == data[1]
        assert data[0].startswith(f"{key}=")
        assert data[0].endswith(f";typehash={type_hash(SetBool)};")


@pytest.mark.skipif(os.environ.get("CI") == "true", reason="CI machines may have no multicast interface")
@pytest.mark.parametrize("network", ["humble", "jazzy", "jazzy localhost", "localhost"])
@pytest.mark.parametrize("we_are_first", [True, False])
@pytest.mark.parametrize("variable", ["", "ROS_LOCALHOST_ONLY=1", "ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST"])
def test_ros_nodes_are_discovered_for_any_network_settings(
    processes, programs, network, we_are_first, variable, monkeypatch
):
    name, _, value = variable.partition("=")
    if name:
        monkeypatch.setenv(name, value)
    if we_are_first:
        process = processes("ours")
        programs("ros_peer", network.split()[0].replace("localhost", "humble"), "real_node", network)
    else:
        programs("ros_peer", network.split()[0].replace("localhost", "humble"), "real_node", network)
        process = processes("ours")
    process.spin_until(lambda: NodeIdentity("real_node", "/") in process.transport.remote_nodes())
