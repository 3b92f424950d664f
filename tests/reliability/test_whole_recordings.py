"""Recordings are complete after any signal.

The tests cover an event loop that hangs, a second Ctrl-C, and SIGTERM.
"""

from __future__ import annotations

import signal
import time

import pytest

from linkwright.bag import BagReader
from tests.recordings import needs_rosbags
from tests.reliability.running import Machine, launch_file_text
from tests.waiting import wait_until

pytestmark = needs_rosbags

HANGING = """
import asyncio, sys
from linkwright.bag import BagWriter
from linkwright.cli.session import Session
from linkwright.graph import Graph
from linkwright.hosting import signals
from linkwright.messages import String, serialize

signals._DEADLINE_S = 0.1
watch = signals.SignalWatch()

async def main():
    graph = Graph()
    watch.session = Session(graph, graph.create_node("hanging"))
    writer = BagWriter(sys.argv[1], sys.argv[2])
    writer.add_topic("/chatter", "std_msgs/msg/String")
    data, number = serialize(String(data="word " * 50)), 0
    while True:  # the event loop never runs again
        number += 1
        writer.write("/chatter", number, data)
        if number == 1000:
            print("writing", flush=True)

with watch:
    watch.run(main)
"""
FLOOD = """
class Program(Node):
    def __init__(self):
        super().__init__("talker")
        self.publisher = self.create_publisher(String, "chatter", 10)
        self.create_timer(0.001, lambda: self.publisher.publish(String(data="word " * 1000)))
"""


def count_messages(path) -> int:
    """Return the number of messages in a complete recording."""
    with BagReader(path) as bag:
        message_count = sum(1 for _ in bag.messages())
        assert not bag.findings
    return message_count


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_recording_is_complete_if_event_loop_hangs(machine: Machine, storage: str, number: int) -> None:
    running = machine.python(machine.write("hanging.py", HANGING), machine.folder / "bag", storage)
    running.wait_for("writing")
    running.process.send_signal(number)
    assert running.wait() == 128 + number, running.text
    assert count_messages(machine.folder / "bag") >= 1000


@pytest.mark.slow
@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
@pytest.mark.parametrize("signals", [[signal.SIGINT], [signal.SIGINT] * 2, [signal.SIGINT] * 4, [signal.SIGTERM]])
def test_bag_record_is_complete_after_any_signal(machine: Machine, storage: str, signals: list[int]) -> None:
    machine.program(FLOOD)
    recording = machine.command("bag", "record", "-a", "-o", "bag", "-s", storage)
    recording.wait_for("Subscribed to topic '/chatter'")
    folder = machine.folder / "bag"
    wait_until(lambda: sum(path.stat().st_size for path in folder.iterdir()) > 1_000_000, what=lambda: recording.text)
    for stop_signal in signals:
        recording.process.send_signal(stop_signal)
        time.sleep(0.35)  # signals within a shorter time count as one keypress
        if recording.process.poll() is not None:
            break
    recording.wait()
    assert "Traceback" not in recording.text
    assert count_messages(folder) > 100


@pytest.mark.slow
def test_recording_started_by_launch_is_complete(machine: Machine) -> None:
    machine.program(FLOOD)
    record = "ExecuteProcess(cmd=['ros2', 'bag', 'record', '-a', '-o', 'bag'], output='screen')"
    launch = machine.launch(machine.write("a.launch.py", launch_file_text(record)))
    launch.wait_for("Subscribed to topic '/chatter'")
    folder = machine.folder / "bag"
    wait_until(lambda: sum(path.stat().st_size for path in folder.iterdir()) > 1_000_000, what=lambda: launch.text)
    launch.interrupt()
    assert count_messages(folder) > 100
