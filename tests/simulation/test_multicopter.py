"""A flying model: rotors and the velocity controller of gz."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.messages import get_message
from tests.remote_publishers import RemotePublisher, RemoteTransport
from tests.simulation.test_lost_commanders import advance, forward_twist, logged_warnings
from tests.simulation.test_plugins import running_server
from tests.simulation.worlds import GROUND

FORCE_CONSTANT, MOMENT_CONSTANT = 8.54858e-06, 0.016
POSITIONS = {"front_right": (0.13, -0.2, "ccw"), "back_left": (-0.13, 0.2, "ccw"), "front_left": (0.13, 0.2, "cw")}
POSITIONS["back_right"] = (-0.13, -0.2, "cw")
MASS_KG = 1.5


def rotor_link(name: str, x: float, y: float) -> str:
    return (
        f'<link name="{name}"><pose>{x} {y} 0.02 0 0 0</pose><inertial><mass>0.005</mass><inertia><ixx>9.75e-07</ixx>'
        "<iyy>4.2e-05</iyy><izz>4.3e-05</izz></inertia></inertial></link>"
        f'<joint name="{name}_joint" type="revolute"><parent>body</parent><child>{name}</child><axis><xyz>0 0 1</xyz>'
        "<limit><lower>-1e16</lower><upper>1e16</upper></limit></axis></joint>"
    )


def motor_plugin(number: int, name: str, direction: str) -> str:
    return (
        '<plugin filename="gz-sim-multicopter-motor-model-system" name="gz::sim::systems::MulticopterMotorModel">'
        f"<robotNamespace>X3</robotNamespace><jointName>{name}_joint</jointName><linkName>{name}</linkName>"
        f"<turningDirection>{direction}</turningDirection><timeConstantUp>0.0125</timeConstantUp>"
        f"<timeConstantDown>0.025</timeConstantDown><maxRotVelocity>800</maxRotVelocity>"
        f"<motorConstant>{FORCE_CONSTANT}</motorConstant><momentConstant>{MOMENT_CONSTANT}</momentConstant>"
        f"<actuator_number>{number}</actuator_number><rotorDragCoefficient>8.06428e-05</rotorDragCoefficient>"
        "<rollingMomentCoefficient>1e-06</rollingMomentCoefficient><motorType>velocity</motorType></plugin>"
    )


def velocity_control_plugin(names: list[str]) -> str:
    rotors = "".join(
        f"<rotor><jointName>{name}_joint</jointName><forceConstant>{FORCE_CONSTANT}</forceConstant><momentConstant>{MOMENT_CONSTANT}"
        f"</momentConstant><direction>{1 if POSITIONS[name][2] == 'ccw' else -1}</direction></rotor>"
        for name in names
    )
    return (
        '<plugin filename="gz-sim-multicopter-control-system" name="gz::sim::systems::MulticopterVelocityControl">'
        "<robotNamespace>X3</robotNamespace><commandSubTopic>cmd_vel</commandSubTopic><enableSubTopic>enable"
        "</enableSubTopic><comLinkName>body</comLinkName><velocityGain>2.7 2.7 2.7</velocityGain>"
        "<attitudeGain>2 3 0.15</attitudeGain><angularRateGain>0.4 0.52 0.18</angularRateGain>"
        f"<rotorConfiguration>{rotors}</rotorConfiguration></plugin>"
    )


def quadcopter_model(names: list[str] | None = None) -> str:
    rotors = "".join(rotor_link(name, x, y) for name, (x, y, _) in POSITIONS.items())
    motors = "".join(
        motor_plugin(number, name, direction) for number, (name, (_, _, direction)) in enumerate(POSITIONS.items())
    )
    return (
        f'<model name="x3"><pose>0 0 0.1 0 0 0</pose><link name="body"><inertial><mass>{MASS_KG - 0.02}</mass><inertia>'
        "<ixx>0.0347563</ixx><iyy>0.07</iyy><izz>0.0977</izz></inertia></inertial><collision name='c'><geometry><box>"
        f"<size>0.47 0.47 0.11</size></box></geometry></collision></link>{rotors}{motors}"
        f"{velocity_control_plugin(list(POSITIONS) if names is None else names)}</model>"
    )


def copter_position(server) -> np.ndarray:
    return np.array(server.simulation.model_pose("x3")[:3])


def copter_velocity(server) -> np.ndarray:
    return server.simulation.link_velocity("x3::body")[0]


def climb_command(speed: float):
    command = forward_twist(0.0)
    command.linear.z = speed
    return command


async def test_multicopter_rises_hovers_and_flies_forward() -> None:
    async with running_server(GROUND, quadcopter_model()) as (server, graph, log):
        driver = graph.create_node("driver").create_publisher(get_message("geometry_msgs/msg/Twist"), "/X3/cmd_vel", 10)
        await advance(server, graph, 0.5)
        begin = copter_position(server)
        driver.publish(climb_command(0.5))
        await advance(server, graph, 4.0)
        assert copter_velocity(server) == pytest.approx([0.0, 0.0, 0.5], abs=0.02)
        assert copter_position(server)[2] - begin[2] > 1.0
        driver.publish(climb_command(0.0))
        await advance(server, graph, 3.0)
        assert copter_velocity(server) == pytest.approx([0.0, 0.0, 0.0], abs=0.01)
        motors = [plugin for plugin in server.plugins("x3") if hasattr(plugin, "speed")]
        assert sum(FORCE_CONSTANT * motor.speed**2 for motor in motors) == pytest.approx(MASS_KG * 9.8, rel=1e-3)
        driver.publish(forward_twist(1.0))
        await advance(server, graph, 4.0)
        assert copter_velocity(server)[0] == pytest.approx(1.0, abs=0.1)
        assert abs(copter_velocity(server)[1]) < 0.02
        assert logged_warnings(log) == []


async def test_rotor_speeds_can_be_commanded_by_actuator_number() -> None:
    async with running_server(GROUND, quadcopter_model()) as (server, graph, log):
        message_type = get_message("actuator_msgs/msg/Actuators")
        driver = graph.create_node("driver").create_publisher(message_type, "/X3/command/motor_speed", 10)
        hover_speed = (MASS_KG * 9.8 / 4 / FORCE_CONSTANT) ** 0.5
        driver.publish(message_type(velocity=[1.1 * hover_speed] * 4))
        await advance(server, graph, 1.0)
        assert copter_velocity(server)[2] == pytest.approx(0.21 * 9.8, rel=0.15)
        driver.publish(message_type(velocity=[float("nan"), 0.0]))  # NaN, zero, and two motors without a command
        await advance(server, graph, 0.5)
        motors = {
            plugin.parameters.actuator_number: plugin for plugin in server.plugins("x3") if hasattr(plugin, "speed")
        }
        assert [motors[number].speed > 1.0 for number in range(4)] == [True, False, True, True]
        assert logged_warnings(log) == []


async def test_multicopter_yaws_at_commanded_rate() -> None:
    async with running_server(GROUND, quadcopter_model()) as (server, graph, _):
        driver = graph.create_node("driver").create_publisher(get_message("geometry_msgs/msg/Twist"), "/X3/cmd_vel", 10)
        driver.publish(climb_command(0.5))
        await advance(server, graph, 3.0)
        command = climb_command(0.0)
        command.angular.z = 0.5
        driver.publish(command)
        await advance(server, graph, 4.0)
        assert server.simulation.link_velocity("x3::body")[1][2] == pytest.approx(0.5, abs=0.05)


async def test_multicopter_hovers_without_pilot_and_falls_when_disabled() -> None:
    async with running_server(GROUND, quadcopter_model()) as (server, graph, log):
        pilot = RemotePublisher(RemoteTransport(graph), "/X3/cmd_vel")
        pilot.send(climb_command(0.5))
        await advance(server, graph, 4.0)
        pilot.disappear()
        await advance(server, graph, 4.0)
        assert copter_velocity(server) == pytest.approx([0.0, 0.0, 0.0], abs=0.02)
        assert len(logged_warnings(log)) == 1
        switch = graph.create_node("switch").create_publisher(get_message("std_msgs/msg/Bool"), "/X3/enable", 10)
        switch.publish(switch.msg_type(data=False))
        await advance(server, graph, 0.3)
        assert copter_velocity(server)[2] < -1.0


async def test_rotors_that_cannot_control_flight_are_rejected() -> None:
    async with running_server(GROUND, quadcopter_model(["front_right", "back_left", "front_left"])) as (_, __, log):
        (logged,) = logged_warnings(log)
        assert "its rotors cannot control thrust and all three torques" in logged


async def test_rotor_with_missing_constant_is_reported() -> None:
    text = quadcopter_model().replace(f"<momentConstant>{MOMENT_CONSTANT}</momentConstant><direction>", "<direction>")
    async with running_server(GROUND, text) as (_, __, log):
        (logged,) = logged_warnings(log)
        assert "<rotor> needs a number in <momentConstant>" in logged
