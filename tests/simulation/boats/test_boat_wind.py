"""Wind drifts boats, turns them, and varies."""

from __future__ import annotations

from math import sqrt

import numpy as np
import pytest

from linkwright.simulation.server.server import ServerOptions
from linkwright.testing import Recording
from tests.simulation.boats.boat import LINK, boat, drag_plugin
from tests.simulation.fluids.server import weightless_server
from tests.simulation.test_plugins import SECOND_NS
from tests.simulation.worlds import model

RESISTANCE = "<xU>20</xU><yV>200</yV><nR>400</nR>"


def wind_plugin(parameters: str, coefficients: str = "0.5 0.5 0.33") -> str:
    return (
        '<plugin name="vrx::USVWind" filename="libUSVWind.so"><wind_obj><name>boat</name><link_name>hull</link_name>'
        f"<coeff_vector>{coefficients}</coeff_vector></wind_obj>{parameters}</plugin>"
    )


def steady_wind(direction: float, speed: float, coefficients: str = "0.5 0.5 0.33") -> str:
    parameters = f"<wind_direction>{direction}</wind_direction><wind_mean_velocity>{speed}</wind_mean_velocity>"
    return wind_plugin(parameters, coefficients)


async def test_boat_drifts_at_speed_at_which_drag_equals_wind():
    """0.5 (10 - v)2 = 20 v."""
    parts = steady_wind(0.0, 10.0), boat("0 0 0 0 0 0", drag_plugin(RESISTANCE))
    async with weightless_server(*parts) as (server, _, log):
        server.advance(60 * SECOND_NS)
        linear, _ = server.simulation.link_velocity(LINK)
        assert linear[0] == pytest.approx(30 - sqrt(30**2 - 10**2), rel=0.001)
        assert not log


async def test_force_and_torque_follow_heading_but_not_in_vrx():
    """Wind from the side pushes sideways; wind at 45 degrees turns the boat across it."""
    for heading, direction in ((0.0, 90.0), (1.5707963267948966, 135.0)):
        for mistakes in (False, True):
            parts = steady_wind(direction, 4.0, "1 2 3"), boat(f"0 0 0 0 0 {heading}")
            async with weightless_server(*parts, options=ServerOptions(gazebo_mistakes=mistakes)) as (server, _, __):
                server.advance(SECOND_NS // 100)
                wrench = server.simulation.data.xfrc_applied[server.simulation.body(LINK)]
                angle = np.radians(direction) - (0.0 if mistakes else heading)
                x, y = 4.0 * np.cos(angle), 4.0 * np.sin(angle)
                force = np.array((x * abs(x), 2 * y * abs(y)))
                cosine, sine = (1.0, 0.0) if mistakes else (np.cos(heading), np.sin(heading))
                rotated = np.array((cosine * force[0] - sine * force[1], sine * force[0] + cosine * force[1]))
                assert wrench[:2] == pytest.approx(rotated, abs=0.2)
                assert wrench[5] == pytest.approx(-2 * 3 * x * y, abs=0.2)


async def test_variation_has_standard_deviation_and_time_constant():
    parameters = (
        "<wind_direction>30</wind_direction><wind_mean_velocity>7</wind_mean_velocity><random_seed>10</random_seed>"
        "<var_wind_gain_constants>2</var_wind_gain_constants><var_wind_time_constants>2</var_wind_time_constants>"
        "<topic_wind_speed>/air/speed</topic_wind_speed><topic_wind_direction>/air/direction</topic_wind_direction>"
    )
    async with weightless_server(wind_plugin(parameters)) as (server, graph, log):
        speeds = Recording(graph, server.node, "/air/speed")
        directions = Recording(graph, server.node, "/air/direction")
        await graph.settle()
        for _ in range(100):
            server.advance(20 * SECOND_NS)
            await graph.settle()
        values = np.array([message.data for message in speeds])
        assert len(values) == 20_000
        assert values.mean() == pytest.approx(7.0, abs=0.3)
        assert values.std() == pytest.approx(2.0, rel=0.1)
        deviations = values - values.mean()
        assert (deviations[20:] * deviations[:-20]).mean() / values.var() == pytest.approx(np.exp(-1), abs=0.07)
        assert directions.last.data == pytest.approx(30.0)
        assert not log


async def test_wind_without_direction_is_calm_and_finds_boat_that_is_added_later():
    for parameters, moves in (("<wind_mean_velocity>9</wind_mean_velocity>", False), ("", True)):
        plugin = wind_plugin(parameters) if parameters else steady_wind(0.0, 9.0)
        async with weightless_server(plugin) as (server, _, log):
            server.advance(SECOND_NS)
            server.simulation.spawn(model(boat("0 0 0 0 0 0")), "boat")
            server.advance(SECOND_NS)
            linear, _ = server.simulation.link_velocity(LINK)
            assert bool(linear[0] > 0.1) is moves
            assert not log


@pytest.mark.parametrize(
    ("plugin", "text"),
    [
        (wind_plugin("", "much"), "<wind_obj> needs three numbers in <coeff_vector>"),
        (wind_plugin("<var_wind_time_constants>0</var_wind_time_constants>"), "must be greater than 0"),
    ],
)
async def test_invalid_parameters_are_reported(plugin, text):
    async with weightless_server(plugin) as (_, __, log):
        assert any(text in record.text for record in log)
