"""Packets of MAVLink: bytes that pymavlink 2.4.50 decodes and encodes, and streams."""

from __future__ import annotations

import pytest

from linkwright.simulation.plugins.autopilots.mavlink import (
    AirSample,
    Controls,
    GpsSample,
    MavlinkReader,
    MavlinkWriter,
    SensorSample,
    StateSample,
    compute_checksum,
)

TIME_US = 123456789
PLACE = (47.397742, 8.545594, 488.5)
SENSOR = (
    "fd3e00000001c86b000015cd5b07000000000000c03f000000c000001c41cdcccc3dcdcc4c3e9a9999becdcc4c3e0ad7233ccdcccc3e00806d"
    "440000003e0000fa4300004041ff1f4d66"
)
GPS = "fd2400000101c871000015cd5b07000000004c52401c44f417053474070064006400e000640038ff32000474030a82a3"
STATE = (
    "fd3a00000201c873000015cd5b07000000000000803f00000000000000000000003fcdcccc3dcdcc4c3e9a99993e4c52401c44f41705347407"
    "00640038ff32002c012c019a8e"
)
ARMED = bytes.fromhex(
    "fd5100000001015d000088130000000000000100000000000000000000000000803d0000003e0000403e0000803e0000a03e0000c03e0000e0"
    "3e0000003f0000103f0000203f0000303f0000403f0000503f0000603f0000703f80118f"
)
DISARMED_1 = bytes.fromhex(
    "fe510001015d881300000000000000000000000000000000803f00000000000000000000000000000000000000000000000000000000000000"
    "000000000000000000000000000000000000000000000000000000000000a59b"
)
"""Commands in the version 1 of MAVLink."""
HEARTBEAT = bytes.fromhex("fd09000000010100000000000000020c000003d7de")
ARMED_CONTROLS = Controls(tuple(index / 16 for index in range(16)), is_armed=True)


def test_packets_are_those_that_pymavlink_decodes():
    writer, velocity = MavlinkWriter(), (1.0, -2.0, 0.5)
    air = AirSample(95000.0, 500.0, 12.0)
    sample = SensorSample((1.5, -2.0, 9.75), (0.1, 0.2, -0.3), (2e-5, 1e-6, 4e-5), air, 12.5)
    assert writer.encode_sensor(TIME_US, sample).hex() == SENSOR
    assert writer.encode_gps(TIME_US, GpsSample(PLACE, velocity, 2.236, 297.0)).hex() == GPS
    state = StateSample((1.0, 0.0, 0.0, 0.5), (0.1, 0.2, 0.3), PLACE, velocity, 3.0)
    assert writer.encode_state(TIME_US, state).hex() == STATE


def test_flags_tell_which_measurements_are_new():
    packet = MavlinkWriter().encode_sensor(0, SensorSample((0.0, 0.0, 0.0), (0.0, 0.0, 0.0)))
    assert packet[10 + 60] == 0b111111
    assert packet[1] == 61  # zeros at the end are left out


def test_values_out_of_range_are_limited():
    writer = MavlinkWriter()
    packet = writer.encode_gps(0, GpsSample(PLACE, (1000.0, -1000.0, 0.0), 1000.0, 359.999))
    speed, north, east = (packet[index : index + 2] for index in (34, 36, 38))
    assert (speed, north, east) == (b"\xff\xff", b"\xff\x7f", b"\x00\x80")


@pytest.mark.parametrize("size", [1, 7, 1000])
def test_commands_are_read_from_a_stream_in_pieces(size: int):
    stream, reader = HEARTBEAT + ARMED + DISARMED_1 + HEARTBEAT + ARMED, MavlinkReader()
    pieces = [stream[start : start + size] for start in range(0, len(stream), size)]
    controls = [item for piece in pieces for item in reader.read(piece)]
    assert controls == [ARMED_CONTROLS, Controls((1.0, *[0.0] * 15), is_armed=False), ARMED_CONTROLS]


def test_damaged_packet_is_dropped_and_the_next_is_read():
    damaged = ARMED[:40] + b"\x01" + ARMED[41:]
    assert MavlinkReader().read(damaged + ARMED) == [ARMED_CONTROLS]


def test_signed_packet_is_read():
    body = bytearray(ARMED[1:-2])
    body[1] = 1  # the flag of a signature
    checksum = compute_checksum(bytes(body) + bytes((47,)))
    signed = ARMED[:1] + bytes(body) + checksum.to_bytes(2, "little") + bytes(13)
    assert MavlinkReader().read(signed + ARMED) == [ARMED_CONTROLS] * 2


def test_garbage_does_not_grow_the_buffer():
    reader = MavlinkReader()
    for _ in range(100):
        assert reader.read(bytes(range(200)) * 50) == []
    assert reader.read(bytes(300) + ARMED)[-1:] == [ARMED_CONTROLS]


def test_checksum_is_that_of_the_specification():
    assert compute_checksum(b"123456789") == 0x6F91
