"""Vehicles of ArduPilot: the packets of its protocols, the channels, and the states that it gets."""

from __future__ import annotations

import json
import socket
import struct
from math import cos, pi, sin

import pytest

from linkwright.simulation.plugins.autopilots.packets import VehicleState, parse_servos
from linkwright.testing import Recording
from tests.simulation.test_plugins import running_server
from tests.simulation.worlds import GROUND

STEP_NS = 1_000_000
PULSE_MAGIC, WIDE_MAGIC = 18458, 29569
YAW, SPEED = 0.5, 0.7

ROTOR = """
<link name="{name}"><pose>0 0 0.2 0 0 0</pose><inertial><mass>0.1</mass>
  <inertia><ixx>0.01</ixx><iyy>0.01</iyy><izz>0.01</izz></inertia></inertial></link>
<joint name="{name}_joint" type="revolute"><parent>base</parent><child>{name}</child>
  <axis><xyz>0 0 1</xyz></axis></joint>"""
IMU = '<sensor name="imu_sensor" type="imu"><always_on>1</always_on></sensor>'


def vehicle(*controls: str, extra: str = "", library: str = "libArduPilotPlugin.so", pose: str = "1 2 3 0 0 0") -> str:
    rotors = "".join(ROTOR.format(name=f"rotor{index}") for index in range(max(len(controls), 1)))
    plugin = f'<plugin name="pilot" filename="{library}">{"".join(controls)}{extra}</plugin>'
    return (
        f'<model name="uav"><pose>{pose}</pose><link name="base"><inertial><mass>2</mass></inertial>{IMU}</link>'
        f"{rotors}{plugin}</model>"
    )


def control(index: int = 0, extra: str = "", kind: str = "VELOCITY") -> str:
    return f'<control channel="{index}"><jointName>rotor{index}_joint</jointName><type>{kind}</type>{extra}</control>'


def port(number: int = 0) -> str:
    return f"<fdm_port_in>{number}</fdm_port_in>"


class Autopilot:
    """Sends the packets of an autopilot, and reads the states."""

    def __init__(self, server) -> None:
        self.server = server
        self.plugin = next(plugin for plugin in server.plugins("uav") if hasattr(plugin, "is_online"))
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.socket.settimeout(5.0)
        self._count = 0

    def send(self, *pulses: int, magic: int = PULSE_MAGIC, size: int = 16) -> None:
        self._count += 1
        self.send_bytes(struct.pack(f"<HHI{size}H", magic, 400, self._count, *pulses, *[0] * (size - len(pulses))))

    def send_bytes(self, data: bytes) -> None:
        self.socket.sendto(data, self.plugin.address)

    def step(self, count: int = 1) -> None:
        self.server.advance(count * STEP_NS)

    def receive(self) -> dict:
        text = self.socket.recv(2000).decode()
        assert text.startswith("\n")
        assert text.endswith("\n")
        return json.loads(text)

    def speed(self, index: int = 0) -> float:
        return self.server.simulation.joint_state(f"uav::rotor{index}_joint")[1]

    def effort(self, index: int = 0) -> float:
        return float(self.server.simulation.data.joint(f"uav::rotor{index}_joint").qfrc_applied[0])


@pytest.fixture(autouse=True)
def _real_time(monkeypatch):
    """Let no real time pass, so that autopilots are not lost on a slow computer."""
    monkeypatch.setattr("linkwright.simulation.plugins.autopilots.ardupilot.monotonic", lambda: 0.0)


@pytest.fixture
def closing():
    """Close the autopilots of a test."""
    autopilots: list[Autopilot] = []
    yield autopilots
    for autopilot in autopilots:
        autopilot.socket.close()


def connect(server, closing: list[Autopilot]) -> Autopilot:
    closing.append(Autopilot(server))
    return closing[-1]


def test_packets_of_other_programs_are_not_commands():
    packet = struct.pack("<HHI16H", PULSE_MAGIC, 400, 1, *[1500] * 16)
    assert parse_servos(packet, has_32_channels=False) is not None
    assert parse_servos(packet, has_32_channels=True) is None
    assert parse_servos(packet[:-1], has_32_channels=False) is None
    assert parse_servos(b"", has_32_channels=False) is None
    assert parse_servos(struct.pack("<HHI16H", 1, 400, 1, *[1500] * 16), has_32_channels=False) is None


def test_pulses_become_fractions_of_their_range():
    servos = parse_servos(
        struct.pack("<HHI16H", PULSE_MAGIC, 400, 1, 1100, 1900, 1300, 900, 2100, *[0] * 11), has_32_channels=False
    )
    fractions = [servos.compute_fraction(channel, 1100.0, 1900.0) for channel in range(6)]
    assert fractions == [0.0, 1.0, 0.25, 0.0, 1.0, None]
    assert servos.compute_fraction(16, 1100.0, 1900.0) is None


def test_older_packets_hold_fractions_and_get_binary_states():
    servos = parse_servos(struct.pack("<16f", 0.5, -3.0, *[0.0] * 14), has_32_channels=False)
    assert [servos.compute_fraction(channel, 1000.0, 2000.0) for channel in (0, 1)] == [0.5, -1.0]
    state = VehicleState(4.0, (1.0, 2.0, 3.0), (4.0, 5.0, 6.0), (7.0, 8.0, 9.0, 0.1, 0.2, 0.3, 0.9), (10.0, 11.0, 12.0))
    values = struct.unpack("<17d", servos.encode_reply(state))
    assert values == (4.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 0.9, 0.1, 0.2, 0.3, 10.0, 11.0, 12.0, 7.0, 8.0, 9.0)


async def test_state_is_in_axes_of_aircraft(closing):
    frames = '<gazeboXYZToNED degrees="true">0 0 0 180 0 90</gazeboXYZToNED>' + port()
    world = vehicle(control(), extra=frames, pose=f"1 2 3 0 0 {YAW}")
    async with running_server(world, gravity="0 0 0") as (server, graph, log):
        autopilot = connect(server, closing)
        autopilot.send(0)
        server.simulation.set_model_velocity("uav", (SPEED, 0.0, 0.0), (0.0, 0.0, 0.0))
        autopilot.step()
        state = autopilot.receive()
        x, y, z = server.simulation.link_pose("uav::base")[:3]
        assert state["timestamp"] == pytest.approx(0.001)
        assert state["position"] == pytest.approx([y, x, -z], abs=1e-9)  # x is east, y is north, z is up
        assert state["velocity"] == pytest.approx([0.0, SPEED, 0.0], abs=1e-6)
        heading = pi / 2 - YAW  # clockwise from north
        assert state["quaternion"] == pytest.approx([cos(heading / 2), 0.0, 0.0, sin(heading / 2)], abs=1e-6)
        assert (state["no_time_sync"], state["no_lockstep"]) == (True, True)
        await graph.settle()
        assert [record.text for record in log if "controls 'uav'" in record.text]


@pytest.mark.parametrize(("gravity", "acceleration"), [(0.0, 0.0), (9.81, 9.81)])
async def test_imu_measures_reaction_to_gravity(closing, gravity, acceleration):
    """A vehicle without gravity, and a vehicle that stands on the ground."""
    box = "<collision name='c'><geometry><box><size>0.4 0.4 0.1</size></box></geometry></collision></link>"
    world = vehicle(control(), extra=port(), pose="0 0 0.05 0 0 0").replace("</link>", box, 1)
    async with running_server(GROUND, world, gravity=f"0 0 -{gravity}") as (server, _, _):
        autopilot = connect(server, closing)
        autopilot.step(500)
        autopilot.send(0)
        autopilot.step()
        imu = autopilot.receive()["imu"]
        assert imu["accel_body"] == pytest.approx([0.0, 0.0, acceleration], abs=0.01)
        assert imu["gyro"] == pytest.approx([0.0, 0.0, 0.0], abs=1e-3)


async def test_controller_turns_rotor_at_commanded_speed(closing):
    gains = "<multiplier>20</multiplier><servo_min>1100</servo_min><servo_max>1900</servo_max><p_gain>0.5</p_gain>"
    limits = "<cmd_max>3</cmd_max><cmd_min>-3</cmd_min>"
    async with running_server(vehicle(control(extra=gains + limits), extra=port()), gravity="0 0 0") as (server, _, _):
        autopilot = connect(server, closing)
        autopilot.step(10)
        assert autopilot.effort() == 0.0
        autopilot.send(1300)  # a quarter of the range
        autopilot.step()
        assert autopilot.effort() == pytest.approx(0.5 * 20 * 0.25)
        autopilot.send(1900)
        autopilot.step()
        assert autopilot.effort() == 3.0
        autopilot.send(1300)
        autopilot.step(500)
        assert autopilot.speed() == pytest.approx(5.0, rel=0.05)


@pytest.mark.parametrize("kind", ["EFFORT", "POSITION"])
async def test_efforts_and_positions_of_channels(closing, kind):
    text = control(extra="<multiplier>2</multiplier><offset>-0.5</offset><p_gain>0.3</p_gain>", kind=kind)
    async with running_server(vehicle(text, extra=port()), gravity="0 0 0") as (server, _, _):
        autopilot = connect(server, closing)
        autopilot.send(1750)
        autopilot.step()
        assert autopilot.effort() == pytest.approx(0.5 if kind == "EFFORT" else 0.3 * 0.5)


async def test_motor_holds_speed_without_force(closing):
    text = control(extra="<multiplier>10</multiplier><useForce>0</useForce>")
    async with running_server(vehicle(text, extra=port()), gravity="0 0 0") as (server, _, _):
        autopilot = connect(server, closing)
        autopilot.send(1500)
        autopilot.step(200)
        assert autopilot.speed() == pytest.approx(5.0, rel=0.02)


async def test_command_is_published(closing):
    text = control(extra="<multiplier>-4</multiplier><cmd_topic>/gimbal/pitch</cmd_topic>", kind="COMMAND")
    async with running_server(vehicle(text, extra=port()), gravity="0 0 0") as (server, graph, _):
        recording = Recording(graph, server.node, "/gimbal/pitch")
        await graph.settle()
        autopilot = connect(server, closing)
        autopilot.send(1250)
        autopilot.step()
        await graph.settle()
        assert recording.last.data == -1.0


async def test_32_channels(closing):
    text = control(extra="<multiplier>4</multiplier>", kind="EFFORT").replace('channel="0"', 'channel="31"')
    extra = port() + "<have_32_channels>true</have_32_channels>"
    async with running_server(vehicle(text, extra=extra), gravity="0 0 0") as (server, _, _):
        autopilot = connect(server, closing)
        autopilot.send(*[0] * 31, 1500, magic=WIDE_MAGIC, size=32)
        autopilot.step()
        assert autopilot.effort() == 2.0


async def test_older_autopilot_gets_states_at_its_port(closing):
    receiver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    receiver.bind(("127.0.0.1", 0))
    receiver.settimeout(5.0)
    extra = port() + f"<fdm_port_out>{receiver.getsockname()[1]}</fdm_port_out>"
    rotor = (
        '<rotor id="7"><jointName>rotor0_joint</jointName><turningDirection>cw</turningDirection>'
        "<vel_p_gain>0.001</vel_p_gain></rotor>"
    )
    world = vehicle(rotor, extra=extra, library="libArduCopterPlugin.so")
    with receiver:
        async with running_server(world, gravity="0 0 0") as (server, _, _):
            autopilot = connect(server, closing)
            autopilot.send_bytes(struct.pack("<16f", 0.5, *[0.0] * 15))
            autopilot.step()
            assert autopilot.effort() == pytest.approx(-0.001 * 0.5 * 838.0)
            values = struct.unpack("<17d", receiver.recv(2000))
            assert values[0] == pytest.approx(0.001)
            assert values[-3:] == pytest.approx((1.0, -2.0, -3.0), abs=1e-6)


async def test_motors_stop_when_autopilot_ends(closing, monkeypatch):
    text = control(extra="<multiplier>4</multiplier>", kind="EFFORT")
    async with running_server(vehicle(text, extra=port()), gravity="0 0 0") as (server, graph, log):
        autopilot = connect(server, closing)
        autopilot.send(1500)
        autopilot.step()
        assert autopilot.effort() == 2.0
        monkeypatch.setattr("linkwright.simulation.plugins.autopilots.ardupilot.monotonic", lambda: 1e9)
        autopilot.step(10)
        assert autopilot.effort() == 2.0
        autopilot.step()
        assert autopilot.effort() == 0.0
        await graph.settle()
        assert [record.text for record in log if "no longer sends commands" in record.text]


async def test_used_port_is_an_error():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("127.0.0.1", 0))
        used = other.getsockname()[1]
        async with running_server(vehicle(control(), extra=port(used))) as (_, graph, log):
            await graph.settle()
            assert [record.text for record in log if f"127.0.0.1:{used}" in record.text]


@pytest.mark.parametrize(
    ("controls", "extra", "words"),
    [
        ((control(kind="SPEED"),), "", "SPEED"),
        ((control(),), "<imuName>other</imuName>", "other"),
        ((control(extra="<servo_min>1000</servo_min><servo_max>1000</servo_max>"),), "", "must differ"),
        ((control().replace('channel="0"', 'channel="first"'),), "", "first"),
    ],
)
async def test_invalid_parameters_are_told(controls, extra, words):
    async with running_server(vehicle(*controls, extra=extra + port())) as (_, graph, log):
        await graph.settle()
        assert [record.text for record in log if words in record.text]
