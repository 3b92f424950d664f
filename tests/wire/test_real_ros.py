"""Nodes of real ROS 2.

LINKWRIGHT_ROS_PYTHON names an interpreter with rclpy (see CONTRIBUTING.md).
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from itertools import product

import pytest
import yaml

from linkwright.graph.names.rules import NodeIdentity
from linkwright.graph.qos.profile import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from linkwright.messages import String, get_message, get_service, type_hash
from tests.domains import own_domain
from tests.wire.programs import linkwright

PYTHON = os.environ.get("LINKWRIGHT_ROS_PYTHON", "")
TRANSIENT_LOCAL = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
IMAGE_COUNT = 45
FLOOD_COUNT = 300
FRAME_COUNT = 40
NODE_COUNT = 50

Image = get_message("sensor_msgs/msg/Image")
JointState = get_message("sensor_msgs/msg/JointState")

pytestmark = pytest.mark.skipif(not PYTHON, reason="LINKWRIGHT_ROS_PYTHON names no interpreter with rclpy")


@pytest.fixture
def start_real_node(programs):
    return lambda **variables: programs("real_peer", "real_node", python=PYTHON, **variables)


def is_discovered(process, name):
    return NodeIdentity(name, "/") in process.transport.remote_nodes()


@pytest.mark.parametrize("we_are_first", [True, False])
def test_nodes_discover_each_other(processes, start_real_node, we_are_first):
    if we_are_first:
        process = processes("ours")
        real = start_real_node()
    else:
        real = start_real_node()
        process = processes("ours")
    process.spin_until(lambda: is_discovered(process, "real_node"), 2.5)
    real.ask_until(lambda nodes: nodes == [["/", "ours"], ["/", "real_node"]], "nodes")


LOCALHOST = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
SUBNET = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET"}
LOCALHOST_ONLY = {"ROS_LOCALHOST_ONLY": "1"}
RANGES: list[dict[str, str]] = [{}, LOCALHOST, SUBNET, LOCALHOST_ONLY]


@pytest.mark.parametrize(("theirs", "ours"), list(product(RANGES, RANGES)), ids=str)
def test_nodes_discover_each_other_for_any_discovery_range(processes, start_real_node, monkeypatch, theirs, ours):
    real = start_real_node(**theirs)
    for name, value in ours.items():
        monkeypatch.setenv(name, value)
    process = processes("ours")
    process.spin_until(lambda: is_discovered(process, "real_node"), 5.0)
    real.ask_until(lambda nodes: ["/", "ours"] in nodes, "nodes")


def test_localhost_node_is_discovered_by_earlier_subnet_node(processes, start_real_node, monkeypatch):
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "SUBNET")
    process = processes("ours")
    real = start_real_node(**LOCALHOST)
    process.spin_until(lambda: is_discovered(process, "real_node"), 10.0)
    real.ask_until(lambda nodes: ["/", "ours"] in nodes, "nodes")


def test_domains_are_isolated(processes, start_real_node, domain):
    real = start_real_node(ROS_DOMAIN_ID=str(own_domain(2)))
    process = processes("ours")
    time.sleep(1.5)
    assert not is_discovered(process, "real_node")
    assert real.ask("nodes") == [["/", "real_node"]]


def test_late_node_sees_everything_after_wait_for_discovery(processes, start_real_node):
    """A late node sees everything after its wait.

    It also sees the last service, which Fast DDS announces some time after the first topic.
    """
    start_real_node()
    process = processes("ours")
    assert process.transport.wait_for_discovery(60)
    assert is_discovered(process, "real_node")
    assert process.node.count_publishers("/from_ros") == 1
    services = dict(process.node.get_service_names_and_types_by_node("real_node", "/"))
    assert services["/flip"] == ["std_srvs/srv/SetBool"]
    assert len([name for name in services if "parameter" in name]) == 6


def test_topics_work_in_both_directions(processes, start_real_node):
    process = processes("ours")
    texts: list[str] = []
    process.node.create_subscription(String, "/from_ros", lambda message: texts.append(message.data), 10)
    publisher = process.node.create_publisher(String, "/to_ros", 10)
    real = start_real_node()
    process.spin_until(lambda: publisher.get_subscription_count() == 1)
    process.spin_until(lambda: process.node.count_publishers("/from_ros") == 1)
    publisher.publish(String(data="hej"))
    assert real.ask_until(bool, "received", "to_ros") == ["hej"]
    for number in range(3):
        real.ask("publish", f"från {number}")
    process.spin_until(lambda: len(texts) == 3)
    assert texts == ["från 0", "från 1", "från 2"]


def test_types_with_sequences_work_in_both_directions(processes, start_real_node):
    """Cyclone cannot read the type information of Fast DDS 3 for these."""
    process = processes("ours")
    real = start_real_node()
    messages = []
    process.node.create_subscription(JointState, "/states_from_ros", messages.append, 10)
    publisher = process.node.create_publisher(JointState, "/states_to_ros", 10)
    process.spin_until(lambda: publisher.get_subscription_count() == 1)
    process.spin_until(lambda: process.node.count_publishers("/states_from_ros") == 1)
    publisher.publish(JointState(name=["a", "b"], position=[0.5, 1.5]))
    assert real.ask_until(bool, "received_states") == [[["a", "b"], [0.5, 1.5]]]
    real.ask("publish_state", ["left", "right"], [0.25])
    process.spin_until(lambda: messages)
    assert (messages[0].name, list(messages[0].position), list(messages[0].velocity)) == (["left", "right"], [0.25], [])


def test_images_at_30_hz_arrive_complete_in_both_directions(processes, start_real_node):
    process = processes("ours")
    real = start_real_node()
    numbers: list[int] = []
    process.node.create_subscription(
        Image, "/images_from_ros", lambda image: numbers.append(int(image.header.frame_id)), 50
    )
    publisher = process.node.create_publisher(Image, "/images_to_ros", 50)
    process.spin_until(lambda: publisher.get_subscription_count() == 1)
    process.spin_until(lambda: process.node.count_publishers("/images_from_ros") == 1)
    time.sleep(0.5)
    real.ask("publish_images", IMAGE_COUNT, 30.0)
    picture = Image(height=480, width=640, encoding="rgb8", step=1920, data=bytes(640 * 480 * 3))
    due = time.monotonic()
    for number in range(IMAGE_COUNT):
        picture.header.frame_id = str(number)
        publisher.publish(picture)
        due += 1 / 30
        while time.monotonic() < due:
            process.executor.spin_once(timeout_sec=max(0.0, due - time.monotonic()))
    process.spin_until(lambda: len(numbers) == IMAGE_COUNT)
    assert numbers == list(range(IMAGE_COUNT))
    assert real.ask_until(lambda images: len(images) == IMAGE_COUNT, "received_images") == list(range(IMAGE_COUNT))


def test_images_replaced_in_transit_do_not_stop_reader(processes, start_real_node):
    """Images that are replaced in transit do not stop the reader.

    Fast DDS keeps reading a sample that it has freed when a GAP replaces the rest of an image.
    """
    process = processes("ours")
    real = start_real_node()
    publisher = process.node.create_publisher(Image, "/images_to_ros", 1)
    process.spin_until(lambda: publisher.get_subscription_count() == 1)
    image = Image(height=1, width=1_000_000, encoding="mono8", step=1_000_000, data=bytes(1_000_000))
    for number in range(FLOOD_COUNT):
        image.header.frame_id = str(number)
        publisher.publish(image)
        process.executor.spin_once(timeout_sec=0.01)
    assert real.ask_until(lambda images: images and images[-1] == FLOOD_COUNT - 1, "received_images")


def test_best_effort_images_larger_than_reader_buffer_arrive(processes, start_real_node):
    """Without pacing, most packets of an image are lost, and they are not resent."""
    process = processes("ours")
    # A client, as every node of rclpy has, lets us discover the address of Fast DDS.
    process.node.create_client(get_service("std_srvs/srv/SetBool"), "/flip")
    real = start_real_node()
    profile = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
    publisher = process.node.create_publisher(Image, "/frames_to_ros", profile)
    process.spin_until(lambda: publisher.get_subscription_count() == 1)
    image = Image(height=1, width=1_000_000, encoding="mono8", step=1_000_000, data=bytes(1_000_000))
    arrived: list[int] = []
    for number in range(FRAME_COUNT):
        image.header.frame_id = str(number)
        publisher.publish(image)
        deadline = time.monotonic() + 1.0
        while number not in arrived and time.monotonic() < deadline:
            process.executor.spin_once(timeout_sec=0.01)
            arrived = real.ask("received_images", "frames_to_ros")
    # The reader is discovered before the second half is sent.
    assert len([number for number in arrived if number >= FRAME_COUNT // 2]) >= 0.9 * FRAME_COUNT / 2


def test_late_subscriber_gets_latched_message(processes, start_real_node):
    process = processes("ours")
    process.node.create_publisher(String, "/lasting_to_ros", TRANSIENT_LOCAL).publish(String(data="said before"))
    real = start_real_node()
    assert real.ask_until(bool, "received", "lasting_to_ros") == ["said before"]
    late_process = processes("late")
    texts: list[str] = []
    late_process.node.create_subscription(
        String, "/lasting_from_ros", lambda message: texts.append(message.data), TRANSIENT_LOCAL
    )
    late_process.spin_until(lambda: texts == ["said before"])


def test_endpoints_have_node_and_type_hash(processes, start_real_node):
    process = processes("ours")
    process.node.create_publisher(String, "/named", 10)
    real = start_real_node()
    published = real.ask_until(lambda publishers: "/named" in publishers, "published_by", "ours")
    assert published["/named"] == ["std_msgs/msg/String"]
    (message,) = real.ask("hashes", "/named")
    assert type_hash(String).removeprefix("RIHS01_") in message
    # DDS announces an endpoint and its node in separate messages.
    publishers = process.node.get_publishers_info_by_topic
    process.spin_until(lambda: [info.node_name for info in publishers("/from_ros")] == ["real_node"])


def test_incompatible_qos_is_reported_on_both_sides(processes, start_real_node):
    process = processes("ours")
    real = start_real_node()
    process.node.create_publisher(String, "/to_ros", QoSProfile(5, reliability=ReliabilityPolicy.BEST_EFFORT))
    process.node.create_subscription(String, "/from_ros", print, TRANSIENT_LOCAL)
    process.spin_until(lambda: len([text for text in process.warnings() if "incompatible QoS" in text]) == 2)
    assert any("RELIABILITY" in text and "'/real_node'" in text for text in process.warnings())
    assert any("DURABILITY" in text and "'/real_node'" in text for text in process.warnings())
    answer = real.ask_until(lambda answer: len(answer) == 2, "mismatches")
    assert sorted(answer) == ["publisher", "subscription"]


def test_killed_real_node_disappears_before_lease_expires(processes, start_real_node):
    process = processes("ours")
    real = start_real_node()
    process.spin_until(lambda: is_discovered(process, "real_node"))
    real.kill()
    process.spin_until(lambda: not is_discovered(process, "real_node"), 5.0)


def test_killed_real_node_is_received_again_after_restart(processes, start_real_node):
    process = processes("ours")
    texts: list[str] = []
    process.node.create_subscription(String, "/from_ros", lambda message: texts.append(message.data), 10)
    publisher = process.node.create_publisher(String, "/to_ros", 10)
    first = start_real_node()
    process.spin_until(lambda: publisher.get_subscription_count() == 1)
    first.kill()
    second_peer = start_real_node()
    # The lease of the first node, 20 s, has not expired.
    process.spin_until(lambda: publisher.get_subscription_count() == 2)
    start_s = time.monotonic()
    for number in range(8):
        publisher.publish(String(data=str(number)))
    assert time.monotonic() - start_s < 1.0
    assert second_peer.ask_until(lambda heard: len(heard) == 8, "received", "to_ros") == list("01234567")
    second_peer.ask("publish", "back")
    process.spin_until(lambda: texts == ["back"])


def test_killed_linkwright_node_disappears_and_successor_is_received(processes, programs, start_real_node):
    real = start_real_node()
    ours = programs("linkwright_program", "victim")
    real.ask_until(lambda nodes: ["/", "victim"] in nodes, "nodes")
    ours.kill()
    successor = processes("victim")
    publisher = successor.node.create_publisher(String, "/to_ros", 10)
    successor.spin_until(lambda: publisher.get_subscription_count() == 1)
    publisher.publish(String(data="the next one"))
    assert real.ask_until(bool, "received", "to_ros") == ["the next one"]
    real.ask_until(lambda nodes: nodes.count(["/", "victim"]) == 1, "nodes", seconds=10)


def test_fifty_real_nodes_appear_and_disappear_with_their_process(processes, start_real_node):
    process = processes("ours")
    real = start_real_node()
    real.ask("make_nodes", NODE_COUNT)
    names = {f"extra_{number}" for number in range(NODE_COUNT)}
    process.spin_until(lambda: names <= {node.name for node in process.transport.remote_nodes()})
    process.spin_until(lambda: process.node.count_publishers("/rosout") == NODE_COUNT + 2)
    assert len(linkwright("node", "list")[0].splitlines()) == NODE_COUNT + 2
    real.end()
    process.spin_until(lambda: not process.transport.remote_nodes())


def test_verbs_measure_describe_and_dump_real_node(start_real_node):
    real = start_real_node()
    real.ask("publish_images", 3000, 30.0)
    command = [sys.executable, "-m", "linkwright", "topic", "hz", "/images_from_ros"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as measuring:
        assert measuring.stdout is not None
        rate = next(line for line in measuring.stdout if "average rate: " in line)
        measuring.terminate()
    assert 10 < float(rate.partition("average rate: ")[2]) < 60
    described = linkwright("topic", "info", "-v", "/lasting_from_ros")[0]
    assert "Node name: real_node" in described
    assert "Durability: TRANSIENT_LOCAL" in described
    dumped = linkwright("param", "dump", "/real_node")[0]
    assert yaml.safe_load(dumped)["/real_node"]["ros__parameters"]["speed"] == 1.5


def test_verbs_list_endpoints_of_real_node(start_real_node):
    start_real_node()
    assert linkwright("node", "list") == ("/real_node\n", "", 0)
    topics = linkwright("topic", "list", "-t")[0].splitlines()
    assert "/states_from_ros [sensor_msgs/msg/JointState]" in topics
    assert "/images_to_ros [sensor_msgs/msg/Image]" in topics
    info = linkwright("node", "info", "/real_node")[0]
    assert "/lasting_from_ros: std_msgs/msg/String" in info
    assert "/flip: std_srvs/srv/SetBool" in info
    assert linkwright("topic", "echo", "--once", "/lasting_from_ros") == ("data: said before\n---\n", "", 0)
