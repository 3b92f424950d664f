"""Nodes of real ROS 2, where an interpreter with rclpy is named by LINKWRIGHT_ROS_PYTHON (see CONTRIBUTING.md)."""

from __future__ import annotations

import os

import pytest

from linkwright.graph.qos import DurabilityPolicy, QoSProfile
from linkwright.graph.transport import NodeIdentity
from linkwright.messages import String, get_service, type_hash

PYTHON = os.environ.get("LINKWRIGHT_ROS_PYTHON", "")
LASTING = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)

pytestmark = pytest.mark.skipif(not PYTHON, reason="LINKWRIGHT_ROS_PYTHON names no interpreter with rclpy")


@pytest.fixture
def real_node(programs):
    return lambda: programs("real_peer", "real_node", python=PYTHON)


def has(us, name):
    return NodeIdentity(name, "/") in us.transport.remote_nodes()


@pytest.mark.parametrize("we_are_first", [True, False])
def test_nodes_know_each_other(processes, real_node, we_are_first):
    if we_are_first:
        us = processes("ours")
        real = real_node()
    else:
        real = real_node()
        us = processes("ours")
    us.spin_until(lambda: has(us, "real_node"), 2.5)
    real.ask_until(lambda nodes: nodes == [["/", "ours"], ["/", "real_node"]], "nodes")


def test_who_comes_later_knows_all_when_discovery_is_complete(processes, real_node):
    real_node()
    us = processes("ours")
    assert us.transport.wait_for_discovery(5)
    assert has(us, "real_node")
    assert us.node.count_publishers("/from_ros") == 1


def test_topics_go_both_ways(processes, real_node):
    us = processes("ours")
    got: list[str] = []
    us.node.create_subscription(String, "/from_ros", lambda message: got.append(message.data), 10)
    publisher = us.node.create_publisher(String, "/to_ros", 10)
    real = real_node()
    us.spin_until(lambda: publisher.get_subscription_count() == 1)
    us.spin_until(lambda: us.node.count_publishers("/from_ros") == 1)
    publisher.publish(String(data="hej"))
    assert real.ask_until(bool, "received", "to_ros") == ["hej"]
    for number in range(3):
        real.ask("publish", f"från {number}")
    us.spin_until(lambda: len(got) == 3)
    assert got == ["från 0", "från 1", "från 2"]


def test_what_was_said_before_is_heard_by_who_comes_later(processes, real_node):
    us = processes("ours")
    us.node.create_publisher(String, "/lasting_to_ros", LASTING).publish(String(data="said before"))
    real = real_node()
    assert real.ask_until(bool, "received", "lasting_to_ros") == ["said before"]
    late = processes("late")
    got: list[str] = []
    late.node.create_subscription(String, "/lasting_from_ros", lambda message: got.append(message.data), LASTING)
    late.spin_until(lambda: got == ["said before"])


def test_our_endpoints_have_their_node_and_their_type_hash(processes, real_node):
    us = processes("ours")
    us.node.create_publisher(String, "/named", 10)
    real = real_node()
    published = real.ask_until(lambda found: "/named" in found, "published_by", "ours")
    assert published["/named"] == ["std_msgs/msg/String"]
    (told,) = real.ask("hashes", "/named")
    assert type_hash(String).removeprefix("RIHS01_") in told
    us.spin_until(lambda: us.node.get_publishers_info_by_topic("/from_ros"))
    (info,) = us.node.get_publishers_info_by_topic("/from_ros")
    assert info.node_name == "real_node"


def test_a_service_on_fast_dds_is_listed_and_said_to_be_out_of_reach(processes, real_node, monkeypatch):
    monkeypatch.setenv("RMW_IMPLEMENTATION", "rmw_fastrtps_cpp")
    real_node()
    us = processes("ours")
    us.spin_until(lambda: us.node.count_services("/real_node/get_parameters") == 1)
    client = us.node.create_client(get_service("rcl_interfaces/srv/GetParameters"), "/real_node/get_parameters")
    us.spin_until(lambda: any("rmw_fastrtps_cpp" in warning for warning in us.warnings()))
    assert not client.service_is_ready()
