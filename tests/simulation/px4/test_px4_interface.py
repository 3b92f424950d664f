"""Vehicles that PX4's simulator in the loop controls: measurements, commands, connections."""

from __future__ import annotations

import socket
import struct
from math import pi

import numpy as np
import pytest

from linkwright.simulation.plugins.autopilots.mavlink import compute_checksum
from linkwright.simulation.plugins.autopilots.px4 import Px4Interface
from linkwright.simulation.plugins.multicopter import GzMulticopterMotor
from linkwright.testing import Recording
from tests.simulation.px4.test_motors import rotor
from tests.simulation.test_plugins import SECOND_NS, running_server

PERIOD_NS = SECOND_NS // 250
GRAVITY, YAW = 9.81, 0.5
SENSOR, GPS, STATE = 107, 113, 115
PAYLOADS = {SENSOR: "<Q13fIB", GPS: "<Q3i3H3hH3BH", STATE: "<Q7f3i3h2H3h"}
NO_NOISE = {
    "imu": "<linkName>base_link</linkName><gyroscopeNoiseDensity>0</gyroscopeNoiseDensity>"
    "<accelerometerNoiseDensity>0</accelerometerNoiseDensity>",
    "magnetometer": "<noiseDensity>0</noiseDensity><randomWalk>0</randomWalk>",
    "barometer": "",
    "groundtruth": "",
    "gps": "",
}
SENSORS = "".join(
    f'<plugin name="{name}" filename="libgazebo_{name}_plugin.so"><robotNamespace/>{parameters}</plugin>'
    for name, parameters in NO_NOISE.items()
)
FLAP = (
    '<link name="flap"><pose>1 0 0 0 0 0</pose><inertial><mass>0.1</mass><inertia><ixx>0.01</ixx><iyy>0.01</iyy>'
    '<izz>0.01</izz></inertia></inertial></link><joint name="flap_joint" type="revolute"><parent>base_link</parent>'
    "<child>flap</child><axis><xyz>1 0 0</xyz></axis></joint>"
)
PID = "<joint_control_pid><p>2</p><cmdMax>5</cmdMax><cmdMin>-5</cmdMin>{extra}</joint_control_pid>"


def channel(number: int, kind: str = "velocity", extra: str = "", scaling: float = 1000.0, armed: float = 100.0) -> str:
    return (
        f"<channel><input_index>{number}</input_index><input_offset>0</input_offset><input_scaling>{scaling}"
        f"</input_scaling><zero_position_disarmed>0</zero_position_disarmed><zero_position_armed>{armed}"
        f"</zero_position_armed><joint_control_type>{kind}</joint_control_type>{extra}</channel>"
    )


def vehicle(*channels: str, extra: str = "", port: str = "<mavlink_tcp_port>0</mavlink_tcp_port>", tcp: int = 1) -> str:
    plugin = (
        f'<plugin name="px4" filename="libgazebo_mavlink_interface.so"><robotNamespace/>{port}<use_tcp>{tcp}</use_tcp>'
        f"<mavlink_addr>INADDR_ANY</mavlink_addr>{extra}<control_channels>{''.join(channels)}</control_channels></plugin>"
    )
    return (
        f'<model name="uav"><pose>0 0 100 0 0 {YAW}</pose><link name="base_link"><inertial><mass>1e6</mass><inertia>'
        f"<ixx>1e6</ixx><iyy>1e6</iyy><izz>1e6</izz></inertia></inertial></link>{rotor(0, '')}{rotor(1, '')}{FLAP}"
        f"{SENSORS}{plugin}</model>"
    )


_SOCKETS: list[socket.socket] = []


@pytest.fixture(autouse=True)
def _close_sockets():
    yield
    while _SOCKETS:
        _SOCKETS.pop().close()


class Autopilot:
    """Connects as PX4 does, reads measurements and sends commands."""

    def __init__(self, server) -> None:
        self.server = server
        self.plugin = next(plugin for plugin in server.plugins("uav") if isinstance(plugin, Px4Interface))
        self.socket = socket.create_connection(self.plugin.connection.address)
        self.socket.settimeout(5.0)
        _SOCKETS.append(self.socket)

    def step(self, count: int = 1) -> None:
        self.server.advance(count * PERIOD_NS)

    def send(self, *values: float, is_armed: bool = True) -> None:
        payload = struct.pack("<QQ16fB", 0, 0, *values, *[0.0] * (16 - len(values)), 129 if is_armed else 1)
        body = bytes((len(payload), 0, 1, 1, 93)) + payload
        checksum = compute_checksum(body + bytes((47,)))
        self.socket.sendall(b"\xfe" + body + checksum.to_bytes(2, "little"))

    def receive(self) -> list[tuple[int, tuple]]:
        """Return the numbers and the fields of the packets that have arrived."""
        packets, data = [], self.socket.recv(1 << 20)
        while data:
            kind, end = int.from_bytes(data[7:10], "little"), 10 + data[1]
            form = struct.Struct(PAYLOADS[kind])
            packets.append((kind, form.unpack(data[10:end].ljust(form.size, b"\0"))))
            data = data[end + 2 :]
        return packets

    def motors(self) -> list[float]:
        plugins = self.server.plugins("uav")
        return [plugin.target_speed for plugin in plugins if isinstance(plugin, GzMulticopterMotor)]


async def test_measurements_have_the_units_and_axes_of_px4():
    async with running_server(vehicle(), gravity=f"0 0 -{GRAVITY}") as (server, _, log):
        pilot = Autopilot(server)
        pilot.step(2)
        kind, (time_us, *values, flags, _) = pilot.receive()[0]
        assert kind == SENSOR
        assert time_us % 4000 == 0
        assert values[:6] == pytest.approx([0.0] * 6, abs=1e-3)  # falls freely
        east, north, up = server.simulation.world.magnetic_field
        cosine, sine = np.cos(YAW), np.sin(YAW)
        gauss = [(cosine * east + sine * north) * 1e4, (sine * east - cosine * north) * 1e4, -up * 1e4]
        assert values[6:9] == pytest.approx(gauss, rel=1e-3)
        pressure, difference, altitude, temperature = values[9:]
        assert altitude == pytest.approx(488.0, abs=0.1)
        assert pressure == pytest.approx(1013.25 * (1 - 0.0065 * 488.0 / 288.15) ** 5.2559, abs=0.1)
        assert temperature == pytest.approx(15.0 - 0.0065 * 488.0, abs=0.01)
        assert (difference, flags) == (0.0, 0b1101111111111 & ~(1 << 10))
        assert "controls" not in str(log)


async def test_accelerometer_of_a_vehicle_at_rest_measures_gravity_upwards():
    resting = vehicle().replace("</model>", "<static>false</static></model>")
    fixed = resting.replace(
        "</model>", '<joint name="hook" type="fixed"><parent>world</parent><child>base_link</child></joint></model>'
    )
    async with running_server(fixed) as (server, *_):
        pilot = Autopilot(server)
        pilot.step(3)
        _, (_, *values, _, _) = pilot.receive()[-2]
        assert values[:3] == pytest.approx([0.0, 0.0, -GRAVITY], abs=1e-2)


async def test_rates_of_the_sensors_are_those_of_their_plugins():
    async with running_server(vehicle(), gravity="0 0 0") as (server, *_):
        pilot, packets = Autopilot(server), []
        for _ in range(50):
            pilot.step(5)
            packets += pilot.receive()
        flags = [fields[-2] for kind, fields in packets if kind == SENSOR]
        assert len(flags) == pytest.approx(250, abs=2)
        assert sum(bool(flag & 1 << 6) for flag in flags) == pytest.approx(100, rel=0.3)
        assert sum(bool(flag & 1 << 9) for flag in flags) == pytest.approx(50, rel=0.1)
        assert sum(kind == GPS for kind, _ in packets) == 5


async def test_position_and_true_state_are_towards_north_east_and_down():
    async with running_server(vehicle(), gravity="0 0 0") as (server, *_):
        pilot = Autopilot(server)
        server.simulation.set_model_velocity("uav", (3.0, 4.0, -1.0), (0.0, 0.0, 0.2))
        fixes = []
        for _ in range(60):
            pilot.step()
            packets = pilot.receive()
            fixes += [fields for kind, fields in packets if kind == GPS]
        (_, latitude, longitude, altitude, eph, epv, speed, north, east, down, course, fix, count, *_) = fixes[-1]
        assert (latitude / 1e7, longitude / 1e7) == pytest.approx((47.397742, 8.545594), abs=1e-4)
        assert altitude / 1000 == pytest.approx(588.0, abs=1.0)
        assert (eph, epv, fix, count) == (100, 100, 3, 10)
        assert (speed, north, east, down) == pytest.approx((500, 400, 300, 100), abs=1)
        assert course / 100 == pytest.approx(np.degrees(np.arctan2(3, 4)), abs=0.1)
        state = next(fields for kind, fields in packets if kind == STATE)
        w, _, _, z = state[1:5]
        heading = 2 * np.arctan2(z, w)
        assert (heading - (pi / 2 - YAW - 0.2 * 0.24)) % (2 * pi) == pytest.approx(0.0, abs=1e-2)
        assert state[5:8] == pytest.approx((0.0, 0.0, -0.2), abs=1e-3)
        assert state[11:14] == pytest.approx((400, 300, 100), abs=1)


async def test_commands_of_an_armed_vehicle_turn_its_rotors():
    async with running_server(vehicle(channel(0), channel(1)), gravity="0 0 0") as (server, _, log):
        pilot = Autopilot(server)
        pilot.send(0.5, 0.25)
        pilot.step(2)
        assert pilot.motors() == [600.0, 350.0]
        assert any("controls 'uav'" in record.text for record in log)
        pilot.send(0.5, 0.25, is_armed=False)
        pilot.step()
        assert pilot.motors() == [0.0, 0.0]


async def test_lost_connection_stops_the_rotors_and_a_new_one_is_accepted():
    async with running_server(vehicle(channel(0)), gravity="0 0 0") as (server, _, log):
        pilot = Autopilot(server)
        pilot.send(0.5)
        pilot.step(2)
        assert pilot.motors()[0] == 600.0
        pilot.socket.close()
        pilot.step(2)
        assert pilot.motors()[0] == 0.0
        assert any("no longer sends commands" in record.text for record in log)
        pilot = Autopilot(server)
        pilot.send(0.7)
        pilot.step(2)
        assert pilot.motors()[0] == pytest.approx(800.0, abs=0.01)


async def test_joints_follow_positions_by_their_controllers():
    flap = channel(2, "position", f"<joint_name>flap_joint</joint_name>{PID.format(extra='')}", 0.5, 0.0)
    async with running_server(vehicle(flap), gravity="0 0 0") as (server, *_):
        pilot = Autopilot(server)
        pilot.send(0.0, 0.0, 0.8)
        pilot.step(2)
        position = server.simulation.joint_state("uav::flap_joint")[0]
        applied = server.simulation.data.joint("uav::flap_joint").qfrc_applied[0]
        assert applied == pytest.approx(2 * (0.4 - position), abs=1e-2)


async def test_position_errors_are_limited():
    pid = PID.format(extra="<errMax>0.1</errMax>")
    flap = channel(2, "position", f"<joint_name>flap_joint</joint_name>{pid}", 0.5, 0.0)
    async with running_server(vehicle(flap), gravity="0 0 0") as (server, *_):
        pilot = Autopilot(server)
        pilot.send(0.0, 0.0, 0.8)
        pilot.step(2)
        assert server.simulation.data.joint("uav::flap_joint").qfrc_applied[0] == pytest.approx(0.2)


async def test_kinematic_channel_sets_the_position():
    flap = channel(2, "position_kinematic", "<joint_name>flap_joint</joint_name>", 0.5, 0.1)
    async with running_server(vehicle(flap), gravity="0 0 0") as (server, *_):
        pilot = Autopilot(server)
        pilot.send(0.0, 0.0, 0.8)
        pilot.step(2)
        assert server.simulation.joint_state("uav::flap_joint")[0] == pytest.approx(0.5, abs=1e-3)


async def test_topic_channel_publishes_the_position():
    gimbal = channel(3, "position_gztopic", "<gztopic>/gimbal_pitch_cmd</gztopic>", 3.0, 0.5)
    async with running_server(vehicle(gimbal), gravity="0 0 0") as (server, graph, _):
        pilot, positions = Autopilot(server), Recording(graph, server.node, "/uav/gimbal_pitch_cmd")
        await graph.settle()
        pilot.send(0.0, 0.0, 0.0, 0.25)
        pilot.step(2)
        await graph.settle()
        assert positions[-1].data == pytest.approx(1.25)


async def test_channel_for_a_joint_of_another_model_is_ignored():
    other = channel(2, "position", f"<joint_name>plane::flap</joint_name>{PID.format(extra='')}")
    async with running_server(vehicle(channel(0), other), gravity="0 0 0") as (server, _, log):
        pilot = Autopilot(server)
        pilot.send(0.5)
        pilot.step(2)
        assert pilot.motors()[0] == 600.0
        assert [record.text for record in log if "controls" not in record.text] == []


async def test_udp_sends_to_the_port_of_the_parameters():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as pilot:
        pilot.bind(("127.0.0.1", 0))
        pilot.settimeout(5.0)
        port = f"<mavlink_udp_port>{pilot.getsockname()[1]}</mavlink_udp_port>"
        async with running_server(vehicle(channel(0), port=port, tcp=0), gravity="0 0 0") as (server, *_):
            server.advance(2 * PERIOD_NS)
            data, _ = pilot.recvfrom(2000)
            assert int.from_bytes(data[7:10], "little") == SENSOR


async def test_lockstep_waits_for_the_commands_of_an_armed_vehicle():
    text = vehicle(channel(0), extra="<enable_lockstep>1</enable_lockstep>")
    async with running_server(text, gravity="0 0 0") as (server, *_):
        pilot, waits = Autopilot(server), []
        connection = pilot.plugin.connection
        receive = connection.receive
        connection.receive = lambda timeout: (waits.append(timeout), receive(timeout))[1]
        pilot.send(0.5, is_armed=False)
        pilot.step(2)
        assert set(waits) == {0.0}
        pilot.send(0.5)
        pilot.step()
        waits.clear()
        pilot.step()
        assert waits == [0.01]


async def test_port_in_use_is_reported():
    with socket.create_server(("127.0.0.1", 0)) as other:
        port = f"<mavlink_tcp_port>{other.getsockname()[1]}</mavlink_tcp_port>"
        async with running_server(vehicle(port=port)) as (server, _, log):
            server.close()
            assert [record.text for record in log if "cannot listen for the autopilot at 127.0.0.1:" in record.text]
            assert not [record.text for record in log if "its code failed" in record.text]


@pytest.mark.parametrize(
    ("channels", "extra", "text"),
    [
        ("", "<hil_mode>1</hil_mode>", "hardware in the loop is not simulated"),
        (channel(16), "", "'16' is not the number of a channel"),
        (channel(0, "torque"), "", "<joint_control_type> must be 'velocity'"),
    ],
)
async def test_mistakes_are_reported(channels: str, extra: str, text: str):
    async with running_server(vehicle(channels, extra=extra)) as (_, __, log):
        assert any(text in record.text for record in log)
