"""Systems of PX4 for gz: motors with polynomials, motor failures, and moving platforms."""

from __future__ import annotations

from math import cos, radians, sin

import numpy as np
import pytest

from linkwright.messages import get_message
from tests.simulation.px4.test_motors import SPEED, THRUST, command, rotor, uav, wrench
from tests.simulation.test_plugins import SECOND_NS, running_server
from tests.simulation.worlds import box

COMMANDS = "/uav/command/motor_speed"
TOPIC = "<commandSubTopic>command/motor_speed</commandSubTopic>"
PULSES = (
    "<motorType>force_polynomial</motorType><controlMethod>duty_cycle</controlMethod><minCommand>0.075</minCommand>"
    "<minDutyCycle>1100</minDutyCycle><maxDutyCycle>1900</maxDutyCycle><bidirectionalMotor>1</bidirectionalMotor>"
    "<positiveThrustPolynomial>0.0, 10.0, 20.0, 5.0</positiveThrustPolynomial>"
    "<negativeThrustPolynomial>1.0 8.0 0.0 0.0</negativeThrustPolynomial>"
)


def vehicle(parameters: str = "", extra: str = "", filename: str = "libGenericMotorModelPlugin.so") -> str:
    return uav(parameters + TOPIC, extra=extra).replace("libgazebo_motor_model.so", filename)


@pytest.mark.parametrize(("speed", "sign"), [(SPEED, 1.0), (-SPEED, -1.0)])
async def test_thrust_has_the_sign_of_the_speed(speed, sign):
    async with running_server(vehicle(), gravity="0 0 0") as (server, graph, log):
        await command(graph, speed, topic=COMMANDS)
        server.advance(SECOND_NS)
        assert wrench(server, "rotor_0")[2] == pytest.approx(sign * THRUST, rel=1e-3)
        assert not log


@pytest.mark.parametrize(
    ("pulse", "thrust"),
    [
        (1700.0, 10 * 0.5 + 20 * 0.5**2 + 5 * 0.5**3),
        (1300.0, -(1 + 8 * 0.5)),
        (1520.0, 0.0),  # 0.05 is below the minimum
        (900.0, 0.0),  # no pulse
    ],
)
async def test_polynomial_gives_thrust_of_a_pulse(pulse, thrust):
    async with running_server(vehicle(PULSES), gravity="0 0 0") as (server, graph, log):
        await command(graph, pulse, topic=COMMANDS)
        server.advance(SECOND_NS // 100)
        assert wrench(server, "rotor_0")[2] == pytest.approx(thrust, abs=1e-9)
        assert not log


@pytest.mark.parametrize(
    ("parameters", "text"),
    [
        ("<motorType>force</motorType>", "<motorType> must be 'velocity' or 'force_polynomial'"),
        ("<motorType>force_polynomial</motorType>", "<positiveThrustPolynomial> and <negativeThrustPolynomial> need"),
        ("<controlMethod>duty_cycle</controlMethod>", "<maxDutyCycle> must be greater than <minDutyCycle>"),
    ],
)
async def test_motor_that_cannot_run_is_told_of(parameters, text):
    async with running_server(vehicle(parameters)) as (_, __, log):
        assert text in log[0].text


async def test_message_blocks_a_rotor_and_releases_it():
    failure = '<plugin name="failure" filename="libMotorFailurePlugin.so"/>'
    text = vehicle(extra=rotor(1, TOPIC) + failure, filename="gz-sim-multicopter-motor-model-system")
    async with running_server(text, gravity="0 0 0") as (server, graph, log):
        failures = graph.create_node("fate").create_publisher(
            "std_msgs/msg/Int32", "/model/uav/motor_failure/motor_number", 1
        )
        await command(graph, SPEED, SPEED, topic=COMMANDS)
        for number, thrusts in ((0, (THRUST, THRUST)), (2, (THRUST, 0.0)), (0, (THRUST, THRUST))):
            failures.publish(get_message("std_msgs/msg/Int32")(data=number))
            await graph.settle()
            server.advance(SECOND_NS)
            measured = [wrench(server, f"rotor_{index}")[2] for index in range(2)]
            assert measured == pytest.approx(list(thrusts), rel=1e-3, abs=1e-9)
        assert not log


async def test_platform_keeps_velocity_and_height_against_gravity(monkeypatch):
    monkeypatch.setenv("PX4_GZ_PLATFORM_VEL", "2.0")
    monkeypatch.setenv("PX4_GZ_PLATFORM_HEADING_DEG", "30")
    plugin = '<plugin name="p" filename="libMovingPlatformController.so"><link_name>link</link_name></plugin>'
    text = box("platform", "0 0 3 0 0 0", mass=10000.0).replace("</model>", f"{plugin}</model>")
    async with running_server(text, step=0.004) as (server, _, log):
        simulation, heights, velocities = server.simulation, [], []
        server.advance(10 * SECOND_NS)
        for _ in range(100):
            server.advance(SECOND_NS // 5)
            heights.append(simulation.link_pose("platform::link")[2])
            velocities.append(simulation.link_velocity("platform::link")[0])
        assert np.mean(velocities, axis=0) == pytest.approx((2 * cos(radians(30)), 2 * sin(radians(30)), 0.0), abs=0.15)
        assert np.mean(heights) == pytest.approx(3.0, abs=0.15)
        assert np.std(heights) > 0.001  # it shakes
        assert not log
