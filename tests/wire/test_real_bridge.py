"""A bridge between nodes of real ROS 2 on Fast DDS and nodes of Linkwright over Zenoh.

See `test_real_ros`.

Both sides run the same programs; one side's subscriptions are remapped to the other side's publishers.
"""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from linkwright.standins.process import create_environment
from linkwright.wire.zenoh.settings import OVERRIDES_VARIABLE
from tests.wire.programs import linkwright

PYTHON = os.environ.get("LINKWRIGHT_ROS_PYTHON", "")
TYPES = os.environ.get("LINKWRIGHT_ROS_TYPES", "")
SIDES = [("theirs", "ours"), ("ours", "theirs")]
RMW = {"theirs": "rmw_fastrtps_cpp", "ours": "rmw_zenoh_cpp"}
IMAGE_COUNT = 50
RATE_HZ = 10.0
CALL_COUNT = 100

pytestmark = pytest.mark.skipif(not PYTHON, reason="LINKWRIGHT_ROS_PYTHON names no interpreter with rclpy")


@pytest.fixture(autouse=True)
def local_zenoh(monkeypatch):
    """Let Zenoh's sessions find each other on this machine, without a router."""
    monkeypatch.setenv(OVERRIDES_VARIABLE, 'connect/endpoints=[];listen/endpoints=["tcp/localhost:0"]')


class Bridge:
    """The bridge command as a process."""

    def __init__(self):
        command = [sys.executable, "-m", "linkwright", "bridge", "dds", "zenoh"]
        self.process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
        assert "Bridging" in self.process.stderr.readline()

    def kill(self):
        if not self.process.stderr.closed:
            self.process.kill()
            self.process.communicate()


@pytest.fixture
def start_bridge():
    bridges = []

    def start():
        bridges.append(Bridge())
        return bridges[-1]

    yield start
    for start_bridge in bridges:
        start_bridge.kill()


@pytest.fixture
def start_peer(programs):
    """Return a function that starts the program on a side.

    The side's name is the node's name.
    """

    def start(program, side):
        arguments = []
        if program == "real_peer":
            rules = [("echo", f"{side}_echo"), ("flip", f"{side}_flip")]
            if side == "ours":
                pairs = [(f"{kind}from_ros", f"{kind}to_ros") for kind in ("", "lasting_", "states_", "images_")]
                rules += [rule for pair in pairs for rule in (pair, pair[::-1])]
            arguments = ["--ros-args", *(word for rule in rules for word in ("-r", ":=".join(rule)))]
        if side == "ours":
            variables = {"PYTHONPATH": create_environment()["PYTHONPATH"]}
        else:
            variables = {"PYTHONPATH": f"{TYPES}/python", "LD_LIBRARY_PATH": f"{TYPES}/lib"} if TYPES else {}
            variables["python"] = PYTHON
        return programs(program, side, *arguments, RMW_IMPLEMENTATION=RMW[side], **variables)

    return start


def start_both_sides(start_peer, program):
    return {side: start_peer(program, side) for side in RMW}


def publish_until_received(publisher, subscriber, text):
    """Publish a text repeatedly until the other side receives it."""

    def has_arrived(texts):
        publisher.ask("publish", text)
        return text in texts

    subscriber.ask_until(has_arrived, "received", "to_ros")


def publish_image_until_received(publisher, subscriber):
    """Publish a single image, numbered 0, repeatedly until the other side receives one.

    A received text does not mean that the images' topic is connected, too.
    """

    def has_arrived(numbers):
        publisher.ask("publish_images", 1, RATE_HZ)
        return numbers

    subscriber.ask_until(has_arrived, "received_images")


def test_bridge_connects_topics_services_and_parameters(start_bridge, start_peer):
    start_bridge()
    sides = start_both_sides(start_peer, "real_peer")
    for side in sides.values():
        side.ask_until(lambda nodes: ["/", "ours"] in nodes and ["/", "theirs"] in nodes, "nodes")
    for publisher_side, subscriber_side in SIDES:
        name = "from_ros" if publisher_side == "theirs" else "to_ros"
        sides[subscriber_side].ask_until(
            lambda topics, name=name: topics.get(f"/states_{name}") == ["sensor_msgs/msg/JointState"],
            "published_by",
            publisher_side,
        )
        publish_until_received(sides[publisher_side], sides[subscriber_side], f"from {publisher_side}")
        assert sides[subscriber_side].ask_until(bool, "received", "lasting_to_ros") == ["said before"]
        sides[publisher_side].ask("publish_state", ["left", "right"], [0.25])
        assert sides[subscriber_side].ask_until(bool, "received_states") == [[["left", "right"], [0.25]]]
    assert sides["theirs"].ask("hashes", "/lasting_to_ros") == sides["theirs"].ask("hashes", "/lasting_from_ros")
    for client_side, server_side in SIDES:
        assert (
            sides[client_side].ask("count_correct_echoes", f"/{server_side}_echo", f"{client_side} asks", CALL_COUNT)
            == CALL_COUNT
        )
        assert "speed" in sides[client_side].ask("parameters_of", server_side)
        assert sides[client_side].ask("set_parameter_of", server_side, "speed", 2.5) == [True, 2.5]


@pytest.mark.parametrize(("client_side", "server_side"), SIDES)
def test_goals_are_executed_rejected_aborted_and_canceled(start_bridge, start_peer, client_side, server_side):
    start_bridge()
    client = start_both_sides(start_peer, "managed_peer")[client_side]
    action = f"/{server_side}/fibonacci"
    message = client.ask("send_goal", action, 5)
    assert (message["accepted"], message["status"], message["sequence"]) == (True, "SUCCEEDED", [0, 1, 1, 2, 3, 5])
    assert client.ask("send_goal", action, -1) == {"accepted": False}
    assert client.ask("send_goal", action, 0)["status"] == "ABORTED"
    message = client.ask("send_goal", action, 500, 3)
    assert message["status"] == "CANCELED"
    assert message["feedback"]
    assert client.ask("count_correct_goals", action, 20) == 20


@pytest.mark.skipif(not TYPES, reason="LINKWRIGHT_ROS_TYPES names no types of tf2")
@pytest.mark.parametrize(("publisher_side", "subscriber_side"), SIDES)
def test_transforms_are_received(start_bridge, start_peer, publisher_side, subscriber_side):
    start_bridge()
    publisher = start_peer("tf_peer", publisher_side)
    publisher.ask("publish_transform", "/tf_static", "map", "odom", 1.0)
    publisher.ask("keep_publishing", "odom", "base_link", 2.0)
    subscriber = start_peer("tf_peer", subscriber_side)
    assert subscriber.ask_until(bool, "received", "/tf_static") == {"odom": ["map", 1.0]}
    assert subscriber.ask_until(bool, "received", "/tf") == {"base_link": ["odom", 2.0]}


@pytest.mark.parametrize(("publisher_side", "subscriber_side"), SIDES)
def test_images_arrive_in_order(start_bridge, start_peer, publisher_side, subscriber_side):
    start_bridge()
    sides = start_both_sides(start_peer, "real_peer")
    publish_image_until_received(sides[publisher_side], sides[subscriber_side])
    sides[publisher_side].ask("publish_images", IMAGE_COUNT, RATE_HZ)
    indices = sides[subscriber_side].ask_until(lambda numbers: IMAGE_COUNT - 1 in numbers, "received_images")
    assert indices[-IMAGE_COUNT:] == list(range(IMAGE_COUNT))


@pytest.mark.parametrize("killed", RMW)
def test_killed_node_disappears_and_returns_across_bridge(start_bridge, start_peer, killed):
    start_bridge()
    sides = start_both_sides(start_peer, "real_peer")
    (remaining,) = RMW.keys() - {killed}
    publish_until_received(sides[killed], sides[remaining], "once")
    sides[killed].kill()
    sides[remaining].ask_until(lambda nodes: ["/", killed] not in nodes, "nodes")
    sides[killed] = start_peer("real_peer", killed)
    publish_until_received(sides[killed], sides[remaining], "again")
    publish_until_received(sides[remaining], sides[killed], "answered")
    assert sides[remaining].ask("nodes").count(["/", killed]) == 1
    assert sides[remaining].ask("count_correct_echoes", f"/{killed}_echo", "again", 10) == 10


def test_killed_bridge_is_replaced(start_bridge, start_peer):
    first = start_bridge()
    sides = start_both_sides(start_peer, "real_peer")
    publish_until_received(sides["theirs"], sides["ours"], "once")
    first.kill()
    for side, other in SIDES:
        sides[side].ask_until(lambda nodes, other=other: ["/", other] not in nodes, "nodes")
    start_bridge()
    for publisher_side, subscriber_side in SIDES:
        publish_until_received(sides[publisher_side], sides[subscriber_side], f"again from {publisher_side}")
        assert sides[subscriber_side].ask("received", "lasting_to_ros") == ["said before"] * 2
    nodes = sides["theirs"].ask("nodes")
    assert nodes.count(["/", "ours"]) == 1
    assert nodes == sides["ours"].ask("nodes")


def test_verbs_show_nodes_beyond_bridge(start_bridge, start_peer, monkeypatch):
    start_bridge()
    sides = start_both_sides(start_peer, "real_peer")
    publish_until_received(sides["theirs"], sides["ours"], "we know each other")
    monkeypatch.setenv("RMW_IMPLEMENTATION", RMW["ours"])
    assert {"/ours", "/theirs"} <= set(linkwright("node", "list")[0].splitlines())
    output = linkwright("topic", "info", "-v", "/images_from_ros")[0]
    assert "Publisher count: 1" in output
    assert "Node name: theirs" in output
    assert "Subscription count: 1" in output
    assert linkwright("param", "get", "/theirs", "speed")[0] == "Double value is: 1.5\n"
    output = linkwright("service", "call", "/theirs_flip", "std_srvs/srv/SetBool", "{data: false}")[0]
    assert "message='by ROS'" in output
