"""RTPS packets as bytes, and reliable delivery: every sample arrives once despite losses."""

from __future__ import annotations

import random

import pytest

from linkwright.wire.dds.rtps import discovery_data, values
from linkwright.wire.dds.rtps.messages import (
    FRAGMENT_SIZE,
    AckNack,
    Data,
    Gap,
    Heartbeat,
    NackFrag,
    acknack,
    build_message,
    data,
    parse,
)
from linkwright.wire.dds.rtps.reader import Reader
from linkwright.wire.dds.rtps.writer import Writer

LINKWRIGHT_PREFIX, FAST_DDS_PREFIX = b"LW" + bytes(10), b"\x01\x0f" + bytes(range(10))
AT = (("127.0.0.1", 7411),)
WRITER, READER = LINKWRIGHT_PREFIX + b"\0\0\1\3", FAST_DDS_PREFIX + b"\0\0\1\4"


def test_fast_dds_request_is_parsed():
    packet = bytes.fromhex(
        "52545053 0203 010f 010f000102030405060708 09".replace(" ", "")  # header, version 2.3, eProsima
        + "09010800 05000000 00000080".replace(" ", "")  # INFO_TS: 5.5 s
        + "15074000 0000 1000 00000104 00000203 00000000 2a000000".replace(" ", "")  # DATA: to inline QoS, 42
        + "83001800 010f0001020304050607080900000304 ffffffff 00000000".replace(" ", "")  # related_sample_identity
        + "01000000".replace(" ", "")
        + "00010000 01000000".replace(" ", "")
    )
    (parsed,) = parse(packet[:20] + packet[20:], LINKWRIGHT_PREFIX)
    assert isinstance(parsed, Data)
    assert (parsed.writer, parsed.reader, parsed.sequence_number) == (FAST_DDS_PREFIX + b"\0\0\2\3", b"\0\0\1\4", 42)
    assert parsed.time == 5_500_000_000
    assert parsed.payload == bytes.fromhex("0001000001000000")
    assert values.read_related_identity(parsed.inline, parsed.order) == (
        FAST_DDS_PREFIX + b"\0\0\3\4",
        values.NO_NUMBER,
    )


def test_reply_identity_uses_both_fast_dds_parameters():
    inline = values.encode_related_identity(READER, (3 << 32) + 5)
    identity = READER + bytes.fromhex("0300000005000000")
    assert inline == b"\x83\0\x18\0" + identity + b"\x0f\x80\x18\0" + identity + b"\1\0\0\0"


def test_acknack_lists_missing_samples():
    packet = build_message(FAST_DDS_PREFIX, acknack(READER[12:], WRITER[12:], 40, [41, 72], 1), to=LINKWRIGHT_PREFIX)
    (parsed,) = parse(packet, LINKWRIGHT_PREFIX)
    assert parsed == AckNack(FAST_DDS_PREFIX, READER, WRITER[12:], 40, [41, 72], final=True)


@pytest.mark.parametrize("cut", range(4, 100, 3))
def test_truncated_packet_is_not_misread(cut):
    packet = build_message(
        FAST_DDS_PREFIX, data(b"\0\0\1\4", b"\0\0\2\3", 1, b"\0\1\0\0hej!", values.encode_related_identity(READER, 1))
    )
    for text in parse(packet[:cut], LINKWRIGHT_PREFIX):
        assert isinstance(text, Data)


def test_corrupted_packets_do_not_raise():
    noise = random.Random(5)
    complete_packet = build_message(
        FAST_DDS_PREFIX, data(b"\0\0\1\4", b"\0\0\2\3", 1, b"\0\1\0\0hej!", values.encode_related_identity(READER, 1))
    )
    for _ in range(2000):
        packet = bytearray(complete_packet)
        for _ in range(noise.randrange(1, 6)):
            packet[noise.randrange(20, len(packet))] = noise.randrange(256)
        list(parse(bytes(packet), LINKWRIGHT_PREFIX))


def test_messages_for_other_participants_are_ignored():
    packet = build_message(FAST_DDS_PREFIX, data(b"\0\0\1\4", b"\0\0\2\3", 1, b"\0\1\0\0"), to=b"somebody els")
    assert list(parse(packet, LINKWRIGHT_PREFIX)) == []


def test_endpoint_data_round_trips():
    result = discovery_data.describe_endpoint(WRITER, "rr/flipReply", "std_srvs::srv::dds_::SetBool_Response_", b"a=b;")
    read = discovery_data.read_endpoint(result, is_writer=True)
    assert read == discovery_data.EndpointData(
        WRITER, "rr/flipReply", "std_srvs::srv::dds_::SetBool_Response_", True, ()
    )
    spdp = discovery_data.describe_participant(LINKWRIGHT_PREFIX, "us", 10.0, list(AT))
    assert discovery_data.read_participant(spdp) == discovery_data.ParticipantData(
        LINKWRIGHT_PREFIX, values.OWN_VENDOR, 10.0, AT, AT
    )


class _LossyLink:
    """A writer of Linkwright and a reader of Fast DDS; the packets between them may get lost."""

    def __init__(self, loss, seed=1):
        self.writer, self.reader = Writer(WRITER), Reader(READER)
        self.loss, self.random = loss, random.Random(seed)
        self.received = []
        self.carry(self.reader.match(WRITER, AT) + self.writer.match(READER, AT))

    def carry(self, packets):
        queue = list(packets)
        while queue:
            packet, _ = queue.pop(0)
            if self.random.random() < self.loss:
                continue
            for submessage in parse(
                packet, FAST_DDS_PREFIX if packet[8:20] == LINKWRIGHT_PREFIX else LINKWRIGHT_PREFIX
            ):
                queue += self._receive(submessage)

    def _receive(self, submessage):
        if isinstance(submessage, AckNack):
            return self.writer.on_acknack(submessage)
        if isinstance(submessage, NackFrag):
            return self.writer.on_nack_frag(submessage)
        if isinstance(submessage, Heartbeat):
            return self.reader.on_heartbeat(submessage)
        if isinstance(submessage, Gap):
            self.reader.on_gap(submessage)
            return []
        sample = self.reader.on_data(submessage)
        self.received += [] if sample is None else [(sample.sequence_number, sample.payload)]
        return []

    def settle(self):
        time = 1e9
        for _ in range(400):
            time += 10
            self.carry(self.writer.remind(time))
            if self.writer.next_reminder() is None:
                return
        raise AssertionError("never acknowledged")


@pytest.mark.parametrize("loss", [0.0, 0.3, 0.6])
def test_samples_arrive_once_despite_loss(loss):
    line = _LossyLink(loss)
    for number in range(50):
        line.carry(line.writer.write(b"\0\1\0\0" + number.to_bytes(4, "little")))
    line.settle()
    assert sorted(line.received) == [(n + 1, b"\0\1\0\0" + n.to_bytes(4, "little")) for n in range(50)]


@pytest.mark.parametrize("loss", [0.0, 0.3])
def test_fragments_are_reassembled(loss):
    line = _LossyLink(loss)
    payload = random.Random(2).randbytes(FRAGMENT_SIZE * 7 + 12)
    line.carry(line.writer.write(payload, inline=values.encode_related_identity(READER, 9)))
    line.settle()
    assert line.received == [(1, payload)]


def test_sample_for_other_reader_is_not_waited_for():
    line = _LossyLink(0.0)
    line.carry(line.writer.write(b"\0\1\0\0", to=b"somebody els"))
    line.carry(line.writer.write(b"\0\1\0\0mine", to=FAST_DDS_PREFIX))
    assert line.received == [(2, b"\0\1\0\0mine")]
    assert line.writer.next_reminder() is None


def test_late_reader_gets_no_earlier_samples():
    writer = Writer(WRITER)
    for _ in range(3):
        writer.write(b"\0\1\0\0")
    ((packet, _),) = writer.match(READER, AT)
    (parsed,) = parse(packet, FAST_DDS_PREFIX)
    assert (parsed.first, parsed.last) == (4, 3)
