"""Topics of gz that a bridge offers in ROS under the same name, with another type."""

from __future__ import annotations

import pytest

from linkwright.messages import get_message
from linkwright.nodes import NodeOptions
from linkwright.simulation.nodes.bridge import ParameterBridge
from tests.simulation.test_diff_drive import gz_plugin
from tests.simulation.test_lost_commanders import advance, logged_warnings, robot_speed
from tests.simulation.test_plugins import robot, running_server
from tests.simulation.worlds import GROUND, model

STAMPED = "geometry_msgs/msg/TwistStamped"
BRIDGED = f"cmd_vel@{STAMPED}]gz.msgs.Twist"


@pytest.mark.parametrize("first", ["bridge", "robot"])
async def test_bridged_drive_accepts_stamped_velocities_on_single_type(first: str) -> None:
    async with running_server(GROUND) as (server, graph, log):
        bridge = ParameterBridge(graph, NodeOptions(arguments=[BRIDGED])) if first == "bridge" else None
        server.spawn(model(robot(gz_plugin())), "mbot")
        await advance(server, graph, 0.1)
        if bridge is None:
            assert graph.topics()["/cmd_vel"] == ["geometry_msgs/msg/Twist"]
            bridge = ParameterBridge(graph, NodeOptions(arguments=[BRIDGED]))
        await advance(server, graph, 0.1)
        assert graph.topics()["/cmd_vel"] == [STAMPED]
        command = get_message(STAMPED)()
        command.twist.linear.x = 0.3
        driver = graph.create_node("driver").create_publisher(get_message(STAMPED), "/cmd_vel", 10)
        driver.publish(command)
        await advance(server, graph, 1.5)
        assert robot_speed(server) == pytest.approx(0.3, abs=0.02)
        assert logged_warnings(log) == []
        bridge.close()
