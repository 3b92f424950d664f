"""Receivers of acoustic pingers: range, bearing and elevation against geometry."""

from __future__ import annotations

from math import atan2, hypot, pi

import numpy as np
import pytest

from linkwright.messages import get_message
from linkwright.testing import Recording
from tests.simulation.fluids.server import weightless_server
from tests.simulation.test_plugins import SECOND_NS

TOPIC = "/wamv/pingers/range_bearing"


def boat(parameters: str = "") -> str:
    return (
        '<model name="boat"><pose>1 2 0 0 0 1.5707963</pose><link name="hull"><inertial><mass>100</mass></inertial>'
        f'</link><plugin name="vrx::AcousticPingerPlugin" filename="libAcousticPingerPlugin.so"><topic>{TOPIC}</topic>'
        f"<frame_id>boat/pinger</frame_id><position>1 12 -5</position>{parameters}</plugin></model>"
    )


async def measure(seconds: int, parameters: str = "", position: tuple[float, float, float] | None = None) -> list:
    async with weightless_server(boat(parameters)) as (server, graph, log):
        recording = Recording(graph, server.node, TOPIC)
        if position is not None:
            x, y, z = position
            publisher = graph.create_node("buoy").create_publisher("geometry_msgs/msg/Vector3", "/move", 10)
            publisher.publish(get_message("geometry_msgs/msg/Vector3")(x=x, y=y, z=z))
            await graph.settle()
        server.advance(seconds * SECOND_NS)
        await graph.settle()
        assert not log, [record.text for record in log]
        assert all(message.header.frame_id == "boat/pinger" for message in recording)
        return [{item.name: item.value.double_value for item in message.params} for message in recording]


async def test_pinger_is_measured_in_axes_of_the_boat_once_a_second():
    values = await measure(5)
    assert len(values) == 5
    assert values[0] == pytest.approx(
        {"range": hypot(10.0, 5.0), "bearing": 0.0, "elevation": atan2(-5.0, 10.0)}, abs=1e-6
    )


async def test_pinger_moves_to_the_position_on_its_topic():
    values = await measure(1, "<set_position_topic>/move</set_position_topic>", (11.0, 2.0, 0.0))
    assert values[-1] == pytest.approx({"range": 10.0, "bearing": -pi / 2, "elevation": 0.0}, abs=1e-6)


async def test_noise_has_its_deviation():
    noise = "<range_noise><noise type='gaussian'><mean>0.5</mean><stddev>2</stddev></noise></range_noise>"
    values = await measure(20, f"<update_rate>50</update_rate>{noise}")
    ranges = np.array([value["range"] for value in values])
    assert len(ranges) == 1000
    assert ranges.mean() == pytest.approx(hypot(10.0, 5.0) + 0.5, abs=0.3)
    assert ranges.std() == pytest.approx(2.0, rel=0.1)
