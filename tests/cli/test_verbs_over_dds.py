"""The commands in separate processes that communicate over DDS."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from linkwright.wire import dds
from tests.begun import BEGUN, command_that_reports
from tests.domains import own_domain
from tests.waiting import TIMEOUT_S, wait_until

pytestmark = pytest.mark.skipif(not dds.is_available(), reason="cyclonedds is not installed")

TALKER = """
import asyncio
from linkwright.graph import Graph
from linkwright.messages import String
from linkwright.wire import dds

async def main():
    graph = Graph()
    node = graph.create_node("talker")
    node.declare_parameter("speed", 1.5)
    publisher = node.create_publisher(String, "chatter", 10)
    count = 0
    def publish():
        nonlocal count
        count += 1
        publisher.publish(String(data=f"Hello {count}"))
    node.create_timer(0.02, publish)
    node.create_service("std_srvs/srv/SetBool", "power", lambda request, response: response)
    dds.join(graph).wait_until_ready(60)
    print("ready", flush=True)
    await asyncio.sleep(3600)

asyncio.run(main())
"""


def environment() -> dict[str, str]:
    return {**os.environ, "ROS_DOMAIN_ID": str(own_domain()), "LINKWRIGHT_LANG": "en"}


@pytest.fixture(scope="module")
def talker() -> Iterator[None]:
    process = subprocess.Popen([sys.executable, "-c", TALKER], stdout=subprocess.PIPE, text=True, env=environment())
    assert process.stdout is not None
    assert process.stdout.readline() == "ready\n"
    yield
    process.kill()
    process.wait()
    process.stdout.close()


def linkwright(*words: str, timeout: float = TIMEOUT_S, status: int = 0) -> str:
    result = subprocess.run(
        [sys.executable, "-m", "linkwright", *words],
        capture_output=True,
        text=True,
        env=environment(),
        timeout=timeout,
        check=False,
    )
    assert result.returncode == status, result.stderr
    return result.stdout


def begin(*words: str) -> subprocess.Popen[str]:
    return start([sys.executable, "-m", "linkwright", *words])


def start(command: list[str]) -> subprocess.Popen[str]:
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment())


@pytest.mark.usefixtures("talker")
class TestTalkerGraph:
    def test_node_and_topic_list_show_talker(self):
        assert linkwright("node", "list") == "/talker\n"
        assert "/chatter [std_msgs/msg/String]\n" in linkwright("topic", "list", "-t")

    def test_echo_once_prints_one_message(self):
        assert re.fullmatch(r"data: Hello \d+\n---\n", linkwright("topic", "echo", "--once", "/chatter"))

    def test_param_get_and_set_reach_node(self):
        assert linkwright("param", "get", "/talker", "speed") == "Double value is: 1.5\n"
        assert linkwright("param", "set", "/talker", "speed", "2.5") == "Set parameter successful\n"
        assert linkwright("param", "get", "/talker", "speed") == "Double value is: 2.5\n"

    def test_service_call_reaches_server(self):
        output = linkwright("service", "call", "/power", "std_srvs/srv/SetBool", "{data: true}")
        assert "std_srvs.srv.SetBool_Response(success=False, message='')" in output

    def test_interrupted_echo_exits_immediately_with_130(self):
        process = begin("topic", "echo", "/chatter")
        assert process.stdout is not None
        assert process.stdout.readline().startswith("data: Hello")
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=TIMEOUT_S)
        assert process.returncode == 130
        assert err == ""

    def test_interrupt_during_startup_exits_with_130(self):
        for delay in (0.0, 0.05, 0.15, 0.3, 0.5):
            process = start(command_that_reports("linkwright", "topic", "hz", "/chatter"))
            assert process.stdout is not None
            assert process.stdout.readline() == f"{BEGUN}\n"
            time.sleep(delay)
            process.send_signal(signal.SIGINT)
            out, err = process.communicate(timeout=TIMEOUT_S)
            assert process.returncode == 130, (delay, out, err)
            assert "Traceback" not in err, (delay, err)

    def test_sigterm_removes_node_from_graph(self):
        process = begin("topic", "echo", "/chatter")
        assert process.stdout is not None
        process.stdout.readline()
        process.terminate()
        _, err = process.communicate(timeout=TIMEOUT_S)
        assert process.returncode == 143
        assert err == ""

    def test_closed_pipe_is_not_an_error(self):
        command = f"{sys.executable} -m linkwright topic echo /chatter | head -n 3"
        result = subprocess.run(
            ["bash", "-o", "pipefail", "-c", command],
            capture_output=True,
            text=True,
            env=environment(),
            timeout=60,
            check=False,
        )
        assert len(result.stdout.splitlines()) == 3
        assert result.stderr == ""


def test_pub_reaches_earlier_echo():
    echo = begin("topic", "echo", "/orders", "std_msgs/msg/String", "--once", "--timeout", "15")
    output = linkwright("topic", "pub", "--once", "/orders", "std_msgs/msg/String", "data: go")
    assert "publishing #1: std_msgs.msg.String(data='go')" in output
    out, _ = echo.communicate(timeout=60)
    assert out == "data: go\n---\n"


def test_latched_description_reaches_late_echo():
    words = ["topic", "pub", "/robot_description", "std_msgs/msg/String", "data: <robot/>"]
    publisher = begin(*words, "--qos-durability", "transient_local", "-r", "0.01")
    assert publisher.stdout is not None
    publisher.stdout.readline()
    try:
        assert linkwright("topic", "echo", "--once", "/robot_description") == "data: <robot/>\n---\n"
    finally:
        publisher.send_signal(signal.SIGINT)
        publisher.communicate(timeout=TIMEOUT_S)


def test_recording_of_unknown_type_is_played_and_echoed_raw(tmp_path: Path):
    from rosbags.rosbag2 import StoragePlugin, Writer  # like DDS, it has no wheel for Python 3.15
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    store.register(get_types_from_msg("float64 depth\nstd_msgs/Header header\n", "soil_msgs/msg/Probe"))
    probe, header = store.types["soil_msgs/msg/Probe"], store.types["std_msgs/msg/Header"]
    stamp = store.types["builtin_interfaces/msg/Time"](sec=7, nanosec=0)
    with Writer(tmp_path / "bag", version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        connection = writer.add_connection("/probe", probe.__msgtype__, typestore=store)
        data = store.serialize_cdr(probe(depth=1.5, header=header(stamp, "drill")), probe.__msgtype__)
        for number in range(10):
            writer.write(connection, number * 50_000_000, data)
    player = begin("bag", "play", "--loop", str(tmp_path / "bag"))
    try:
        wait_until(lambda: "/probe [soil_msgs/msg/Probe]" in linkwright("topic", "list", "-t"))
        raw = linkwright("topic", "echo", "--once", "--raw", "/probe")
        assert raw.startswith(repr(bytes(data))[:-1]), "the sent data is padded to whole words"
        linkwright("topic", "echo", "--once", "/probe", status=1)  # this process does not know the type's fields
        rate = begin("topic", "hz", "/probe")
        assert rate.stdout is not None
        assert rate.stdout.readline().startswith("average rate: ")
        rate.send_signal(signal.SIGINT)
        rate.communicate(timeout=TIMEOUT_S)
    finally:
        player.terminate()
        _, err = player.communicate(timeout=TIMEOUT_S)
    assert "is not played" not in err
    assert "Traceback" not in err
    assert player.returncode == 143


def test_doctor_finds_problems_of_other_processes():
    publisher = begin("topic", "pub", "/way", "geometry_msgs/msg/Twist", "-n", "teleop")
    other = begin("topic", "echo", "/way", "geometry_msgs/msg/TwistStamped")
    try:
        assert publisher.stdout is not None
        publisher.stdout.readline()
        result = subprocess.run(
            [sys.executable, "-m", "linkwright", "doctor", "--seconds", "1", "--format", "json"],
            capture_output=True,
            text=True,
            env=environment(),
            timeout=60,
            check=False,
        )
        codes = [diagnostic["code"] for diagnostic in json.loads(result.stdout)["diagnostics"]]
        # The subscription of a command is ignored, but the publisher is not: an empty graph would be reported.
        assert codes == []
    finally:
        for process in (publisher, other):
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=TIMEOUT_S)
