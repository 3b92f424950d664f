"""Packets that ArduPilot's simulator in the loop exchanges with a simulator over UDP.

The newer protocol sends 16 or 32 pulse widths in µs, and expects JSON. The older one sends 16 floating point numbers
from 0 to 1, and expects 17 floating point numbers. Axes are those of aircraft: north, east, down in the world, and
forward, right, down in the vehicle.

Source: ArduPilot ("SITL with JSON", SIM_JSON, SIM_Gazebo), ardupilot_gazebo.
"""

from __future__ import annotations

import json
import struct
from dataclasses import dataclass

from linkwright.geometry.single import Transform, Vector3

MAX_PACKET_SIZE = 1024
_PULSES = {
    (18458, False): struct.Struct("<HHI16H"),
    (29569, True): struct.Struct("<HHI32H"),
}
"""The packets with pulse widths, by their first number and whether they have 32 channels."""
_FRACTIONS, _BINARY_STATE = struct.Struct("<16f"), struct.Struct("<17d")
_HEADER = struct.Struct("<H")
_HEADER_LENGTH = 3


@dataclass(frozen=True, slots=True)
class VehicleState:
    """The motion of a vehicle.

    Attributes:
        seconds: the simulated time in s.
        rates: the angular velocity in rad/s in the axes of the IMU.
        acceleration: the proper acceleration in m/s2 in the axes of the IMU.
        pose: the pose in the world of the aircraft, in m.
        velocity: the velocity in the world of the aircraft, in m/s.
        no_time_sync: whether the autopilot should not follow the clock of the computer.
    """

    seconds: float
    rates: Vector3
    acceleration: Vector3
    pose: Transform
    velocity: Vector3
    no_time_sync: bool = True

    @property
    def rotation(self) -> tuple[float, float, float, float]:
        """The rotation as a quaternion w, x, y, z."""
        x, y, z, w = self.pose[3:]
        return w, x, y, z


@dataclass(frozen=True, slots=True)
class Servos:
    """The commands of all channels.

    Attributes:
        values: the pulse widths in µs, or fractions from -1 to 1.
        is_binary: whether the packet is of the older protocol, with fractions.
    """

    values: tuple[float, ...]
    is_binary: bool

    def compute_fraction(self, channel: int, shortest: float, longest: float) -> float | None:
        """Return the command of a channel as a fraction of its range; None if the channel has no output.

        Args:
            channel: the number of the channel.
            shortest: the pulse width in µs for 0.
            longest: the pulse width in µs for 1.
        """
        if not 0 <= channel < len(self.values):
            return None
        value = self.values[channel]
        if self.is_binary:
            return min(max(value, -1.0), 1.0)
        return min(max((value - shortest) / (longest - shortest), 0.0), 1.0) if value else None

    def encode_reply(self, state: VehicleState) -> bytes:
        """Return the packet with the motion of the vehicle, in the protocol of the servos."""
        if self.is_binary:
            values = (*state.rates, *state.acceleration, *state.rotation, *state.velocity, *state.pose[:3])
            return _BINARY_STATE.pack(state.seconds, *values)
        reply = {
            "timestamp": state.seconds,
            "imu": {"gyro": state.rates, "accel_body": state.acceleration},
            "position": state.pose[:3],
            "quaternion": state.rotation,
            "velocity": state.velocity,
            "no_time_sync": state.no_time_sync,
            "no_lockstep": True,
        }
        return f"\n{json.dumps(reply)}\n".encode()


def parse_servos(data: bytes, *, has_32_channels: bool) -> Servos | None:
    """Return the commands in a packet, or None if it is not a packet of ArduPilot."""
    if len(data) == _FRACTIONS.size:
        return Servos(_FRACTIONS.unpack(data), is_binary=True)
    if len(data) < _HEADER.size:
        return None
    packet = _PULSES.get((_HEADER.unpack_from(data)[0], has_32_channels))
    if packet is None or len(data) != packet.size:
        return None
    return Servos(packet.unpack(data)[_HEADER_LENGTH:], is_binary=False)
