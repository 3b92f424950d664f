"""Thrusters of vehicles: dynamics and conversions against their formulas."""

from __future__ import annotations

from math import exp, sqrt

import numpy as np
import pytest

from linkwright.messages import get_message
from linkwright.testing import Recording
from tests.simulation.fluids.server import weightless_server
from tests.simulation.test_plugins import SECOND_NS

FLOAT = "uuv_gazebo_ros_plugins_msgs/msg/FloatStamped"
ZERO_ORDER = "<dynamics><type>ZeroOrder</type></dynamics>"
BASIC = "<conversion><type>Basic</type><rotorConstant>0.01</rotorConstant></conversion>"


def vehicle(parameters: str, joint: bool = True) -> str:
    joint_name = "<jointName>shaft</jointName>" if joint else ""
    return (
        '<model name="uuv"><pose>0 0 0 0 0 0.5</pose><link name="hull"><inertial><mass>1e6</mass><inertia>'
        "<ixx>1e6</ixx><iyy>1e6</iyy><izz>1e6</izz></inertia></inertial></link>"
        '<link name="propeller"><inertial><mass>0.1</mass><inertia><ixx>0.01</ixx><iyy>0.01</iyy><izz>0.01</izz>'
        '</inertia></inertial></link><joint name="shaft" type="revolute"><parent>hull</parent><child>propeller</child>'
        "<axis><xyz>0 1 0</xyz></axis></joint>"
        '<plugin name="t" filename="libuuv_thruster_ros_plugin.so"><linkName>propeller</linkName>'
        f"{joint_name}<thrusterID>2</thrusterID>{parameters}</plugin></model>"
    )


async def run(parameters: str, command: float, seconds: float = 2.0, joint: bool = True):
    """Return the force on the propeller, the published thrusts, and the speed of the shaft after a command."""
    async with weightless_server(vehicle(parameters, joint), step=0.001) as (server, graph, log):
        recording = Recording(graph, server.node, "/uuv/thrusters/_2/thrust")
        graph.create_node("pilot").create_publisher(FLOAT, "/uuv/thrusters/_2/input", 10).publish(
            get_message(FLOAT)(data=command)
        )
        await graph.settle()
        server.advance(round(seconds * SECOND_NS))
        await graph.settle()
        assert not log, [record.text for record in log]
        force = server.simulation.data.xfrc_applied[server.simulation.body("uuv::propeller")][:3].copy()
        return force, recording, server.simulation.joint_state("uuv::shaft")[1]


@pytest.mark.parametrize(("command", "thrust"), [(20.0, 4.0), (-20.0, -4.0)])
async def test_thrust_is_constant_times_squared_speed_along_axis_of_joint(command, thrust):
    force, recording, speed = await run(ZERO_ORDER + BASIC, command, seconds=10.0)
    assert force == pytest.approx(thrust * np.array((-np.sin(0.5), np.cos(0.5), 0.0)), rel=1e-3, abs=1e-3)
    assert recording.last.data == pytest.approx(thrust)
    assert speed == pytest.approx(command, rel=0.7)


async def test_thrust_without_joint_acts_along_x():
    force, _, _ = await run(ZERO_ORDER + BASIC, 20.0, joint=False)
    assert np.linalg.norm(force) == pytest.approx(4.0)
    assert abs(force[2]) < 1e-6


@pytest.mark.parametrize(
    ("parameters", "thrust"),
    [
        ("<clampMax>10</clampMax><clampMin>-10</clampMin>", 1.0),
        ("<gain>0.5</gain>", 1.0),
        ("<thrustMax>3</thrustMax><thrustMin>-3</thrustMin>", 3.0),
        ("<thrust_efficiency>0.5</thrust_efficiency>", 2.0),
        ("<propeller_efficiency>0.5</propeller_efficiency>", 1.0),
    ],
)
async def test_limits_and_efficiencies(parameters, thrust):
    _, recording, _ = await run(ZERO_ORDER + BASIC + parameters, 20.0)
    assert recording.last.data == pytest.approx(thrust)


async def test_first_order_dynamics_have_their_time_constant():
    dynamics = "<dynamics><type>FirstOrder</type><timeConstant>0.5</timeConstant></dynamics>"
    _, recording, _ = await run(dynamics + BASIC, 20.0, seconds=0.5)
    assert recording.last.data == pytest.approx(4.0 * (1 - exp(-1)) ** 2, rel=0.01)


@pytest.mark.parametrize(
    ("dynamics", "speed"),
    [
        ("<type>Yoerger</type><alpha>0.5</alpha><beta>2</beta>", sqrt(2 * 20 / 0.5)),
        (
            "<type>Bessa</type><Jmsp>0.1</Jmsp><Kv1>1</Kv1><Kv2>0.25</Kv2><Kt>2</Kt><Rm>0.5</Rm>",
            (-1 + sqrt(1 + 4 * 0.25 * 80)) / 0.5,
        ),
    ],
)
async def test_dynamics_settle_at_balance_of_torques(dynamics, speed):
    """Yoerger: beta c = alpha v2. Bessa: c Kt / Rm = Kv1 v + Kv2 v2."""
    _, recording, _ = await run(f"<dynamics>{dynamics}</dynamics>{BASIC}", 20.0, seconds=10.0)
    assert recording.last.data == pytest.approx(0.01 * speed**2, rel=0.001)


@pytest.mark.parametrize(
    ("conversion", "thrusts"),
    [
        (
            (
                "<type>Bessa</type><rotorConstantL>0.01</rotorConstantL><rotorConstantR>0.02</rotorConstantR>"
                "<deltaL>-25</deltaL><deltaR>36</deltaR>"
            ),
            {-10.0: 0.01 * -75, -4.0: 0.0, 5.0: 0.0, 10.0: 0.02 * 64},
        ),
        (
            "<type>LinearInterp</type><inputValues>10 0 -10</inputValues><outputValues>50 0 -30</outputValues>",
            {-20.0: -30.0, -5.0: -15.0, 2.0: 10.0, 30.0: 50.0},
        ),
    ],
)
async def test_conversions(conversion, thrusts):
    for command, thrust in thrusts.items():
        _, recording, _ = await run(f"{ZERO_ORDER}<conversion>{conversion}</conversion>", command, seconds=0.2)
        assert recording.last.data == pytest.approx(thrust)


@pytest.mark.parametrize(
    ("parameters", "text"),
    [
        (BASIC, "<dynamics> is missing"),
        (ZERO_ORDER, "<conversion> is missing"),
        ("<dynamics><type>Second</type></dynamics>" + BASIC, "must be one of ZeroOrder, FirstOrder, Yoerger, Bessa"),
        (ZERO_ORDER + "<conversion><type>Cubic</type></conversion>", "must be one of Basic, Bessa, LinearInterp"),
        (ZERO_ORDER + "<conversion><type>Basic</type></conversion>", "needs a number in <rotorConstant>"),
        (
            ZERO_ORDER + "<conversion><type>LinearInterp</type><inputValues>1</inputValues></conversion>",
            "must be equally many numbers",
        ),
    ],
)
async def test_invalid_parameters_are_reported(parameters, text):
    async with weightless_server(vehicle(parameters)) as (_, __, log):
        assert any(text in record.text for record in log), [record.text for record in log]
