"""Recording what nodes of real ROS 2 publish, and playing to them; see `test_real_ros`."""

from __future__ import annotations

import os
import signal
import subprocess
import sys

import pytest

from tests.wire.programs import linkwright

PYTHON = os.environ.get("LINKWRIGHT_ROS_PYTHON", "")
IMAGE_COUNT = 30
STATE_COUNT = 100

pytestmark = pytest.mark.skipif(not PYTHON, reason="LINKWRIGHT_ROS_PYTHON names no interpreter with rclpy")


@pytest.fixture
def start_real_node(programs):
    return lambda: programs("real_peer", "real_node", python=PYTHON, RMW_IMPLEMENTATION="rmw_fastrtps_cpp")


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_bag_records_real_node_and_plays_to_it(start_real_node, tmp_path, storage):
    """Record images, joint states and earlier latched messages, each once and in order."""
    bag = tmp_path / "bag"
    real = start_real_node()
    topics = ["/states_from_ros", "/images_from_ros", "/lasting_from_ros"]
    command = [sys.executable, "-m", "linkwright", "bag", "record", "-o", str(bag), "-s", storage, *topics]
    with subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL) as recording:
        for kind in ("states_", "images_", "lasting_"):
            real.ask_until(lambda count: count == 1, "subscription_count", kind)
        for number in range(STATE_COUNT):
            real.ask("publish_state", ["a", "b"], [float(number), 0.5])
        real.ask("publish_images", IMAGE_COUNT, 10.0)
        real.ask_until(lambda sent: sent == IMAGE_COUNT, "sent_images")
        real.ask("wait_for_all", "images_")
        real.ask("wait_for_all", "states_")
        recording.send_signal(signal.SIGINT)
        assert recording.wait(60) == 0
    assert f"Count: {STATE_COUNT} |" in info_line(bag, "/states_from_ros")
    assert f"Count: {IMAGE_COUNT} |" in info_line(bag, "/images_from_ros")
    assert "Count: 1 |" in info_line(bag, "/lasting_from_ros")
    remapped = [f"{topic}:={topic.replace('from', 'to')}" for topic in topics]
    command = [sys.executable, "-m", "linkwright", "bag", "play", str(bag), "--start-paused", "--remap", *remapped]
    with subprocess.Popen(command, stdin=subprocess.DEVNULL) as playing:
        for topic in topics:
            real.ask_until(lambda count: count == 1, "publisher_count", topic.replace("from", "to"))
        resumed = linkwright("service", "call", "/rosbag2_player/resume", "rosbag2_interfaces/srv/Resume")
        assert resumed[2] == 0, resumed
        assert playing.wait(60) == 0
    states = real.ask_until(lambda heard: len(heard) == STATE_COUNT, "received_states")
    assert states == [[["a", "b"], [float(number), 0.5]] for number in range(STATE_COUNT)]
    assert real.ask_until(lambda heard: len(heard) == IMAGE_COUNT, "received_images") == list(range(IMAGE_COUNT))
    assert real.ask_until(bool, "received", "lasting_to_ros") == ["said before"]


def info_line(bag, topic):
    """Return the line of ``bag info`` about a topic."""
    return next(line for line in linkwright("bag", "info", str(bag))[0].splitlines() if f"{topic} " in line)
