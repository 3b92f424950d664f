"""Sensors of air speed: the dynamic pressure against its formula."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.simulation.server.server import ServerOptions
from linkwright.testing import Recording
from tests.simulation.test_plugins import SECOND_NS, running_server
from tests.simulation.worlds import box

TOPIC = "/world/test/model/plane/link/link/sensor/pitot/air_speed"
PX4_TOPIC = "/world/test/model/plane/link/airspeed_link/sensor/air_speed/air_speed"
NOISE = '<air_speed><pressure><noise type="gaussian"><stddev>2</stddev></noise></pressure></air_speed>'
WIND = "<wind><linear_velocity>-3 0 0</linear_velocity></wind>"
SPEED = 20.0


def density(altitude: float) -> float:
    return 1.225 * ((288.15 - 0.0065 * altitude) / 288.15) ** 4.256


def plane(content: str = "", plugin: str = "") -> str:
    sensor = f'<sensor name="pitot" type="air_speed"><update_rate>50</update_rate>{content}</sensor>'
    text = box("plane", "0 0 200 0 0 0").replace("</link>", f"{sensor}</link>")
    return text.replace("</model>", f"{plugin}</model>")


async def record(*parts: str, speed: float = SPEED, topic: str = TOPIC, mistakes: bool = False) -> list:
    async with running_server(*parts, options=ServerOptions(gazebo_mistakes=mistakes), gravity="0 0 0") as (
        server,
        graph,
        log,
    ):
        recording = Recording(graph, graph.create_node("listener"), topic)
        await graph.settle()
        server.simulation.set_model_velocity("plane", (speed, 0.0, 0.0), (0.0, 0.0, 0.0))
        server.advance(2 * SECOND_NS)
        await graph.settle()
        assert not log
        return list(recording)


@pytest.mark.parametrize("speed", [SPEED, -SPEED])
async def test_pressure_follows_squared_speed_and_density(speed):
    messages = await record(plane(), speed=speed)
    assert len(messages) == 100
    assert messages[-1].fluid_pressure == pytest.approx(0.5 * density(200.0) * speed * abs(speed), rel=1e-6)
    assert messages[-1].header.frame_id == "plane/link/pitot"


@pytest.mark.parametrize(("mistakes", "speed", "deviation"), [(False, SPEED + 3.0, 2.0), (True, SPEED, 200.0)])
async def test_wind_blows_and_noise_is_in_pascals_unless_mistakes_of_gz_are_wanted(mistakes, speed, deviation):
    pressures = [message.fluid_pressure for message in await record(WIND, plane(NOISE), mistakes=mistakes)]
    assert np.std(pressures) == pytest.approx(deviation, rel=0.25)
    assert np.mean(pressures) == pytest.approx(0.5 * density(200.0) * speed**2, abs=deviation)


async def test_plugin_of_px4_measures_at_the_elevation_of_zurich():
    plugin = '<plugin name="a" filename="libAirSpeedPlugin.so"><link_name>link</link_name></plugin>'
    pressures = [message.fluid_pressure for message in await record(WIND, plane("", plugin), topic=PX4_TOPIC)]
    assert np.mean(pressures) == pytest.approx(0.5 * density(688.0) * 23.0**2, abs=0.2)
    assert np.std(pressures) == pytest.approx(1.0, rel=0.1)
