"""ur_robot_driver's program wait_for_robot_description, which ends when a robot description is published.

The launch file of ur_moveit_config starts move_group when this program ends, in simulations too.

Source: ur_robot_driver (topic, QoS, log messages).
"""

from __future__ import annotations

import asyncio
from typing import Any

from linkwright.graph import DESCRIPTION_QOS, Graph, Subscription
from linkwright.nodes.options import NodeOptions, SingleNode, create_node

_TOPIC = "robot_description"


class WaitForRobotDescription(SingleNode):
    """The running program, which ends with status 0 at the first message on ``robot_description``."""

    DEFAULT_NAME = "wait_for_robot_description"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        self.finished: asyncio.Future[int] = asyncio.get_running_loop().create_future()
        self._subscription: Subscription[Any] = self._node.create_subscription(
            "std_msgs/msg/String", _TOPIC, self._finish, DESCRIPTION_QOS
        )
        self._node.get_logger().info(f"Waiting for message on {self._subscription.topic_name}.")

    def _finish(self, _message: Any) -> None:
        if not self.finished.done():
            self._node.get_logger().info(f"Received message on {self._subscription.topic_name}. Shutting down.")
            self.finished.set_result(0)
