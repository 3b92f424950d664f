"""Large samples for readers of Fast DDS, sent packet by packet.

`test_real_ros` has a real reader.
"""

from __future__ import annotations

import os
import socket

from linkwright.graph.qos.profile import QoSProfile
from linkwright.messages import deserialize, get_message
from linkwright.wire.dds.engine import Engine
from linkwright.wire.dds.pacing import PacedWriter, Pacer, Receiver
from linkwright.wire.dds.rtps.messages import parse

Image = get_message("sensor_msgs/msg/Image")
ADDRESS = ("127.0.0.1", 7411)
WRITER, READER = bytes(range(16)), bytes(range(100, 116))
PACKET_BYTES = 60_832
"""The bytes that Linux charges to the buffer for a packet with a full fragment."""

SMALL, LARGE = bytes(100), os.urandom(150_000)


class Buffer:
    """A receive buffer with a sequence of fill levels.

    The sender reads the level once a packet.
    """

    def __init__(self, *levels):
        self.levels = list(levels)
        self.pauses = 0
        self.receiver = Receiver(ADDRESS, self.look, self.pause)
        self.receiver.begin()

    def look(self, port):
        assert port == ADDRESS[1]
        return self.levels.pop(0) if len(self.levels) > 1 else self.levels[0]

    def pause(self, _):
        self.pauses += 1


def test_three_packets_fit_in_empty_buffer_before_next_check():
    buffer = Buffer(0, 3 * PACKET_BYTES, 2 * PACKET_BYTES, PACKET_BYTES, 0)
    assert [buffer.receiver.wait_for_room() for _ in range(3)] == [True] * 3
    assert not buffer.pauses
    assert buffer.receiver.wait_for_room()
    assert buffer.pauses == 2


def test_blocked_reader_is_waited_for_once():
    buffer = Buffer(3 * PACKET_BYTES)
    assert not buffer.receiver.wait_for_room()
    pauses = buffer.pauses
    buffer.receiver.begin()
    assert not buffer.receiver.wait_for_room()
    assert buffer.pauses == pauses + 1
    buffer.levels = [0]
    buffer.receiver.begin()
    assert buffer.receiver.wait_for_room()


def test_unknown_buffer_state_pauses_every_second_packet():
    buffer = Buffer(None)
    assert all(buffer.receiver.wait_for_room() for _ in range(4))
    assert buffer.pauses == 2


def test_paced_sample_has_guid_of_writer():
    reader = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    reader.bind(("127.0.0.1", 0))
    reader.settimeout(60)
    pacer = Pacer(lambda _: reader.getsockname())
    places = pacer.find_addresses([READER])
    pacer.send(WRITER, 7, LARGE, 5_000_000_000, places)
    packets = [reader.recv(0x1_0000) for _ in range(3)]
    pacer.stop(0.0)
    reader.close()
    fragments = [text for packet in packets for text in parse(packet, READER[:12])]
    assert [(text.writer, text.sequence_number, text.first, text.size) for text in fragments] == [
        (WRITER, 7, number, len(LARGE)) for number in (1, 2, 3)
    ]
    assert {text.time for text in fragments} == {5_000_000_000}
    assert b"".join(text.payload for text in fragments) == LARGE
    assert not list(parse(packets[0], WRITER[:12]))  # other participants ignore the packet


class Sender:
    """A paced writer, with a log of the samples that its pacer sent and that it wrote."""

    def __init__(self, *, depth=10, readers=(READER,)):
        self.log = []
        self.works = True
        self.added_writers = 0
        self.readers = readers
        self.writer = PacedWriter(WRITER, depth, self.write, lambda: self.readers, self)

    def write(self, sample, published):
        self.log.append(("written", sample[0], published is None))
        return self.works

    def find_addresses(self, readers):
        return {reader[:12]: ADDRESS for reader in readers}

    def add(self, _):
        self.added_writers += 1

    def send(self, guid, number, sample, _published, places):
        assert (guid, places) == (WRITER, {READER[:12]: ADDRESS})
        self.log.append(("sent", sample[0], number))

    def publish(self, number, size):
        self.writer.write(bytes([number]) * size)

    def send_all(self):
        while self.writer.send_next():
            pass


def test_large_samples_are_sent_before_write_in_order():
    line = Sender()
    line.publish(1, len(SMALL))
    line.publish(2, len(LARGE))
    line.publish(3, len(SMALL))
    assert line.log == [("written", 1, True)]
    assert not line.writer.wait_until_written(0)
    line.send_all()
    assert line.log[1:] == [("sent", 2, 2), ("written", 2, False), ("written", 3, False)]
    assert line.writer.wait_until_written(0)
    assert line.added_writers == 1
    line.publish(4, len(SMALL))
    assert line.log[-1] == ("written", 4, True)


def test_newer_samples_replace_queued_ones():
    line = Sender(depth=2)
    for number in (1, 2, 3):
        line.publish(number, len(LARGE))
    line.send_all()
    assert line.log == [("sent", 2, 1), ("written", 2, False), ("sent", 3, 2), ("written", 3, False)]


def test_samples_are_written_at_once_without_fast_dds_readers():
    line = Sender(readers=())
    line.publish(1, len(LARGE))
    assert line.log == [("written", 1, True)]


def test_sequence_number_is_not_sent_with_two_samples():
    """Cyclone has not written sample 1, and will give that number to the next sample."""
    line = Sender()
    line.works = False
    line.publish(1, len(LARGE))
    line.send_all()
    line.works = True
    line.publish(2, len(LARGE))
    assert line.log == [("sent", 1, 1), ("written", 1, False), ("written", 2, True)]


def test_closed_writer_sends_nothing():
    line = Sender()
    line.publish(1, len(LARGE))
    line.writer.close()
    line.send_all()
    assert not line.log


def test_image_is_sent_packet_by_packet_before_cyclone(processes, monkeypatch):
    """An image is sent packet by packet.

    The test treats Cyclone's reader as a reader of Fast DDS, and listens on a socket in its place.
    """
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as listening:
        listening.bind(("127.0.0.1", 0))
        listening.settimeout(60)
        monkeypatch.setattr("linkwright.wire.dds.remote._FAST_DDS_VENDOR", b"\x01\x10")
        monkeypatch.setattr(Engine, "_find_fast_address", lambda *_: listening.getsockname())
        process, peer = processes("ours"), processes("theirs")
        messages = []
        subscription = peer.node.create_subscription(Image, "/picture", messages.append, QoSProfile(depth=10))
        publisher = process.node.create_publisher(Image, "/picture", QoSProfile(depth=10))
        process.spin_until(
            lambda: publisher.get_subscription_count() == process.node.count_subscribers("/picture") == 1
        )
        peer.spin_until(lambda: subscription.get_publisher_count() == 1)
        images = [Image(data=os.urandom(100_000)), Image(data=b"small"), Image(data=os.urandom(70_000))]
        fragments = []
        for image, packets in zip(images, (2, 0, 2), strict=True):
            publisher.publish(image)
            for _ in range(packets):
                fragments += parse(listening.recv(0x1_0000), subscription.gid[:12])
        assert publisher.wait_for_all_acked()
        peer.spin_until(lambda: len(messages) == 3)
        assert messages == images
    assert [(text.sequence_number, text.first) for text in fragments] == [(1, 1), (1, 2), (3, 1), (3, 2)]
    assert {text.writer for text in fragments} == {publisher.gid}
    paced = b"".join(text.payload for text in fragments[:2])
    assert deserialize(paced, Image) == images[0]
