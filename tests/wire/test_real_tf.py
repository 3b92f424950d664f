"""Transforms, and messages of a custom package, with nodes of real ROS 2.

See `test_real_ros`.

The wheels of ROS 2 have neither: `tools/ros_types.py` builds them in the folder that LINKWRIGHT_ROS_TYPES names.
"""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import pytest

from linkwright.graph.time.values import Time
from linkwright.graph.transforms.broadcaster import StaticTransformBroadcaster, TransformBroadcaster
from linkwright.graph.transforms.listener import TransformListener
from linkwright.graph.transforms.waiting import Buffer
from linkwright.messages import TransformStamped, type_hash
from linkwright.standins.process import create_environment
from tests.wire.programs import linkwright

PYTHON = os.environ.get("LINKWRIGHT_ROS_PYTHON", "")
TYPES = os.environ.get("LINKWRIGHT_ROS_TYPES", "")
SEED_COUNT = 6
SIDES = [("theirs", "ours"), ("ours", "theirs")]

pytestmark = pytest.mark.skipif(
    not (PYTHON and TYPES), reason="LINKWRIGHT_ROS_PYTHON and LINKWRIGHT_ROS_TYPES name no rclpy and no types for it"
)


@pytest.fixture
def start_real_program(programs):
    """Return a function that starts a program with the real rclpy and the types."""
    variables = {"PYTHONPATH": f"{TYPES}/python", "LD_LIBRARY_PATH": f"{TYPES}/lib"}
    return lambda name: programs(name, "theirs", python=PYTHON, RMW_IMPLEMENTATION="rmw_fastrtps_cpp", **variables)


def make_transform(parent, child, x):
    message = TransformStamped(child_frame_id=child)
    message.header.frame_id = parent
    message.transform.translation.x = x
    return message


def test_transform_chain_of_real_node_is_looked_up(processes, start_real_program):
    """Look up static and moving transforms; a late listener gets the static ones too."""
    peer = start_real_program("tf_peer")
    peer.ask("publish_transform", "/tf_static", "map", "odom", 1.0)
    process = processes("ours")
    buffer = Buffer()
    TransformListener(buffer, process.node)
    peer.ask("keep_publishing", "odom", "base_link", 0.5)
    process.spin_until(lambda: buffer.can_transform("map", "base_link", Time()))
    assert buffer.lookup_transform("map", "base_link", Time()).transform.translation.x == 1.5
    assert process.node.get_publishers_info_by_topic("/tf")[0].qos_profile.durability.name == "VOLATILE"


def test_linkwright_transforms_are_received_by_real_node(processes, start_real_program):
    process = processes("ours")
    StaticTransformBroadcaster(process.node).sendTransform(
        [make_transform("map", "odom", 1.0), make_transform("base", "arm", 2.0)]
    )
    moving_frames = TransformBroadcaster(process.node)
    peer = start_real_program("tf_peer")
    static_frames = peer.ask_until(lambda frames: len(frames) == 2, "received", "/tf_static")
    assert static_frames == {"odom": ["map", 1.0], "arm": ["base", 2.0]}
    process.spin_until(lambda: moving_frames.pub_tf.get_subscription_count() == 1)
    moving_frames.sendTransform(make_transform("odom", "base", 0.25))
    assert peer.ask_until(bool, "received", "/tf") == {"base": ["odom", 0.25]}
    assert all(
        type_hash("tf2_msgs/msg/TFMessage").removeprefix("RIHS01_") in text for text in peer.ask("hashes", "/tf")
    )


def test_verbs_show_transforms_of_real_node(start_real_program):
    peer = start_real_program("tf_peer")
    peer.ask("publish_transform", "/tf_static", "map", "odom", 1.0)
    peer.ask("keep_publishing", "odom", "base_link", 0.5)
    assert "child_frame_id: odom" in linkwright("topic", "echo", "--once", "/tf_static")[0]
    assert "child_frame_id: base_link" in linkwright("topic", "echo", "--once", "/tf")[0]


@pytest.mark.parametrize(("publisher_side", "subscriber_side"), SIDES)
def test_messages_and_services_of_custom_package(programs, tmp_path, publisher_side, subscriber_side):
    """Linkwright reads the types from their files; the real side has compiled ones."""
    package = tmp_path / "src" / "wire_msgs"
    shutil.copytree(Path(__file__).parent / "types" / "wire_msgs", package)
    (package / "package.xml").write_text("<package format='3'><name>wire_msgs</name><version>1.0.0</version></package>")

    def start(side):
        if side == "ours":
            search = os.pathsep.join([create_environment()["PYTHONPATH"], str(Path(__file__).parents[2])])
            return programs("typed_peer", side, folder=tmp_path, PYTHONPATH=search)
        variables = {"PYTHONPATH": f"{TYPES}/python", "LD_LIBRARY_PATH": f"{TYPES}/lib"}
        return programs("typed_peer", side, python=PYTHON, RMW_IMPLEMENTATION="rmw_fastrtps_cpp", **variables)

    peers_by_side = {side: start(side) for side in ("theirs", "ours")}
    types = ["wire_msgs/msg/Part", "wire_msgs/msg/Whole"]
    peers_by_side[subscriber_side].ask("subscribe", types)
    peers_by_side[publisher_side].ask("publish", types, SEED_COUNT)
    peers_by_side[subscriber_side].ask_until(lambda counts: set(counts.values()) == {SEED_COUNT}, "counts")
    for name in types:
        assert peers_by_side[subscriber_side].ask("received", name) == peers_by_side[publisher_side].ask(
            "expected", name, SEED_COUNT
        )
    peers_by_side[subscriber_side].ask("serve", ["wire_msgs/srv/Judge"])
    requests, responses = peers_by_side[subscriber_side].ask("expected_calls", "wire_msgs/srv/Judge", SEED_COUNT)
    assert peers_by_side[publisher_side].ask("call", "wire_msgs/srv/Judge", SEED_COUNT) == responses
    assert peers_by_side[subscriber_side].ask("requests", "wire_msgs/srv/Judge") == requests
    if publisher_side == "ours":
        (message,) = set(peers_by_side["theirs"].ask("hashes", "wire_msgs/msg/Whole"))
        assert message in peers_by_side["ours"].ask("hashes", "wire_msgs/msg/Whole")
