"""Shapes that float on waves, as buoys do."""

from __future__ import annotations

from math import exp, pi, sqrt

import numpy as np
import pytest

from linkwright.simulation.plugins.boats.waves import CONSTANT_RATIO, WaveField, WaveParameters
from linkwright.simulation.server.server import ServerOptions
from tests.simulation.fluids.server import running_server, weightless_server
from tests.simulation.test_plugins import SECOND_NS

BOX = "<box><size>1 1 0.4</size></box>"
LINK = "buoy::link"


def buoyancy(shape: str, pose: str = "") -> str:
    return f"<buoyancy><link_name>link</link_name>{pose}<geometry>{shape}</geometry></buoyancy>"


def buoy(pose: str, parts: str, mass: float = 200.0, inertia: float = 20.0) -> str:
    """Return a body without collisions that floats by parts of the plugin."""
    moments = "".join(f"<{name}>{inertia}</{name}>" for name in ("ixx", "iyy", "izz"))
    plugin = (
        '<plugin name="vrx::PolyhedraBuoyancyDrag" filename="libPolyhedraBuoyancyDrag.so">'
        f"<fluid_density>1000</fluid_density>{parts}</plugin>"
    )
    return (
        f'<model name="buoy"><pose>{pose}</pose><link name="link"><inertial><mass>{mass}</mass>'
        f"<inertia>{moments}</inertia></inertial></link>{plugin}</model>"
    )


def height(server) -> float:
    return float(server.simulation.link_pose(LINK)[2])


DRAG = "<linear_drag>10</linear_drag><angular_drag>10</angular_drag>"


@pytest.mark.parametrize(
    ("shape", "mass", "expected"),
    [
        (BOX, 200.0, 0.2 - 200.0 / 1000.0),
        (BOX, 300.0, 0.2 - 300.0 / 1000.0),
        ("<sphere><radius>0.3</radius></sphere>", 500.0 * 4 / 3 * pi * 0.027, 0.0),
        ("<cylinder><radius>0.5</radius><length>0.4</length></cylinder>", 1000 * pi * 0.25 * 0.1, 0.1),
    ],
)
async def test_draught_follows_mass(shape, mass, expected):
    async with running_server(buoy("0 0 0.1 0 0 0", buoyancy(shape) + DRAG, mass)) as (server, _, log):
        server.advance(20 * SECOND_NS)
        assert height(server) == pytest.approx(expected, abs=0.002)
        assert not log


async def test_heave_has_period_of_mass_and_waterplane():
    async with running_server(buoy("0 0 0.05 0 0 0", buoyancy(BOX))) as (server, _, __):
        heights = []
        for _ in range(400):
            server.advance(SECOND_NS // 100)
            heights.append(height(server))
    rising = [index for index in range(1, len(heights)) if heights[index - 1] < 0.0 <= heights[index]]
    assert np.diff(rising).mean() / 100 == pytest.approx(2 * pi * sqrt(200 / (1000 * 9.81)), rel=0.01)


async def test_drag_slows_body_in_proportion_to_its_wet_part():
    """Half of the box is wet: dv/dt = -0.5 c v, and dw/dt = -0.5 c m L2 / I w, with the mean length L of 0.8 m."""
    parts = buoyancy(BOX) + "<linear_drag>0.8</linear_drag><angular_drag>0.2</angular_drag>"
    async with running_server(buoy("0 0 0 0 0 0", parts), step=0.001) as (server, _, __):
        server.simulation.set_model_velocity("buoy", (1.0, 0.0, 0.0), (0.0, 0.0, 1.0))
        server.advance(2 * SECOND_NS)
        linear, angular = server.simulation.link_velocity(LINK)
        assert np.hypot(*linear[:2]) == pytest.approx(exp(-0.5 * 0.8 * 2), rel=0.01)
        assert angular[2] == pytest.approx(exp(-0.5 * 0.2 * 200 * 0.8**2 / 20 * 2), rel=0.01)


async def test_shapes_of_one_link_add_up_and_keep_it_upright():
    cylinder = "<cylinder><radius>0.2</radius><length>0.8</length></cylinder>"
    parts = "".join(buoyancy(cylinder, f"<pose>0 {y} 0 0 1.5707963267948966 0</pose>") for y in (-1, 1)) + DRAG
    mass = 1000 * pi * 0.04 * 0.8  # half of both cylinders
    async with running_server(buoy("0 0 0.1 0.1 0 0", parts, mass)) as (server, _, __):
        server.advance(20 * SECOND_NS)
        assert height(server) == pytest.approx(0.0, abs=0.002)
        assert server.simulation.data.xmat[server.simulation.body(LINK)][8] > 0.9999


async def test_buoy_follows_waves():
    wave = (
        "<wavefield><wave><model>CWR</model><number>1</number><amplitude>0.5</amplitude><period>12</period>"
        "<steepness>0.5</steepness><tau>0</tau></wave></wavefield>"
    )
    field = WaveField(
        WaveParameters(model=CONSTANT_RATIO, number=1, amplitude=0.5, period=12.0, steepness=0.5, tau=0.0)
    )
    async with running_server(buoy("0 0 0.3 0 0 0", buoyancy(BOX) + DRAG + wave)) as (server, _, log):
        server.advance(5 * SECOND_NS)
        for _ in range(24):
            server.advance(SECOND_NS // 2)
            x, y, *_ = server.simulation.link_pose(LINK)
            (wave_height,) = field.heights(np.array([[x, y]]), server.simulation.seconds)
            assert height(server) == pytest.approx(wave_height, abs=0.05)
        assert not log


async def test_fluid_level_counts_once_but_twice_in_vrx():
    for mistakes, level in ((False, 2.0), (True, 4.0)):
        body = buoy("0 0 3 0 0 0", buoyancy(BOX) + DRAG + "<fluid_level>2</fluid_level>")
        async with running_server(body, options=ServerOptions(gazebo_mistakes=mistakes)) as (server, _, __):
            server.advance(20 * SECOND_NS)
            assert height(server) == pytest.approx(level, abs=0.002)


async def test_body_above_water_is_not_pushed():
    async with weightless_server(buoy("0 0 2 0 0 0", buoyancy(BOX) + DRAG)) as (server, _, __):
        server.simulation.set_model_velocity("buoy", (1.0, 0.0, 0.0), (0.0, 0.0, 0.0))
        server.advance(SECOND_NS)
        assert server.simulation.link_velocity(LINK)[0][0] == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("part", "text"),
    [
        (buoyancy("<mesh><uri>hull.dae</uri></mesh>"), "<buoyancy> needs a box, a cylinder or a sphere"),
        (buoyancy("<sphere><radius>0</radius></sphere>"), "<buoyancy> needs a box, a cylinder or a sphere"),
        ("<buoyancy><link_name>link</link_name></buoyancy>", "<buoyancy> needs a box, a cylinder or a sphere"),
        (buoyancy("<box><size>1 1</size></box>"), "has 2 numbers, but 3 are expected"),
        (buoyancy(BOX, "<pose>here</pose>"), "<pose> is not 6 numbers"),
    ],
)
async def test_invalid_shapes_are_reported(part, text):
    async with running_server(buoy("0 0 0 0 0 0", part)) as (_, __, log):
        assert any(text in record.text for record in log), [record.text for record in log]


async def test_unknown_link_is_reported():
    part = buoyancy(BOX).replace(">link<", ">keel<")
    async with running_server(buoy("0 0 0 0 0 0", part)) as (_, __, log):
        assert any("there is no link 'keel'" in record.text for record in log)
