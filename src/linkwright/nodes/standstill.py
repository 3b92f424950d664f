"""Stop a robot when the publisher of its forwarded velocities disappears.

See `linkwright.graph.endpoints.command_guard.CommandGuard`.
"""

from __future__ import annotations

from typing import Any

from linkwright.diagnostics import phrase
from linkwright.graph import Node, Publisher
from linkwright.graph.endpoints.base import EndpointInfo
from linkwright.graph.endpoints.command_guard import describe_lost_publisher
from linkwright.nodes.velocity_topic import TWIST, TWIST_STAMPED

VELOCITIES = (TWIST, TWIST_STAMPED)
"""The types of messages that `send_stop` can publish."""


def send_stop(node: Node, publisher: Publisher[Any], lost_publisher: EndpointInfo) -> None:
    """Publish a velocity of zero, and log the reason.

    Args:
        node: the node that forwards velocities.
        publisher: the node's publisher of velocities.
        lost_publisher: the publisher that sent the last forwarded velocity and has disappeared.
    """
    message = publisher.msg_type()
    if publisher.type_name == TWIST_STAMPED:
        message.header.stamp = node.get_clock().now().to_msg()
    publisher.publish(message)
    node.get_logger().warning(
        phrase(
            "{node}: a stop command is sent to '{topic}'",
            node=describe_lost_publisher(lost_publisher),
            topic=publisher.name,
        )
    )
