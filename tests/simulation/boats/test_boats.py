"""A boat floats, heaves, drives and drifts as its formulas say."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
import pytest

from linkwright.messages import get_message
from linkwright.simulation.plugins.boats.waves import CONSTANT_RATIO, WaveField, WaveParameters
from linkwright.simulation.server.server import ServerOptions
from tests.simulation.boats.boat import (
    DENSITY,
    HULL_LENGTH,
    HULL_RADIUS,
    LINK,
    MASS,
    PROPELLER,
    boat,
    drag_plugin,
    hull_plugin,
    two_hulls,
)
from tests.simulation.fluids.server import running_server
from tests.simulation.test_plugins import SECOND_NS

DAMPING = "<zW>500</zW><kP>300</kP><mQ>600</mQ><nR>800</nR>"
PARAMETERS = "ros_gz_interfaces/msg/ParamVec"
WAVES = "/sea/waves"


def segment_area(depth: float) -> float:
    """Return the area of the segment of the hull's circle below the water, by integration."""
    count = 20_000
    z = (np.arange(count) + 0.5) * depth / count
    return float((2 * np.sqrt(HULL_RADIUS**2 - (HULL_RADIUS - z) ** 2)).sum() * depth / count)


def find_draught(mass: float) -> float:
    depths = np.linspace(0.0, HULL_RADIUS, 2001)
    displaced = np.array([2 * HULL_LENGTH * DENSITY * segment_area(depth) for depth in depths])
    return float(np.interp(mass, displaced, depths))


def wavefield(text: str = "") -> str:
    return f"<wavefield><topic>{WAVES}</topic>{text}</wavefield>"


def long_waves(amplitude: float, period: float) -> str:
    return wavefield(
        f"<wave><model>CWR</model><number>1</number><amplitude>{amplitude}</amplitude><period>{period}</period>"
        "<tau>0</tau></wave>"
    )


def height(server) -> float:
    return float(server.simulation.link_pose(LINK)[2])


def speed(server) -> float:
    return float(server.simulation.link_velocity(LINK)[0][0])


async def test_draught_is_that_of_segments_which_displace_mass():
    async with running_server(boat("0 0 0 0 0 0", two_hulls(), drag_plugin(DAMPING))) as (server, _, log):
        server.advance(20 * SECOND_NS)
        assert -height(server) == pytest.approx(find_draught(MASS), abs=1e-4)
        assert not log


@pytest.mark.parametrize("added_mass", [0.0, 100.0])
async def test_heave_has_period_of_mass_and_waterplane(added_mass):
    draught = find_draught(MASS)
    waterplane = 2 * HULL_LENGTH * 2 * sqrt(2 * HULL_RADIUS * draught - draught**2)
    period = 2 * pi * sqrt((MASS + added_mass) / (DENSITY * 9.81 * waterplane))
    parts = two_hulls(), drag_plugin(f"<zDotW>{added_mass}</zDotW>")
    async with running_server(boat(f"0 0 {0.01 - draught} 0 0 0", *parts), step=0.001) as (server, _, __):
        heights = []
        for _ in range(400):
            server.advance(SECOND_NS // 100)
            heights.append(height(server) + draught)
    rising = [index for index in range(1, len(heights)) if heights[index - 1] < 0.0 <= heights[index]]
    assert len(rising) >= 3
    assert np.diff(rising).mean() / 100 == pytest.approx(period, rel=0.01)


async def test_boat_follows_long_waves():
    """A wave of 20 s is much longer than the boat and slower than its heave."""
    parts = two_hulls(long_waves(0.5, 20.0)), drag_plugin(DAMPING)
    field = WaveField(WaveParameters(model=CONSTANT_RATIO, number=1, amplitude=0.5, period=20.0, tau=0.0))
    async with running_server(boat("0 0 0.3 0 0 0", *parts)) as (server, _, log):
        server.advance(10 * SECOND_NS)
        draught = find_draught(MASS)
        for _ in range(20):
            server.advance(SECOND_NS)
            x, y, *_ = server.simulation.link_pose(LINK)
            (wave_height,) = field.heights(np.array([[x, y]]), server.simulation.seconds)
            assert height(server) == pytest.approx(wave_height - draught, abs=0.05)
        assert not log


async def test_off_center_mass_trims_boat_but_not_as_in_vrx():
    """The center of mass is 0.1 m before the middle of the hulls."""
    body = boat("0 0 0 0 0 0", two_hulls(), drag_plugin(DAMPING)).replace("<mass>", "<pose>0.1 0 0 0 0 0</pose><mass>")
    pitches = []
    for mistakes in (False, True):
        options = ServerOptions(gazebo_mistakes=mistakes)
        async with running_server(body, options=options) as (server, _, __):
            server.advance(20 * SECOND_NS)
            rotation = server.simulation.data.xmat[server.simulation.body(LINK)].reshape(3, 3)
            pitches.append(-rotation[2, 0])
    assert pitches[0] > 0.005
    assert pitches[1] == pytest.approx(0.0, abs=1e-3)


async def test_boat_reaches_speed_at_which_drag_equals_thrust():
    """100 N = 20 v + 40 v2."""
    parts = two_hulls(), drag_plugin(DAMPING + "<xU>20</xU><xUU>40</xUU>"), PROPELLER
    async with running_server(boat("0 0 0 0 0 0", *parts)) as (server, graph, log):
        node = graph.create_node("helm")
        publisher = node.create_publisher("std_msgs/msg/Float64", "/model/boat/joint/shaft/cmd_thrust", 10)
        publisher.publish(get_message("std_msgs/msg/Float64")(data=100.0))
        await graph.settle()
        server.advance(40 * SECOND_NS)
        assert speed(server) == pytest.approx((-20 + sqrt(20**2 + 4 * 40 * 100)) / 80, rel=0.01)
        assert not log


async def test_default_derivatives_are_those_of_the_plugin():
    """The boat coasts: m + 5 kg against 20 N s/m."""
    plugin = '<plugin name="h" filename="libSimpleHydrodynamics.so"><link_name>hull</link_name></plugin>'
    async with running_server(boat("0 0 0 0 0 0", plugin), gravity="0 0 0", step=0.001) as (server, _, __):
        server.simulation.set_model_velocity("boat", (1.0, 0.0, 0.0), (0.0, 0.0, 0.0))
        server.advance(SECOND_NS)
        start = speed(server)
        server.advance(5 * SECOND_NS)
        assert speed(server) / start == pytest.approx(np.exp(-20 / (MASS + 5) * 5), rel=0.001)


async def test_parameters_of_waves_from_topic_raise_waves_and_reset_calms_them():
    parts = two_hulls(wavefield()), drag_plugin(DAMPING)
    publisher = (
        '<plugin name="vrx::PublisherPlugin" filename="libPublisherPlugin.so"><message type="gz.msgs.Param" '
        f'topic="{WAVES}" at="5">params {{ key: "period" value {{ type: DOUBLE double_value: 8 }} }} '
        'params { key: "gain" value { type: DOUBLE double_value: 0.5 } } '
        'params { key: "size" value { type: VECTOR3D vector3d_value { x: 1 } } }</message></plugin>'
    )
    async with running_server(publisher, boat("0 0 0 0 0 0", *parts)) as (server, graph, log):
        for phase in range(2):
            server.advance(4 * SECOND_NS)
            await graph.settle()
            assert height(server) == pytest.approx(-find_draught(MASS), abs=0.02)
            server.advance(2 * SECOND_NS)
            await graph.settle()
            heights = []
            for _ in range(60):
                server.advance(SECOND_NS // 4)
                heights.append(height(server))
            assert max(heights) - min(heights) > 0.3, phase
            server.reset()
        assert not log


@pytest.mark.parametrize(
    ("name", "value", "text"),
    [("period", 0.0, "<period> of waves must be greater than 0"), ("model", "JONSWAP", "'JONSWAP', not PMS or CWR")],
)
async def test_invalid_parameters_from_topic_leave_waves(name, value, text):
    parts = two_hulls(wavefield()), drag_plugin(DAMPING)
    async with running_server(boat("0 0 0 0 0 0", *parts)) as (server, graph, log):
        value_class = get_message("rcl_interfaces/msg/ParameterValue")
        number = value_class(type=4, string_value=value) if name == "model" else value_class(type=3, double_value=value)
        message = get_message(PARAMETERS)(params=[get_message("rcl_interfaces/msg/Parameter")(name=name, value=number)])
        graph.create_node("sea").create_publisher(PARAMETERS, WAVES, 10).publish(message)
        await graph.settle()
        server.advance(10 * SECOND_NS)
        assert height(server) == pytest.approx(-find_draught(MASS), abs=0.01)
        assert any(text in record.text and "the waves stay as they are" in record.text for record in log)


@pytest.mark.parametrize(
    ("plugin", "text"),
    [
        (hull_plugin(0.6).replace("0.8 0.6 0", "ahead"), "<point> needs three numbers"),
        (hull_plugin(0.6).replace(f"<hull_radius>{HULL_RADIUS}", "<hull_radius>0"), "<hull_radius> greater than 0"),
        (hull_plugin(0.6).replace("points>", "dots>"), "the hull needs a <point> in <points>"),
        (hull_plugin(0.6, wavefield("<wave><number>0</number></wave>")), "<number>, <scale> and <period> of waves"),
        (hull_plugin(0.6, wavefield("<wave><model>X</model></wave>")), "the model of the waves is 'X'"),
    ],
)
async def test_invalid_hulls_are_reported(plugin, text):
    async with running_server(boat("0 0 0 0 0 0", plugin)) as (_, __, log):
        assert any(text in record.text for record in log), [record.text for record in log]
