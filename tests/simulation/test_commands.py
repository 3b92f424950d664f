"""Commands with NaN: the plugin stops, the log says why, and the simulation continues."""

from __future__ import annotations

from math import inf, nan

import pytest

from linkwright.messages import get_message
from tests.simulation.test_lost_commanders import DRIVES, advance, forward_twist, logged_warnings, robot_speed
from tests.simulation.test_plugins import running_server
from tests.simulation.worlds import GROUND


@pytest.mark.parametrize("invalid_value", [nan, inf], ids=str)
@pytest.mark.parametrize("model", DRIVES.values(), ids=DRIVES.keys())
async def test_drive_stops_at_nan_command_and_follows_next(model: str, invalid_value: float) -> None:
    async with running_server(GROUND, model) as (server, graph, log):
        driver = graph.create_node("driver").create_publisher(get_message("geometry_msgs/msg/Twist"), "/cmd_vel", 10)
        driver.publish(forward_twist(0.3))
        await advance(server, graph, 1.5)
        assert robot_speed(server) == pytest.approx(0.3, abs=0.02)
        driver.publish(forward_twist(invalid_value))
        await advance(server, graph, 1.5)
        assert robot_speed(server) == pytest.approx(0.0, abs=0.01)
        assert logged_warnings(log) == ["a command on 'cmd_vel' contains NaN or an infinite number: the motion stops"]
        driver.publish(forward_twist(0.3))
        await advance(server, graph, 1.5)
        assert robot_speed(server) == pytest.approx(0.3, abs=0.02)
