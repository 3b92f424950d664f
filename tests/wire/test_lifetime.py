"""The lifetime of a participant: threads, sockets, forks and exits."""

from __future__ import annotations

import os
import subprocess
import sys
import textwrap
import threading
import time
from pathlib import Path
from typing import Any

import pytest

from linkwright.graph.qos.profile import QoSProfile
from linkwright.messages import String, get_message
from tests.waiting import TIMEOUT_S, wait_until

pytest.importorskip("cyclonedds", reason="cyclonedds is not installed")

on_linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="the test reads /proc")


def run_program(text: str, seconds: float = TIMEOUT_S) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", textwrap.dedent(text)], capture_output=True, text=True, timeout=seconds, check=False
    )


def open_descriptors() -> set[str]:
    return {str(path.readlink()) for path in Path("/proc/self/fd").iterdir() if path.is_symlink()}


def kernel_threads() -> int:
    return len(list(Path("/proc/self/task").iterdir()))


@on_linux
def test_close_leaves_no_threads_or_sockets(processes):
    processes("warm").close()
    threads, sockets = (
        threading.active_count(),
        {descriptor for descriptor in open_descriptors() if descriptor.startswith("socket")},
    )
    tasks = kernel_threads()
    process = processes("ours")
    process.node.create_publisher(String, "chatter", 10)
    assert kernel_threads() > tasks
    process.close()
    assert threading.active_count() == threads
    assert {descriptor for descriptor in open_descriptors() if descriptor.startswith("socket")} == sockets
    wait_until(lambda: kernel_threads() <= tasks)  # the kernel lists a joined thread a moment longer


def test_close_twice_and_before_ready_is_allowed(processes):
    process = processes("ours", join_now=False)
    from linkwright.wire.dds import join

    transport = join(process.graph)
    transport.close()
    transport.close()
    assert transport.remote_nodes() == []


def test_domain_joined_after_close_is_left_again(processes, monkeypatch):
    from linkwright.wire import background
    from linkwright.wire.dds import engine, join, open_domains

    may_join, engines = threading.Event(), []

    class Late(engine.Engine):
        def __init__(self, *arguments: Any) -> None:
            assert may_join.wait(TIMEOUT_S)
            super().__init__(*arguments)
            engines.append(self)

    monkeypatch.setattr(engine, "Engine", Late)
    monkeypatch.setattr(background, "_JOIN_TIMEOUT_S", 0.0)
    process = processes("ours", join_now=False)
    joining = join(process.graph)
    joining.close()
    assert not engines
    may_join.set()
    joining._join_thread.join(TIMEOUT_S)
    assert [engine._participant.closed for engine in engines] == [True]
    assert open_domains._opened == {}
    assert not joining.wait_until_ready(TIMEOUT_S)


@pytest.mark.parametrize("seconds", [0.0, 0.05, 0.1, 0.15, 0.2])
def test_program_that_ends_while_joining_prints_nothing(seconds):
    result = run_program(
        f"""
        import asyncio, time
        from linkwright.graph import Graph
        from linkwright.wire import dds

        async def main():
            dds.join(Graph())
            time.sleep({seconds})

        asyncio.run(main())
        """
    )
    assert (result.returncode, result.stdout, result.stderr) == (0, "", "")


def test_close_ends_wait_for_discovery(processes):
    process = processes("ours")
    ended = threading.Event()

    def wait() -> None:
        process.transport._joined_at = time.monotonic() + 10_000.0  # the discovery does not settle
        process.transport.wait_for_discovery(10_000.0)
        process.transport.wait_until_ready(10_000.0)
        ended.set()

    waiting = threading.Thread(target=wait, daemon=True)
    waiting.start()
    process.close()
    assert ended.wait(TIMEOUT_S)


def test_reliable_messages_sent_before_close_arrive(processes):
    b = processes("b")
    numbers: list[int] = []
    deep_qos = QoSProfile(500)
    b.node.create_subscription("std_msgs/msg/Int32", "chatter", lambda message: numbers.append(message.data), deep_qos)
    a = processes("a")
    publisher = a.node.create_publisher("std_msgs/msg/Int32", "chatter", deep_qos)
    a.spin_until(lambda: publisher.get_subscription_count() == 1)
    for number in range(300):
        publisher.publish(get_message("std_msgs/msg/Int32")(data=number))
    a.close()
    b.spin_until(lambda: len(numbers) == 300)


def test_program_without_close_ends(domain):
    result = run_program(
        """
        from linkwright.graph import Graph
        from linkwright.wire.dds import join
        from linkwright.messages import String
        graph = Graph(threads=True)
        publisher = graph.create_node("ours").create_publisher(String, "chatter", 10)
        transport = join(graph)
        assert transport.wait_until_ready(60)
        """
    )
    assert (result.returncode, result.stderr) == (0, "")


def test_failing_program_ends(domain):
    result = run_program(
        """
        from linkwright.graph import Graph
        from linkwright.wire.dds import join
        graph = Graph(threads=True)
        transport = join(graph)
        raise SystemExit(3)
        """
    )
    assert (result.returncode, result.stderr) == (3, "")


def test_packets_that_are_not_dds_print_nothing_to_stderr(domain):
    result = run_program(
        """
        import os, socket, time
        from linkwright.graph import Graph
        from linkwright.wire.dds import join
        graph = Graph(threads=True)
        assert join(graph).wait_until_ready(60)
        first = 7400 + 250 * int(os.environ["ROS_DOMAIN_ID"])
        header = b"RTPS\\x02\\x01\\x01\\x10" + bytes(12)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            for data in (b"hello", header + b"\\xa0\\x45" + bytes(60), header + b"\\x15\\x01\\x40\\x00" + bytes(9)):
                for port in range(first, first + 30):
                    sender.sendto(data, ("127.0.0.1", port))
        time.sleep(0.3)
        graph.close_threadsafe()
        """
    )
    assert (result.returncode, result.stderr) == (0, "")


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_forked_child_does_not_participate(processes, programs):
    process = processes("ours")
    process.node.create_subscription("std_msgs/msg/Int32", "/flood", print, 10)
    other = programs("linkwright_program", "forking")
    other.ask_until(bool, "subscribers", "/flood")
    assert other.ask("fork")[0] == 7
    assert other.ask("nodes") == ["forking", "ours"]


def test_killed_peer_does_not_block_publisher(processes, programs):
    process = processes("ours")
    publisher = process.node.create_publisher(String, "/to_ros", 10)
    peer = programs("ros_peer", "humble", "victim", "localhost")
    process.spin_until(lambda: publisher.get_subscription_count() == 1)
    peer.kill()
    begin = time.monotonic()
    for _ in range(2000):
        publisher.publish(String(data="x" * 1000))
    process.close()
    assert time.monotonic() - begin < TIMEOUT_S, "messages must not wait one by one"
