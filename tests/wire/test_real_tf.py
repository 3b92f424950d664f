"""Transforms, and messages of a package of one's own, with nodes of real ROS 2; see `test_real_ros`.

The wheels of ROS 2 have neither: `tools/ros_types.py` makes them, in the folder that LINKWRIGHT_ROS_TYPES names.
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
from linkwright.standins.process import environment
from tests.wire.programs import linkwright

PYTHON = os.environ.get("LINKWRIGHT_ROS_PYTHON", "")
TYPES = os.environ.get("LINKWRIGHT_ROS_TYPES", "")
SEEDS = 6
SIDES = [("theirs", "ours"), ("ours", "theirs")]

pytestmark = pytest.mark.skipif(
    not (PYTHON and TYPES), reason="LINKWRIGHT_ROS_PYTHON and LINKWRIGHT_ROS_TYPES name no rclpy and no types for it"
)


@pytest.fixture
def theirs(programs):
    """Starts a program with the real rclpy and the types."""
    variables = {"PYTHONPATH": f"{TYPES}/python", "LD_LIBRARY_PATH": f"{TYPES}/lib"}
    return lambda name: programs(name, "theirs", python=PYTHON, RMW_IMPLEMENTATION="rmw_fastrtps_cpp", **variables)


def transform(parent, child, x):
    stamped = TransformStamped(child_frame_id=child)
    stamped.header.frame_id = parent
    stamped.transform.translation.x = x
    return stamped


def test_transform_chain_of_real_node_is_looked_up(processes, theirs):
    """Fixed and moving transforms; the fixed ones also by who comes late."""
    peer = theirs("tf_peer")
    peer.ask("tell", "/tf_static", "map", "odom", 1.0)
    process = processes("ours")
    buffer = Buffer()
    TransformListener(buffer, process.node)
    peer.ask("keep_telling", "odom", "base_link", 0.5)
    process.spin_until(lambda: buffer.can_transform("map", "base_link", Time()))
    assert buffer.lookup_transform("map", "base_link", Time()).transform.translation.x == 1.5
    assert process.node.get_publishers_info_by_topic("/tf")[0].qos_profile.durability.name == "VOLATILE"


def test_linkwright_transforms_are_received_by_real_node(processes, theirs):
    process = processes("ours")
    StaticTransformBroadcaster(process.node).sendTransform(
        [transform("map", "odom", 1.0), transform("base", "arm", 2.0)]
    )
    moving = TransformBroadcaster(process.node)
    peer = theirs("tf_peer")
    fixed = peer.ask_until(lambda heard: len(heard) == 2, "heard", "/tf_static")
    assert fixed == {"odom": ["map", 1.0], "arm": ["base", 2.0]}
    process.spin_until(lambda: moving.pub_tf.get_subscription_count() == 1)
    moving.sendTransform(transform("odom", "base", 0.25))
    assert peer.ask_until(bool, "heard", "/tf") == {"base": ["odom", 0.25]}
    assert all(
        type_hash("tf2_msgs/msg/TFMessage").removeprefix("RIHS01_") in text for text in peer.ask("hashes", "/tf")
    )


def test_verbs_show_transforms_of_real_node(theirs):
    peer = theirs("tf_peer")
    peer.ask("tell", "/tf_static", "map", "odom", 1.0)
    peer.ask("keep_telling", "odom", "base_link", 0.5)
    assert "child_frame_id: odom" in linkwright("topic", "echo", "--once", "/tf_static")[0]
    assert "child_frame_id: base_link" in linkwright("topic", "echo", "--once", "/tf")[0]


@pytest.mark.parametrize(("says", "hears"), SIDES)
def test_messages_and_services_of_custom_package(programs, tmp_path, says, hears):
    """Here they are read from the files, there they were compiled from them."""
    package = tmp_path / "src" / "wire_msgs"
    shutil.copytree(Path(__file__).parent / "types" / "wire_msgs", package)
    (package / "package.xml").write_text("<package format='3'><name>wire_msgs</name><version>1.0.0</version></package>")

    def start(side):
        if side == "ours":
            search = os.pathsep.join([environment()["PYTHONPATH"], str(Path(__file__).parents[2])])
            return programs("typed_peer", side, folder=tmp_path, PYTHONPATH=search)
        variables = {"PYTHONPATH": f"{TYPES}/python", "LD_LIBRARY_PATH": f"{TYPES}/lib"}
        return programs("typed_peer", side, python=PYTHON, RMW_IMPLEMENTATION="rmw_fastrtps_cpp", **variables)

    both = {side: start(side) for side in ("theirs", "ours")}
    types = ["wire_msgs/msg/Part", "wire_msgs/msg/Whole"]
    both[hears].ask("hear", types)
    both[says].ask("say", types, SEEDS)
    both[hears].ask_until(lambda counts: set(counts.values()) == {SEEDS}, "counts")
    for name in types:
        assert both[hears].ask("heard", name) == both[says].ask("meant", name, SEEDS)
    both[hears].ask("answer", ["wire_msgs/srv/Judge"])
    requests, responses = both[hears].ask("meant_by", "wire_msgs/srv/Judge", SEEDS)
    assert both[says].ask("ask", "wire_msgs/srv/Judge", SEEDS) == responses
    assert both[hears].ask("asked", "wire_msgs/srv/Judge") == requests
    if says == "ours":
        (message,) = set(both["theirs"].ask("hashes", "wire_msgs/msg/Whole"))
        assert message in both["ours"].ask("hashes", "wire_msgs/msg/Whole")
