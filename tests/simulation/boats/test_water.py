"""The surface of the water that the simulator publishes, and that the page draws."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from linkwright.rviz.water import convert_water
from linkwright.simulation.plugins.boats.waves import CONSTANT_RATIO, WaveField, WaveParameters
from linkwright.simulation.plugins.water import WaterSurface, create_water_message
from linkwright.simulation.server.server import ServerOptions
from tests.simulation.boats.boat import boat, hull_plugin, two_hulls
from tests.simulation.fluids.server import running_server
from tests.simulation.test_server import LATCHED, simulator
from tests.waiting import eventually

LEVEL = 0.3
PAGE_SURFACES = Path(__file__).parents[3] / "frontend" / "test" / "water-surfaces.json"
"""Points of the surface, with which the page's tests compare what the page draws."""
FIELDS = (
    WaveParameters(period=4.0, direction=0.7, steepness=0.8, gain=0.9),
    WaveParameters(tau=0.0, period=3.0),
    WaveParameters(model=CONSTANT_RATIO, number=4, amplitude=0.3, scale=1.4, angle=0.6, steepness=0.5, direction=-1.0),
)
WAVE = "<wavefield><wave><period>4</period><steepness>0.5</steepness><tau>3</tau></wave></wavefield>"


def describe_surface(field: WaveField, seconds: float) -> dict:
    """Return the water of the page, and points that rest at some places with their height and slope."""
    water = WaterSurface(LEVEL, field.parameters.tau, field.wave_rows())
    scene = convert_water(create_water_message(water))
    growth = 1.0 - np.exp(-seconds / field.parameters.tau) if field.parameters.tau > 0.0 else 1.0
    rest_points = np.random.default_rng(1).uniform(-40.0, 40.0, (4, 2))
    phases = (rest_points @ field.directions.T) * field.wavenumbers - field.frequencies * seconds
    points = rest_points - growth * (np.sin(phases) * field.steepnesses * field.amplitudes) @ field.directions
    offsets = np.array(((1e-4, 0.0), (0.0, 1e-4)))
    slopes = [(field.heights(points + o, seconds) - field.heights(points - o, seconds)) / 2e-4 for o in offsets]
    surface = np.column_stack([points, LEVEL + field.heights(points, seconds), *slopes])
    return {
        "water": {
            "kind": "world_water",
            "level": scene.level,
            "growth_time": scene.growth_time,
            "waves": np.round(scene.waves, 9).tolist(),
        },
        "seconds": seconds,
        "rest_points": rest_points.round(6).tolist(),
        "surface": surface.round(5).tolist(),
    }


def describe_surfaces() -> list[dict]:
    return [describe_surface(WaveField(field), seconds) for field in FIELDS for seconds in (0.5, 12.3)]


def test_page_is_compared_with_surface_of_physics():
    """To write the file again, run this module as a program."""
    expected = describe_surfaces()
    stored = json.loads(PAGE_SURFACES.read_text())
    assert len(stored) == len(expected)
    for entry, expected_entry in zip(stored, expected, strict=True):
        assert entry["seconds"] == expected_entry["seconds"]
        assert entry["water"]["waves"] == pytest.approx(expected_entry["water"]["waves"])
        for name in ("rest_points", "surface"):
            assert np.array(entry[name]) == pytest.approx(np.array(expected_entry[name]), abs=2e-5)


@pytest.mark.parametrize(("mistakes", "steepness"), [(False, 0.5), (True, 0.0)])
async def test_water_has_waves_and_level_of_boat(mistakes, steepness):
    plugins = hull_plugin(0.6, WAVE, LEVEL) + hull_plugin(-0.6, WAVE, LEVEL)
    options = ServerOptions(gazebo_mistakes=mistakes)
    async with running_server(boat("0 0 0 0 0 0", plugins), options=options) as (server, _, __):
        water = server.find_water()
        assert (water.level, water.growth_time) == (LEVEL, 3.0)
        field = WaveField(WaveParameters(period=4.0, steepness=steepness, tau=3.0))
        assert np.array(water.waves) == pytest.approx(np.array(field.wave_rows()))


async def test_water_has_waves_if_some_hulls_have_none():
    async with running_server(boat("0 0 0 0 0 0", hull_plugin(0.6) + hull_plugin(-0.6, WAVE))) as (server, _, __):
        assert len(server.find_water().waves) == 3


async def test_topic_of_water_exists_with_water_and_is_empty_after_it(tmp_path):
    kind = "std_msgs/msg/Float64MultiArray"
    async with simulator(tmp_path) as session:
        session.simulator._reports.publish_water()
        messages = session.record(kind, "/world_water", LATCHED)
        assert not session.node.get_publishers_info_by_topic("/world_water")
    async with simulator(tmp_path, boat("0 0 0 0 0 0", two_hulls(WAVE))) as session:
        messages = session.record(kind, "/world_water", LATCHED)
        session.record("tf2_msgs/msg/TFMessage", "/world_poses")
        await eventually(lambda: len(messages) == 1)
        assert len(convert_water(messages[0]).waves) == 18
        await session.call("gazebo_msgs/srv/DeleteEntity", "/delete_entity", name="boat")
        await eventually(lambda: len(messages) == 2)
        assert convert_water(messages[1]) is None


if __name__ == "__main__":
    PAGE_SURFACES.write_text(json.dumps(describe_surfaces(), indent=1) + "\n")
