"""Water resists motion: terminal speed, added mass, currents, thrust."""

from __future__ import annotations

from math import sqrt

import pytest

from linkwright.messages import get_message
from tests.simulation.fluids.server import weightless_server
from tests.simulation.test_plugins import SECOND_NS
from tests.simulation.worlds import box

FLOAT = "std_msgs/msg/Float64"


def hydrodynamics_plugin(parameters: str) -> str:
    return (
        '<plugin name="gz::sim::systems::Hydrodynamics" filename="gz-sim-hydrodynamics-system">'
        f"<link_name>link</link_name>{parameters}</plugin>"
    )


def sinking_body(*plugins: str, mass: float = 100.0) -> str:
    return box("body", "0 0 0 0 0 0", mass=mass).replace("</model>", "".join(plugins) + "</model>")


def apply_force(server, force: float) -> None:
    server.simulation.push("body::link", (force, 0.0, 0.0), by="test")


def vertical_speed(server) -> float:
    return float(server.simulation.link_velocity("body::link")[0][0])


@pytest.mark.parametrize(
    ("derivative", "terminal_speed"),
    [("<xU>-50</xU>", 2.0), ("<xUabsU>-25</xUabsU>", 2.0), ("<xU>-25</xU><xUU>-12.5</xUU>", 2.0)],
)
async def test_body_reaches_speed_at_which_drag_equals_force(derivative, terminal_speed):
    async with weightless_server(sinking_body(hydrodynamics_plugin(derivative))) as (server, _, log):
        apply_force(server, 100.0)
        server.advance(30 * SECOND_NS)
        assert vertical_speed(server) == pytest.approx(terminal_speed, rel=0.005)
        assert not log


@pytest.mark.parametrize("added_mass", [50.0, 100.0, 1000.0])
async def test_added_mass_slows_acceleration(added_mass):
    plugin = hydrodynamics_plugin(f"<xDotU>{-added_mass}</xDotU>")
    async with weightless_server(sinking_body(plugin), step=0.001) as (server, _, __):
        apply_force(server, 100.0)
        server.advance(2 * SECOND_NS)
        assert vertical_speed(server) == pytest.approx(2.0 * 100.0 / (100.0 + added_mass), rel=0.01)


@pytest.mark.parametrize("switch", ["disable_added_mass", "disable_coriolis"])
async def test_effects_can_be_disabled(switch):
    plugin = hydrodynamics_plugin(f"<xDotU>-100</xDotU><{switch}>true</{switch}>")
    async with weightless_server(sinking_body(plugin), step=0.001) as (server, _, __):
        apply_force(server, 100.0)
        server.advance(SECOND_NS)
        mass = 100.0 if switch == "disable_added_mass" else 200.0
        assert vertical_speed(server) == pytest.approx(100.0 / mass, rel=0.01)


async def test_added_mass_turns_body_that_moves_obliquely_across_its_course():
    """The Munk moment (X - Y) u v, with the added masses X along and Y across."""
    for extra, expected in (("", 10.0 - 60.0), ("<disable_coriolis>true</disable_coriolis>", 0.0)):
        plugin = hydrodynamics_plugin(f"<xDotU>-10</xDotU><yDotV>-60</yDotV>{extra}")
        async with weightless_server(sinking_body(plugin), step=0.001) as (server, _, __):
            server.simulation.set_model_velocity("body", (1.0, 1.0, 0.0), (0.0, 0.0, 0.0))
            server.advance(SECOND_NS // 20)
            (u, v, _), (_, _, turning) = server.simulation.link_velocity("body::link")
            assert turning * (100.0 / 6.0) / 0.05 == pytest.approx(expected * u * v, rel=0.05, abs=0.01)


async def test_body_drifts_with_current_of_parameter_and_topic():
    plugin = hydrodynamics_plugin("<xU>-200</xU><default_current>0.5 0 0</default_current><namespace>sub</namespace>")
    async with weightless_server(sinking_body(plugin)) as (server, graph, _):
        server.advance(5 * SECOND_NS)
        assert vertical_speed(server) == pytest.approx(0.5, rel=0.01)
        node = graph.create_node("sea")
        type_name = "geometry_msgs/msg/Vector3"
        publisher = node.create_publisher(type_name, "/model/sub/ocean_current", 10)
        publisher.publish(get_message(type_name)(x=-0.25))
        await graph.settle()
        server.advance(5 * SECOND_NS)
        assert vertical_speed(server) == pytest.approx(-0.25, rel=0.01)
        server.reset()
        server.advance(5 * SECOND_NS)
        assert vertical_speed(server) == pytest.approx(0.5, rel=0.01)


async def test_derivative_that_is_not_a_number_is_reported():
    async with weightless_server(sinking_body(hydrodynamics_plugin("\n<xU>strong</xU>"))) as (_, __, log):
        assert any("test.world:2:1: " in r.text and "<plugin> needs a number in <xU>" in r.text for r in log)


# --- thrusters --------------------------------------------------------------------------------------------------------

PROPELLER = (
    '<link name="propeller"><pose>-0.6 0 0 0 0 0</pose><inertial><mass>0.1</mass><inertia><ixx>0.01</ixx>'
    "<iyy>0.01</iyy><izz>0.01</izz></inertia></inertial></link>"
    '<joint name="shaft" type="revolute"><parent>link</parent><child>propeller</child><axis><xyz>1 0 0</xyz></axis>'
    "</joint>"
)
SHAFT = "/model/body/joint/shaft"


def boat_model(parameters: str, drag: str = "<xUabsU>-25</xUabsU>") -> str:
    plugin = (
        '<plugin name="gz::sim::systems::Thruster" filename="gz-sim-thruster-system"><joint_name>shaft</joint_name>'
        f"<propeller_diameter>0.2</propeller_diameter><thrust_coefficient>0.5</thrust_coefficient>{parameters}</plugin>"
    )
    return sinking_body(PROPELLER, hydrodynamics_plugin(f"{drag}<kP>-500</kP>"), plugin)


async def publish_command(graph, server, topic: str, value: float, seconds: float, type_name: str = FLOAT) -> None:
    node = graph.create_node("helm")
    publisher = node.create_publisher(type_name, topic, 10)
    publisher.publish(get_message(type_name)(data=value))
    await graph.settle()
    server.advance(round(seconds * SECOND_NS))


async def test_boat_reaches_speed_at_which_drag_equals_thrust():
    async with weightless_server(boat_model("")) as (server, graph, log):
        await publish_command(graph, server, f"{SHAFT}/cmd_thrust", 100.0, 40.0)
        assert vertical_speed(server) == pytest.approx(sqrt(100.0 / 25.0), rel=0.01)
        propeller_speed = server.simulation.joint_state("body::shaft")[1]
        assert propeller_speed == pytest.approx(sqrt(100.0 / (0.5 * 1000.0 * 0.2**4)), rel=0.02)
        assert not log


@pytest.mark.parametrize("control", ["", "<velocity_control>true</velocity_control>"])
async def test_speed_of_propeller_is_command_or_feedback(control):
    factor = 0.5 * 1000.0 * 0.2**4
    parameters = f"<use_angvel_cmd>true</use_angvel_cmd>{control}"
    async with weightless_server(boat_model(parameters)) as (server, graph, _):
        thrusts: list[float] = []
        node = graph.create_node("listener")
        node.create_subscription(FLOAT, f"{SHAFT}/force", lambda message: thrusts.append(message.data), 10)
        await publish_command(graph, server, f"{SHAFT}/cmd_vel", -10.0, 20.0)
        await graph.settle()
        assert server.simulation.joint_state("body::shaft")[1] == pytest.approx(-10.0, abs=0.2)
        assert thrusts[-1] == pytest.approx(-factor * 100.0)
        assert vertical_speed(server) == pytest.approx(-sqrt(factor * 100.0 / 25.0), rel=0.02)


async def test_thrust_is_clamped_and_deadband_suppresses_it():
    limits = "<max_thrust_cmd>25</max_thrust_cmd><min_thrust_cmd>-25</min_thrust_cmd><deadband>10</deadband>"
    async with weightless_server(boat_model(limits)) as (server, graph, _):
        await publish_command(graph, server, f"{SHAFT}/cmd_thrust", 5.0, 2.0)
        assert vertical_speed(server) == pytest.approx(0.0, abs=1e-6)
        await publish_command(graph, server, f"{SHAFT}/enable_deadband", False, 10.0, "std_msgs/msg/Bool")
        assert vertical_speed(server) > 0.1
        await publish_command(graph, server, f"{SHAFT}/cmd_thrust", 1000.0, 40.0)
        assert vertical_speed(server) == pytest.approx(1.0, rel=0.01)


async def test_topic_and_namespace_name_command():
    parameters = "<namespace>usv</namespace><topic>left/thrust</topic>"
    async with weightless_server(boat_model(parameters)) as (server, graph, _):
        await publish_command(graph, server, "/usv/left/thrust", 25.0, 40.0)
        assert vertical_speed(server) == pytest.approx(1.0, rel=0.01)


async def test_inflow_reduces_thrust_coefficient():
    """At a constant speed w of the propeller, K is alpha_1 + alpha_2 (1 - wake) v / (w D)."""
    parameters = "<use_angvel_cmd>true</use_angvel_cmd><velocity_control>true</velocity_control>"
    coefficients = "<alpha_1>0.5</alpha_1><alpha_2>-1</alpha_2><wake_fraction>0.5</wake_fraction>"
    text = boat_model(parameters + coefficients).replace("<thrust_coefficient>0.5</thrust_coefficient>", "")
    async with weightless_server(text) as (server, graph, _):
        await publish_command(graph, server, f"{SHAFT}/cmd_vel", 20.0, 60.0)
        v = vertical_speed(server)
        thrust = (0.5 - 0.5 * v / (20.0 * 0.2)) * 1000.0 * 0.2**4 * 400.0
        assert thrust == pytest.approx(25.0 * v * v, rel=0.02)


async def test_propeller_stops_when_time_restarts():
    async with weightless_server(boat_model("")) as (server, graph, _):
        await publish_command(graph, server, f"{SHAFT}/cmd_thrust", 100.0, 5.0)
        server.reset()
        server.advance(2 * SECOND_NS)
        assert vertical_speed(server) == pytest.approx(0.0, abs=1e-6)
