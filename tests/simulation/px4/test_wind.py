"""Wind of PX4's worlds: mean, variance, gusts and ramps."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.testing import Recording
from tests.simulation.fluids.server import weightless_server
from tests.simulation.test_plugins import SECOND_NS


async def winds(seconds: int, parameters: str) -> np.ndarray:
    plugin = f'<plugin name="wind" filename="libgazebo_wind_plugin.so"><robotNamespace/>{parameters}</plugin>'
    async with weightless_server(plugin) as (server, graph, log):
        recording = Recording(graph, server.node, "/world_wind")
        server.advance(seconds * SECOND_NS)
        await graph.settle()
        assert not log, [record.text for record in log]
        vectors = np.array([(item.vector.x, item.vector.y, item.vector.z) for item in recording])
        assert np.array(server.simulation.wind) == pytest.approx(vectors[-1])
        return vectors


async def test_wind_without_variance_is_its_mean_twice_a_second():
    vectors = await winds(10, "<windVelocityMean>4</windVelocityMean><windDirectionMean>0 2 0</windDirectionMean>")
    assert len(vectors) == 20
    assert vectors == pytest.approx(np.tile((0.0, 4.0, 0.0), (20, 1)))


async def test_variance_and_maximum():
    vectors = await winds(
        100,
        "<publishRate>20</publishRate><windVelocityMean>8</windVelocityMean>"
        "<windVelocityVariance>4</windVelocityVariance><windVelocityMax>12</windVelocityMax>",
    )
    speeds = np.linalg.norm(vectors, axis=1)
    assert speeds.mean() == pytest.approx(8.0, abs=0.2)
    assert speeds.std() == pytest.approx(2.0, abs=0.2)
    assert speeds.max() == 12.0


async def test_gust_and_ramp_add_to_the_wind():
    vectors = await winds(
        8,
        "<windGustStart>2</windGustStart><windGustDuration>1</windGustDuration><windGustVelocityMean>5"
        "</windGustVelocityMean><windRampStart>4</windRampStart><windChangeRampDuration>2</windChangeRampDuration>"
        "<windRampWindVectorComponents>0 0 6</windRampWindVectorComponents>",
    )
    times = 0.5 * (1 + np.arange(len(vectors)))
    assert vectors[:, 1] == pytest.approx(np.where((times >= 2.0) & (times < 3.0), 5.0, 0.0))
    assert vectors[:, 2] == pytest.approx(np.clip((times - 4.0) / 2.0, 0.0, 1.0) * 6.0)
