"""The backlog of a writer: which samples wait for acknowledgments, and which are replaced."""

from __future__ import annotations

from linkwright.graph.qos.profile import QoSProfile
from linkwright.messages import get_message
from linkwright.wire.dds.backlog import ACKNOWLEDGMENT_TIMEOUT_S, Backlog

UInt8MultiArray = get_message("std_msgs/msg/UInt8MultiArray")
SMALL_BYTES, LARGE_BYTES = 100, 1000
HISTORY_DEPTH = 2


class Writer:
    """A writer with a queue of two samples.

    The test decides when its readers have acknowledged.
    """

    def __init__(self) -> None:
        self.written: list[int] = []
        self.acknowledged = False
        self.matters = True
        self.now = 0.0
        self.backlog = Backlog(
            HISTORY_DEPTH,
            SMALL_BYTES,
            lambda sample: self.written.append(sample[0]),
            lambda: self.acknowledged,
            lambda: self.matters,
            lambda: self.now,
        )

    def send(self, *numbers: int, size: int = LARGE_BYTES) -> bool:
        return [self.backlog.send(bytes([number]) * size) for number in numbers][-1]


def test_large_samples_in_flight_are_limited_by_history_depth():
    writer = Writer()
    assert not writer.send(1, 2)
    assert writer.send(3)
    assert writer.written == [1, 2]
    writer.acknowledged = True
    assert not writer.backlog.write_queued()
    assert writer.written == [1, 2, 3]


def test_newer_samples_replace_queued_ones():
    writer = Writer()
    assert writer.send(1, 2, 3, 4, 5)
    writer.acknowledged = True
    assert not writer.backlog.write_queued()
    assert writer.written == [1, 2, 4, 5]


def test_small_samples_alone_are_not_queued():
    writer = Writer()
    assert not writer.send(1, 2, 3, 4, size=SMALL_BYTES)
    assert writer.written == [1, 2, 3, 4]


def test_small_samples_do_not_overtake_or_replace_large_ones():
    writer = Writer()
    writer.send(1)
    assert writer.send(2, 3, size=SMALL_BYTES)
    assert writer.written == [1, 2]
    writer.acknowledged = True
    writer.send(4, size=SMALL_BYTES)
    assert writer.written == [1, 2, 3, 4]


def test_samples_are_not_queued_without_fast_dds_readers():
    writer = Writer()
    writer.matters = False
    assert not writer.send(1, 2, 3, 4)
    assert writer.written == [1, 2, 3, 4]


def test_unresponsive_reader_delays_topic_once():
    writer = Writer()
    assert writer.send(1, 2, 3)
    writer.now = ACKNOWLEDGMENT_TIMEOUT_S
    assert not writer.backlog.write_queued()
    assert not writer.send(4, 5)
    assert writer.written == [1, 2, 3, 4, 5]
    writer.acknowledged = True
    writer.send(6)
    writer.acknowledged = False
    writer.send(7)
    assert writer.send(8)


def test_queued_samples_are_written_after_acknowledgment(processes, monkeypatch):
    a, b = processes("a"), processes("b")
    monkeypatch.setattr(a.transport._remote, "is_read_by_fast", lambda topic: True)
    numbers: list[int] = []
    newest = QoSProfile(1)
    b.node.create_subscription(UInt8MultiArray, "pictures", lambda message: numbers.append(message.data[0]), 10)
    publisher = a.node.create_publisher(UInt8MultiArray, "pictures", newest)
    b.spin_until(lambda: publisher.get_subscription_count() == 1)
    for number in range(1, 21):
        publisher.publish(UInt8MultiArray(data=bytes([number]) * 1_000_000))
    b.spin_until(lambda: numbers and numbers[-1] == 20)
    assert numbers == sorted(numbers)
    publisher.publish(UInt8MultiArray(data=bytes([21]) * 1_000_000))
    publisher.publish(UInt8MultiArray(data=bytes([22]) * 1_000_000))
    assert publisher.wait_for_all_acked()
    b.spin_until(lambda: numbers[-1] == 22)
