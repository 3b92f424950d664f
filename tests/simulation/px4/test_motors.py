"""Rotors of PX4's models: thrust, torque and drag against their formulas, time constants, failures."""

from __future__ import annotations

from math import exp

import numpy as np
import pytest

from linkwright.loading.extensions import extensions
from linkwright.messages import get_message
from linkwright.simulation.plugins.registry import PLUGIN_GROUP
from linkwright.testing import Recording
from tests.simulation.test_plugins import SECOND_NS, running_server

ACTUATORS = "actuator_msgs/msg/Actuators"
COMMANDS = "/uav/gazebo/command/motor_speed"
MOTOR_CONSTANT, MOMENT_CONSTANT, SPEED = 5.84e-06, 0.06, 400.0
THRUST = MOTOR_CONSTANT * SPEED**2
TILTED = "0 0 2 0.5 0 0"


def rotor(number: int, parameters: str, direction: str = "ccw") -> str:
    return (
        f'<link name="rotor_{number}"><inertial><mass>0.005</mass><inertia><ixx>1e-05</ixx><iyy>1e-05</iyy>'
        f"<izz>1e-05</izz></inertia></inertial></link>"
        f'<joint name="rotor_{number}_joint" type="revolute"><parent>base_link</parent><child>rotor_{number}</child>'
        "<axis><xyz>0 0 1</xyz><limit><lower>-1e16</lower><upper>1e16</upper></limit></axis></joint>"
        f'<plugin name="motor_{number}" filename="libgazebo_motor_model.so"><robotNamespace/>'
        f"<jointName>rotor_{number}_joint</jointName><linkName>rotor_{number}</linkName>"
        f"<turningDirection>{direction}</turningDirection><motorNumber>{number}</motorNumber>"
        f"<maxRotVelocity>1100</maxRotVelocity><motorConstant>{MOTOR_CONSTANT}</motorConstant>"
        f"<momentConstant>{MOMENT_CONSTANT}</momentConstant>{parameters}</plugin>"
    )


def uav(parameters: str = "", direction: str = "ccw", pose: str = "0 0 2 0 0 0", extra: str = "") -> str:
    """Return a heavy model with a rotor at its center, which does not accelerate much."""
    return (
        f'<model name="uav"><pose>{pose}</pose><link name="base_link"><inertial><mass>1e6</mass><inertia><ixx>1e6</ixx>'
        f"<iyy>1e6</iyy><izz>1e6</izz></inertia></inertial></link>{rotor(0, parameters, direction)}{extra}</model>"
    )


async def command(graph, *speeds: float, topic: str = COMMANDS) -> None:
    publisher = graph.create_node("pilot").create_publisher(ACTUATORS, topic, 10)
    publisher.publish(get_message(ACTUATORS)(velocity=list(speeds)))
    await graph.settle()


def wrench(server, link: str) -> np.ndarray:
    simulation = server.simulation
    return simulation.data.xfrc_applied[simulation.body(f"uav::{link}")].copy()


@pytest.mark.parametrize(("direction", "sign"), [("ccw", 1.0), ("cw", -1.0)])
async def test_thrust_and_torque_follow_squared_speed_along_axis(direction, sign):
    async with running_server(uav(direction=direction, pose=TILTED), gravity="0 0 0") as (server, graph, log):
        await command(graph, SPEED)
        server.advance(SECOND_NS)
        axis = np.array((0.0, -np.sin(0.5), np.cos(0.5)))
        assert wrench(server, "rotor_0")[:3] == pytest.approx(THRUST * axis, rel=1e-3, abs=1e-6)
        assert wrench(server, "base_link")[3:] == pytest.approx(
            -sign * MOMENT_CONSTANT * THRUST * axis, rel=1e-3, abs=1e-6
        )
        assert not log


async def test_speed_follows_command_with_time_constants_of_both_directions():
    parameters = "<timeConstantUp>0.1</timeConstantUp><timeConstantDown>0.3</timeConstantDown>"
    async with running_server(uav(parameters), gravity="0 0 0") as (server, graph, _):
        await command(graph, SPEED)
        server.advance(SECOND_NS // 10)
        thrust = THRUST * (1 - exp(-1)) ** 2
        assert wrench(server, "rotor_0")[2] == pytest.approx(thrust, rel=0.03)
        server.advance(2 * SECOND_NS)
        await command(graph, 0.0)
        server.advance(3 * SECOND_NS // 10)
        assert wrench(server, "rotor_0")[2] == pytest.approx(THRUST * exp(-1) ** 2, rel=0.03)


async def test_speed_is_limited():
    async with running_server(uav(), gravity="0 0 0") as (server, graph, _):
        await command(graph, 5000.0)
        server.advance(SECOND_NS)
        assert wrench(server, "rotor_0")[2] == pytest.approx(MOTOR_CONSTANT * 1100.0**2, rel=1e-3)


@pytest.mark.parametrize("reversible", [False, True])
async def test_reversible_rotor_pulls_down(reversible):
    parameters = f"<reversible>{str(reversible).lower()}</reversible>"
    async with running_server(uav(parameters), gravity="0 0 0") as (server, graph, _):
        await command(graph, -SPEED)
        server.advance(SECOND_NS)
        assert wrench(server, "rotor_0")[2] == pytest.approx(-THRUST if reversible else THRUST, rel=1e-3)


@pytest.mark.parametrize(("climb", "share"), [(5.0, 0.8), (-10.0, 0.6), (30.0, 0.0)])
async def test_thrust_vanishes_at_maximum_airspeed(climb, share):
    async with running_server(uav(), gravity="0 0 0") as (server, graph, _):
        server.simulation.set_model_velocity("uav", (0.0, 0.0, climb), (0.0, 0.0, 0.0))
        await command(graph, SPEED)
        server.advance(SECOND_NS)
        assert wrench(server, "rotor_0")[2] == pytest.approx(share * THRUST, rel=1e-3, abs=1e-6)


@pytest.mark.parametrize("is_wind", [False, True])
async def test_drag_and_rolling_moment_follow_air_across_axis(is_wind):
    parameters = (
        "<rotorDragCoefficient>1e-4</rotorDragCoefficient><rollingMomentCoefficient>2e-6</rollingMomentCoefficient>"
    )
    async with running_server(uav(parameters, "cw"), gravity="0 0 0") as (server, graph, _):
        if is_wind:
            server.simulation.wind = (-3.0, 0.0, 0.0)
        else:
            server.simulation.set_model_velocity("uav", (3.0, 0.0, 0.0), (0.0, 0.0, 0.0))
        await command(graph, SPEED)
        server.advance(SECOND_NS)
        assert wrench(server, "rotor_0")[0] == pytest.approx(-1e-4 * SPEED * 3.0, rel=0.01)
        assert wrench(server, "base_link")[3] == pytest.approx(2e-6 * SPEED * 3.0, rel=0.01)


async def test_motor_fails_and_is_repaired():
    async with running_server(uav(extra=rotor(1, "")), gravity="0 0 0") as (server, graph, _):
        publisher = graph.create_node("saboteur").create_publisher(
            "std_msgs/msg/Int32", "/gazebo/motor_failure_num", 10
        )
        await command(graph, SPEED, SPEED)
        for number, expected in ((2, (THRUST, 0.0)), (1, (0.0, THRUST)), (0, (THRUST, THRUST))):
            publisher.publish(get_message("std_msgs/msg/Int32")(data=number))
            await graph.settle()
            server.advance(SECOND_NS)
            thrusts = [wrench(server, f"rotor_{index}")[2] for index in range(2)]
            assert thrusts == pytest.approx(expected, rel=1e-3, abs=1e-6)


async def test_namespace_and_topic_replace_those_of_the_model():
    body = uav("<commandSubTopic>/speeds</commandSubTopic>")
    body = body.replace("<robotNamespace/>", "<robotNamespace>a/b</robotNamespace>")
    async with running_server(body, gravity="0 0 0") as (server, graph, _):
        await command(graph, SPEED, topic="/a/b/speeds")
        server.advance(SECOND_NS)
        assert wrench(server, "rotor_0")[2] == pytest.approx(THRUST, rel=1e-3)


async def test_base_plugin_publishes_speeds_in_order_of_rotors():
    plugin = (
        '<plugin name="base" filename="libgazebo_multirotor_base_plugin.so"><robotNamespace/>'
        "<linkName>base_link</linkName><rotorVelocitySlowdownSim>10</rotorVelocitySlowdownSim></plugin>"
    )
    body = uav(extra=rotor(1, "", "cw") + plugin)
    async with running_server(body, gravity="0 0 0") as (server, graph, log):
        recording = Recording(graph, server.node, "/uav/motors")
        await command(graph, 300.0, 500.0)
        server.advance(2 * SECOND_NS)
        await graph.settle()
        assert list(recording.last.velocity) == pytest.approx([300.0, -500.0], rel=0.02)
        assert recording.last.header.stamp.sec == 2
        assert not log


@pytest.mark.parametrize(
    ("library", "alternative", "text"),
    [
        ("libgazebo_ros_realsense.so", "gazebo_ros_camera", "libgazebo_ros_camera.so in the <sensor>"),
        ("libuuv_gazebo_ros_camera_plugin.so", "gazebo_ros_camera", "libgazebo_ros_camera.so in the <sensor>"),
        ("librmagine_embree_ros_gzplugin.so", "gazebo_ros_ray_sensor", "libgazebo_ros_ray_sensor.so in a <sensor>"),
    ],
)
async def test_libraries_with_simulated_alternative_are_told_of(library, alternative, text):
    assert alternative in extensions(PLUGIN_GROUP)
    plugin = f'<plugin name="a" filename="{library}"/>'
    async with running_server(uav(extra=plugin)) as (_, __, log):
        assert f"instead of {library}, use {text}" in log[1].text
