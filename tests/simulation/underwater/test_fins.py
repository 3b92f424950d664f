"""Fins of vehicles: angle, lift and drag against their formulas."""

from __future__ import annotations

from math import atan2, exp, hypot

import numpy as np
import pytest

from linkwright.messages import get_message
from linkwright.simulation.server.server import ServerOptions
from linkwright.testing import Recording
from tests.simulation.fluids.server import weightless_server
from tests.simulation.test_plugins import SECOND_NS

FLOAT = "uuv_gazebo_ros_plugins_msgs/msg/FloatStamped"
QUADRATIC = "<type>Quadratic</type><lift_constant>4</lift_constant><drag_constant>3</drag_constant>"
TWO_LINES = (
    "<type>TwoLines</type><area>0.02</area><fluid_density>1000</fluid_density><a0>0</a0>"
    "<alpha_stall>0.3</alpha_stall><cla>2</cla><cla_stall>-1</cla_stall><cda>0.5</cda><cda_stall>1.5</cda_stall>"
)


def vehicle(formula: str = QUADRATIC, time_constant: float = 0.0) -> str:
    """Return a heavy vehicle with a fin that turns about z."""
    return (
        '<model name="uuv"><link name="hull"><inertial><mass>1e6</mass><inertia><ixx>1e6</ixx><iyy>1e6</iyy>'
        "<izz>1e6</izz></inertia></inertial></link>"
        '<link name="fin"><inertial><mass>1</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia>'
        '</inertial></link><joint name="hinge" type="revolute"><parent>hull</parent><child>fin</child>'
        "<axis><xyz>0 0 1</xyz><limit><lower>-0.8</lower><upper>0.8</upper></limit></axis></joint>"
        '<plugin name="f" filename="libuuv_fin_ros_plugin.so"><fin_id>0</fin_id><link_name>fin</link_name>'
        "<joint_name>hinge</joint_name><current_velocity_topic>/current</current_velocity_topic>"
        f"<dynamics><type>FirstOrder</type><timeConstant>{time_constant}</timeConstant></dynamics>"
        f"<liftdrag>{formula}</liftdrag></plugin></model>"
    )


async def run(
    command: float,
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0),
    *,
    text: str = "",
    seconds: float = 1.0,
    options: ServerOptions | None = None,
):
    """Return the angle of the hinge, the force on the fin in its axes, and the last published angle and force."""
    async with weightless_server(text or vehicle(), options=options) as (server, graph, log):
        angles = Recording(graph, server.node, "/uuv/fins/_0/output")
        forces = Recording(graph, server.node, "/uuv/fins/_0/wrench_topic")
        node = graph.create_node("pilot")
        node.create_publisher(FLOAT, "/uuv/fins/_0/input", 10).publish(get_message(FLOAT)(data=command))
        current = get_message("geometry_msgs/msg/TwistStamped")()
        current.twist.linear.x, current.twist.linear.y, current.twist.linear.z = (-value for value in velocity)
        node.create_publisher("geometry_msgs/msg/TwistStamped", "/current", 10).publish(current)
        await graph.settle()
        server.advance(round(seconds * SECOND_NS))
        await graph.settle()
        assert not log, [record.text for record in log]
        simulation = server.simulation
        body = simulation.body("uuv::fin")
        force = simulation.data.xfrc_applied[body][:3] @ simulation.data.xmat[body].reshape(3, 3)
        published = forces.last.wrench.force
        assert (published.x, published.y, published.z) == pytest.approx(tuple(force), rel=0.05, abs=0.05)
        return simulation.joint_state("uuv::hinge")[0], force, angles.last.data


@pytest.mark.parametrize(("command", "angle"), [(0.3, 0.3), (5.0, 0.8), (-5.0, -0.8)])
async def test_fin_turns_to_the_commanded_angle_within_its_limits(command, angle):
    position, _, published = await run(command)
    assert position == pytest.approx(angle, abs=0.01)
    assert published == pytest.approx(angle, abs=0.01)


async def test_drive_of_first_order_delays_the_fin():
    _, _, published = await run(0.5, text=vehicle(time_constant=1.0), seconds=1.0)
    assert published == pytest.approx(0.5 * (1.0 - exp(-1.0)), abs=0.01)


def expected_force(x: float, y: float, lift: float, drag: float) -> np.ndarray:
    speed = hypot(x, y)
    return np.array((lift * y - drag * x, -lift * x - drag * y, 0.0)) / speed


@pytest.mark.parametrize("angle", [0.2, -0.4])
async def test_quadratic_lift_and_drag(angle):
    _, force, _ = await run(angle, (2.0, 0.0, 0.0))
    x, y = 2.0 * np.cos(angle), -2.0 * np.sin(angle)
    attack = atan2(y, x)
    assert force == pytest.approx(expected_force(x, y, 4.0 * attack * 4.0, 3.0 * attack**2 * 4.0), rel=0.03, abs=0.03)


@pytest.mark.parametrize(
    ("angle", "lift", "drag"), [(-0.2, 0.4, 0.1), (-0.5, 0.6 - 0.2, 0.15 + 0.3), (0.5, -0.6 + 0.2, 0.15 + 0.3)]
)
async def test_two_lines_change_their_slope_at_the_angle_of_stall(angle, lift, drag):
    _, force, _ = await run(angle, (2.0, 0.0, 0.0), text=vehicle(TWO_LINES))
    pressure = 0.5 * 1000.0 * 4.0 * 0.02
    x, y = 2.0 * np.cos(angle), -2.0 * np.sin(angle)
    assert force == pytest.approx(expected_force(x, y, lift * pressure, drag * pressure), rel=0.05, abs=0.5)


async def test_mistake_of_drag_at_negative_angles_is_repeated_on_request():
    options = ServerOptions(gazebo_mistakes=True)
    _, force, _ = await run(0.2, (2.0, 0.0, 0.0), text=vehicle(TWO_LINES), options=options)
    pressure = 0.5 * 1000.0 * 4.0 * 0.02
    x, y = 2.0 * np.cos(0.2), -2.0 * np.sin(0.2)
    assert force == pytest.approx(expected_force(x, y, -0.4 * pressure, -0.1 * pressure), rel=0.05, abs=0.5)


async def test_unknown_formula_is_refused():
    async with weightless_server(vehicle("<type>Cubic</type>")) as (_, __, log):
        assert "the <type> of <liftdrag> must be one of Quadratic, TwoLines" in log[0].text
