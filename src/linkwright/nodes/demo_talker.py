"""talker: publishes a greeting with a counter once a second.

The packages demo_nodes_cpp, demo_nodes_py and composition have this node.
"""

from __future__ import annotations

from linkwright.graph import Graph, QoSProfile
from linkwright.messages import String
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors

_PERIOD_S = 1.0
_QUEUE_DEPTH = 7


class Talker(SingleNode):
    """The running talker node."""

    DEFAULT_NAME = "talker"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        self._count = 0
        with handle_start_errors(self._node):
            self._publisher = self._node.create_publisher(String, "chatter", QoSProfile.of(_QUEUE_DEPTH))
            self._node.create_timer(_PERIOD_S, self._talk)

    def _talk(self) -> None:
        self._count += 1
        text = f"Hello World: {self._count}"
        self._node.get_logger().info(f"Publishing: '{text}'")
        self._publisher.publish(String(data=text))
