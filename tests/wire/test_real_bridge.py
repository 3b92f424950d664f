"""A bridge between nodes of real ROS 2 on Fast DDS and nodes of ours over Zenoh; see `test_real_ros`.

Both sides run the same programs; what one publishes, the other is remapped to hear.
"""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from linkwright.standins.process import environment
from linkwright.wire.zenoh.settings import OVERRIDES
from tests.wire.programs import linkwright

PYTHON = os.environ.get("LINKWRIGHT_ROS_PYTHON", "")
TYPES = os.environ.get("LINKWRIGHT_ROS_TYPES", "")
SIDES = [("theirs", "ours"), ("ours", "theirs")]
RMW = {"theirs": "rmw_fastrtps_cpp", "ours": "rmw_zenoh_cpp"}
IMAGES = 50
RATE = 10.0
CALLS = 100

pytestmark = pytest.mark.skipif(not PYTHON, reason="LINKWRIGHT_ROS_PYTHON names no interpreter with rclpy")


@pytest.fixture(autouse=True)
def zenoh_here(monkeypatch):
    """Peers of this machine, without a router of it."""
    monkeypatch.setenv(OVERRIDES, 'connect/endpoints=[];listen/endpoints=["tcp/localhost:0"]')


class Bridge:
    """The command, until it is ended or killed."""

    def __init__(self):
        command = [sys.executable, "-m", "linkwright", "bridge", "dds", "zenoh"]
        self.process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
        assert "Bridging" in self.process.stderr.readline()

    def kill(self):
        if not self.process.stderr.closed:
            self.process.kill()
            self.process.communicate()


@pytest.fixture
def bridge():
    bridges = []

    def start():
        bridges.append(Bridge())
        return bridges[-1]

    yield start
    for bridge in bridges:
        bridge.kill()


@pytest.fixture
def peer(programs):
    """Starts a program on one side or the other, under the name of its side."""

    def start(program, side):
        words = []
        if program == "real_peer":
            rules = [("echo", f"{side}_echo"), ("flip", f"{side}_flip")]
            if side == "ours":
                crossed = [(f"{kind}from_ros", f"{kind}to_ros") for kind in ("", "lasting_", "states_", "images_")]
                rules += [rule for pair in crossed for rule in (pair, pair[::-1])]
            words = ["--ros-args", *(word for rule in rules for word in ("-r", ":=".join(rule)))]
        if side == "ours":
            variables = {"PYTHONPATH": environment()["PYTHONPATH"]}
        else:
            variables = {"PYTHONPATH": f"{TYPES}/python", "LD_LIBRARY_PATH": f"{TYPES}/lib"} if TYPES else {}
            variables["python"] = PYTHON
        return programs(program, side, *words, RMW_IMPLEMENTATION=RMW[side], **variables)

    return start


def start_both_sides(peer, program):
    return {side: peer(program, side) for side in RMW}


def say_until_heard(said, heard, text):
    """Say something, again and again, until the other side hears it."""

    def came(received):
        said.ask("publish", text)
        return text in received

    heard.ask_until(came, "received", "to_ros")


def show_until_seen(shown, seen):
    """Publish a single image, numbered 0, again and again, until the other side receives one.

    Text that is heard does not mean that the images' topic is connected, too.
    """

    def came(numbers):
        shown.ask("publish_images", 1, RATE)
        return numbers

    seen.ask_until(came, "received_images")


def test_bridge_connects_topics_services_and_parameters(bridge, peer):
    bridge()
    sides = start_both_sides(peer, "real_peer")
    for side in sides.values():
        side.ask_until(lambda nodes: ["/", "ours"] in nodes and ["/", "theirs"] in nodes, "nodes")
    for saying, hearing in SIDES:
        name = "from_ros" if saying == "theirs" else "to_ros"
        sides[hearing].ask_until(
            lambda topics, name=name: topics.get(f"/states_{name}") == ["sensor_msgs/msg/JointState"],
            "published_by",
            saying,
        )
        say_until_heard(sides[saying], sides[hearing], f"from {saying}")
        assert sides[hearing].ask_until(bool, "received", "lasting_to_ros") == ["said before"]
        sides[saying].ask("publish_state", ["left", "right"], [0.25])
        assert sides[hearing].ask_until(bool, "received_states") == [[["left", "right"], [0.25]]]
    assert sides["theirs"].ask("hashes", "/lasting_to_ros") == sides["theirs"].ask("hashes", "/lasting_from_ros")
    for asking, asked in SIDES:
        assert sides[asking].ask("echoes_are_right", f"/{asked}_echo", f"{asking} asks", CALLS) == CALLS
        assert "speed" in sides[asking].ask("parameters_of", asked)
        assert sides[asking].ask("set_parameter_of", asked, "speed", 2.5) == [True, 2.5]


@pytest.mark.parametrize(("asking", "asked"), SIDES)
def test_goals_are_executed_rejected_aborted_and_canceled(bridge, peer, asking, asked):
    bridge()
    asks = start_both_sides(peer, "managed_peer")[asking]
    action = f"/{asked}/fibonacci"
    message = asks.ask("act", action, 5)
    assert (message["accepted"], message["status"], message["sequence"]) == (True, "SUCCEEDED", [0, 1, 1, 2, 3, 5])
    assert asks.ask("act", action, -1) == {"accepted": False}
    assert asks.ask("act", action, 0)["status"] == "ABORTED"
    message = asks.ask("act", action, 500, 3)
    assert message["status"] == "CANCELED"
    assert message["feedback"]
    assert asks.ask("acts_are_right", action, 20) == 20


@pytest.mark.skipif(not TYPES, reason="LINKWRIGHT_ROS_TYPES names no types of tf2")
@pytest.mark.parametrize(("telling", "hearing"), SIDES)
def test_transforms_are_received(bridge, peer, telling, hearing):
    bridge()
    tells = peer("tf_peer", telling)
    tells.ask("tell", "/tf_static", "map", "odom", 1.0)
    tells.ask("keep_telling", "odom", "base_link", 2.0)
    hears = peer("tf_peer", hearing)
    assert hears.ask_until(bool, "heard", "/tf_static") == {"odom": ["map", 1.0]}
    assert hears.ask_until(bool, "heard", "/tf") == {"base_link": ["odom", 2.0]}


@pytest.mark.parametrize(("saying", "hearing"), SIDES)
def test_images_arrive_in_order(bridge, peer, saying, hearing):
    bridge()
    sides = start_both_sides(peer, "real_peer")
    show_until_seen(sides[saying], sides[hearing])
    sides[saying].ask("publish_images", IMAGES, RATE)
    indices = sides[hearing].ask_until(lambda numbers: IMAGES - 1 in numbers, "received_images")
    assert indices[-IMAGES:] == list(range(IMAGES))


@pytest.mark.parametrize("killed", RMW)
def test_killed_node_disappears_and_returns_across_bridge(bridge, peer, killed):
    bridge()
    sides = start_both_sides(peer, "real_peer")
    (left,) = RMW.keys() - {killed}
    say_until_heard(sides[killed], sides[left], "once")
    sides[killed].kill()
    sides[left].ask_until(lambda nodes: ["/", killed] not in nodes, "nodes")
    sides[killed] = peer("real_peer", killed)
    say_until_heard(sides[killed], sides[left], "again")
    say_until_heard(sides[left], sides[killed], "answered")
    assert sides[left].ask("nodes").count(["/", killed]) == 1
    assert sides[left].ask("echoes_are_right", f"/{killed}_echo", "again", 10) == 10


def test_killed_bridge_is_replaced(bridge, peer):
    first = bridge()
    sides = start_both_sides(peer, "real_peer")
    say_until_heard(sides["theirs"], sides["ours"], "once")
    first.kill()
    for side, other in SIDES:
        sides[side].ask_until(lambda nodes, other=other: ["/", other] not in nodes, "nodes")
    bridge()
    for saying, hearing in SIDES:
        say_until_heard(sides[saying], sides[hearing], f"again from {saying}")
        assert sides[hearing].ask("received", "lasting_to_ros") == ["said before"] * 2
    nodes = sides["theirs"].ask("nodes")
    assert nodes.count(["/", "ours"]) == 1
    assert nodes == sides["ours"].ask("nodes")


def test_verbs_show_nodes_beyond_bridge(bridge, peer, monkeypatch):
    bridge()
    sides = start_both_sides(peer, "real_peer")
    say_until_heard(sides["theirs"], sides["ours"], "we know each other")
    monkeypatch.setenv("RMW_IMPLEMENTATION", RMW["ours"])
    assert {"/ours", "/theirs"} <= set(linkwright("node", "list")[0].splitlines())
    output = linkwright("topic", "info", "-v", "/images_from_ros")[0]
    assert "Publisher count: 1" in output
    assert "Node name: theirs" in output
    assert "Subscription count: 1" in output
    assert linkwright("param", "get", "/theirs", "speed")[0] == "Double value is: 1.5\n"
    called = linkwright("service", "call", "/theirs_flip", "std_srvs/srv/SetBool", "{data: false}")[0]
    assert "message='by ROS'" in called
