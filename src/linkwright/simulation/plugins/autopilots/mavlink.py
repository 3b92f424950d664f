"""Messages of MAVLink that PX4's simulator in the loop exchanges with a simulator.

Axes are those of aircraft: north, east, down in the world, and forward, right, down in the vehicle.

Source: the specification of MAVLink (packets of the versions 1 and 2, checksums, the common messages).
"""

from __future__ import annotations

import struct
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from linkwright.geometry.single import Vector3

_VERSION_1, _VERSION_2 = 0xFE, 0xFD
"""The first byte of a packet."""
_HEADER_LENGTHS = {_VERSION_1: 6, _VERSION_2: 10}
_CHECKSUM_LENGTH, _SIGNATURE_LENGTH = 2, 13
_SIGNED_FLAG = 1
_SYSTEM, _COMPONENT = 1, 200
"""The sender of the simulator's messages."""
_ARMED_FLAG = 128
_MAX_BUFFER = 1 << 16
_HIL_ACTUATOR_CONTROLS, _HIL_SENSOR, _HIL_GPS, _HIL_STATE_QUATERNION = 93, 107, 113, 115
_CHECKSUM_SEEDS = {_HIL_ACTUATOR_CONTROLS: 47, _HIL_SENSOR: 108, _HIL_GPS: 124, _HIL_STATE_QUATERNION: 4}
"""The byte that MAVLink adds to the checksum of each message, derived from its fields."""
_CONTROLS = struct.Struct("<QQ16fB")
_SENSOR, _GPS, _STATE = struct.Struct("<Q13fIB"), struct.Struct("<Q3i3H3hH3BH"), struct.Struct("<Q7f3i3h2H3h")
_ACCELERATION_FIELDS, _RATE_FIELDS, _FIELD_FIELDS, _DIFFERENCE_FIELD = 0b111, 0b111000, 0b111000000, 1 << 10
_AIR_FIELDS = 1 << 9 | 1 << 11 | 1 << 12
_FIX_3D, _SATELLITE_COUNT, _FULL_TURN_CDEG = 3, 10, 36000


@dataclass(frozen=True, slots=True)
class Controls:
    """The commands of an autopilot.

    Attributes:
        values: the commands of 16 channels.
        is_armed: whether the motors may turn.
    """

    values: tuple[float, ...]
    is_armed: bool


@dataclass(frozen=True, slots=True)
class AirSample:
    """A measurement of a barometer: the pressure in Pa, the altitude in m and the temperature in °C."""

    pressure: float
    altitude: float
    temperature: float


@dataclass(frozen=True, slots=True)
class SensorSample:
    """Measurements in the axes of the vehicle; None for a sensor without a new measurement.

    Attributes:
        acceleration: the proper acceleration in m/s2.
        rates: the angular velocity in rad/s.
        field: the magnetic field in T.
        air: the measurement of the barometer.
        pressure_difference: the dynamic pressure of the air along x in Pa.
    """

    acceleration: Vector3
    rates: Vector3
    field: Vector3 | None = None
    air: AirSample | None = None
    pressure_difference: float | None = None


@dataclass(frozen=True, slots=True)
class GpsSample:
    """A measurement of a satellite receiver.

    Attributes:
        position: latitude and longitude in degrees, and the altitude in m.
        velocity: the velocity in m/s towards north, east and down.
        ground_speed: the horizontal speed in m/s.
        course: the direction of the velocity in degrees, from 0 to 360.
    """

    position: Vector3
    velocity: Vector3
    ground_speed: float
    course: float


@dataclass(frozen=True, slots=True)
class StateSample:
    """The true motion of a vehicle.

    Attributes:
        rotation: the rotation as a quaternion w, x, y, z.
        rates: the angular velocity in rad/s, in the axes of the vehicle.
        position: latitude and longitude in degrees, and the altitude in m.
        velocity: the velocity in m/s towards north, east and down.
        forward_speed: the speed in m/s along x of the vehicle.
    """

    rotation: tuple[float, float, float, float]
    rates: Vector3
    position: Vector3
    velocity: Vector3
    forward_speed: float


class MavlinkWriter:
    """Encodes messages as packets of MAVLink 2, which it numbers."""

    def __init__(self) -> None:
        self._sequence = 0

    def encode_sensor(self, microseconds: int, sample: SensorSample) -> bytes:
        """Return the packet HIL_SENSOR."""
        flags = _ACCELERATION_FIELDS | _RATE_FIELDS
        flags |= 0 if sample.field is None else _FIELD_FIELDS
        flags |= 0 if sample.air is None else _AIR_FIELDS
        flags |= 0 if sample.pressure_difference is None else _DIFFERENCE_FIELD
        gauss = [value * 1e4 for value in sample.field or (0.0, 0.0, 0.0)]
        air = sample.air or AirSample(0.0, 0.0, 0.0)
        pressures = air.pressure / 100, (sample.pressure_difference or 0.0) / 100
        values = (*sample.acceleration, *sample.rates, *gauss, *pressures, air.altitude, air.temperature)
        return self._encode(_HIL_SENSOR, _SENSOR.pack(microseconds, *values, flags, 0))

    def encode_gps(self, microseconds: int, sample: GpsSample) -> bytes:
        """Return the packet HIL_GPS."""
        speeds = [_limit(value * 100, 16, is_signed=True) for value in sample.velocity]
        payload = _GPS.pack(
            microseconds,
            *_encode_position(sample.position),
            *(100, 100),  # the standard deviations in cm of PX4's plugin
            _limit(sample.ground_speed * 100, 16, is_signed=False),
            *speeds,
            round(sample.course * 100) % _FULL_TURN_CDEG,
            *(_FIX_3D, _SATELLITE_COUNT, 0, 0),
        )
        return self._encode(_HIL_GPS, payload)

    def encode_state(self, microseconds: int, sample: StateSample) -> bytes:
        """Return the packet HIL_STATE_QUATERNION, without accelerations."""
        speeds = [_limit(value * 100, 16, is_signed=True) for value in sample.velocity]
        air_speed = _limit(max(sample.forward_speed, 0.0) * 100, 16, is_signed=False)
        position = _encode_position(sample.position)
        payload = _STATE.pack(
            microseconds, *sample.rotation, *sample.rates, *position, *speeds, air_speed, air_speed, 0, 0, 0
        )
        return self._encode(_HIL_STATE_QUATERNION, payload)

    def _encode(self, kind: int, payload: bytes) -> bytes:
        payload = payload.rstrip(b"\0") or b"\0"
        header = (len(payload), 0, 0, self._sequence, _SYSTEM, _COMPONENT, *kind.to_bytes(3, "little"))
        self._sequence = (self._sequence + 1) % 256
        body = bytes(header) + payload
        checksum = compute_checksum(body + bytes((_CHECKSUM_SEEDS[kind],)))
        return bytes((_VERSION_2,)) + body + checksum.to_bytes(_CHECKSUM_LENGTH, "little")


class MavlinkReader:
    """Decodes the commands in a stream of bytes, and drops everything else."""

    def __init__(self) -> None:
        self._buffer = b""

    def read(self, data: bytes) -> list[Controls]:
        """Return the commands that are complete with more bytes of the stream, in their order."""
        self._buffer = (self._buffer + data)[-_MAX_BUFFER:]
        return [_decode_controls(payload) for kind, payload in self._read_packets() if kind == _HIL_ACTUATOR_CONTROLS]

    def _read_packets(self) -> Iterator[tuple[int, bytes]]:
        """Remove complete packets from the buffer, and yield the number and the payload of each valid one."""
        start = 0
        while start < len(self._buffer):
            if self._buffer[start] not in _HEADER_LENGTHS:
                start += 1
                continue
            header = self._buffer[start : start + _HEADER_LENGTHS[self._buffer[start]]]
            if len(header) < _HEADER_LENGTHS[self._buffer[start]]:
                break
            is_new = header[0] == _VERSION_2
            kind = int.from_bytes(header[7:10], "little") if is_new else header[5]
            end = start + len(header) + header[1]
            signature_length = _SIGNATURE_LENGTH if is_new and header[2] & _SIGNED_FLAG else 0
            if len(self._buffer) < end + _CHECKSUM_LENGTH + signature_length:
                break
            checksum = int.from_bytes(self._buffer[end : end + _CHECKSUM_LENGTH], "little")
            seed = _CHECKSUM_SEEDS.get(kind)
            if seed is not None and compute_checksum(self._buffer[start + 1 : end] + bytes((seed,))) != checksum:
                start += 1  # these bytes only look like a packet
                continue
            if seed is not None:
                yield kind, self._buffer[start + len(header) : end]
            start = end + _CHECKSUM_LENGTH + signature_length
        self._buffer = self._buffer[start:]


def _decode_controls(payload: bytes) -> Controls:
    _, _, *values, mode = _CONTROLS.unpack(payload[: _CONTROLS.size].ljust(_CONTROLS.size, b"\0"))
    return Controls(tuple(values), bool(mode & _ARMED_FLAG))


def _encode_position(position: Sequence[float]) -> tuple[int, int, int]:
    latitude, longitude, altitude = position
    return round(latitude * 1e7), round(longitude * 1e7), _limit(altitude * 1000, 32, is_signed=True)


def _limit(value: float, bits: int, *, is_signed: bool) -> int:
    """Return a value as an integer in the range of a number of bits."""
    least, greatest = (-(1 << (bits - 1)), (1 << (bits - 1)) - 1) if is_signed else (0, (1 << bits) - 1)
    return round(min(max(value, least), greatest))


def _create_table() -> tuple[int, ...]:
    table = []
    for value in range(256):
        for _ in range(8):
            value = value >> 1 ^ (0x8408 if value & 1 else 0)
        table.append(value)
    return tuple(table)


_TABLE = _create_table()


def compute_checksum(data: bytes) -> int:
    """Return the checksum of MAVLink for bytes: CRC-16/MCRF4XX."""
    checksum = 0xFFFF
    for byte in data:
        checksum = checksum >> 8 ^ _TABLE[(checksum ^ byte) & 0xFF]
    return checksum
