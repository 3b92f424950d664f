"""twist_stamper and twist_unstamper: velocities with and without a stamp."""

from __future__ import annotations

from typing import Any

from linkwright.control.nodes.teleop.twist_stamper import TwistStamper, TwistUnstamper
from linkwright.messages import get_message
from linkwright.nodes import NodeOptions
from tests.remote_publishers import RemotePublisher, RemoteTransport

TWIST = get_message("geometry_msgs/msg/Twist")
TWIST_STAMPED = get_message("geometry_msgs/msg/TwistStamped")


async def convert(harness: Any, node: type, parameters: dict[str, Any], message: Any, output: type) -> Any:
    """Return what a node publishes for a message."""
    node(harness.graph, NodeOptions(parameters=parameters))
    received: list[Any] = []
    harness.node.create_subscription(output, "/cmd_vel_out", received.append, 10)
    harness.node.create_publisher(type(message), "/cmd_vel_in", 10).publish(message)
    await harness.graph.settle()
    (result,) = received
    return result


async def test_stamper_adds_time_and_frame(harness):
    await harness.clock.advance(5.0)
    message = TWIST()
    message.linear.x = 0.5
    result = await convert(harness, TwistStamper, {"frame_id": "base_link"}, message, TWIST_STAMPED)
    assert (result.twist.linear.x, result.header.frame_id) == (0.5, "base_link")
    assert result.header.stamp.sec >= 5


async def test_unstamper_removes_header(harness):
    message = TWIST_STAMPED()
    message.twist.angular.z = -0.5
    result = await convert(harness, TwistUnstamper, {}, message, TWIST)
    assert result.angular.z == -0.5


async def test_lost_publisher_stops_robot(harness):
    TwistStamper(harness.graph, NodeOptions())
    received: list[Any] = []
    harness.node.create_subscription(TWIST_STAMPED, "/cmd_vel_out", received.append, 10)
    publisher = RemotePublisher(RemoteTransport(harness.graph), "/cmd_vel_in", "driver")
    message = TWIST()
    message.linear.x = 0.5
    publisher.send(message)
    await harness.graph.settle()
    publisher.disappear()
    await harness.graph.settle()
    assert [stamped.twist.linear.x for stamped in received] == [0.5, 0.0]
