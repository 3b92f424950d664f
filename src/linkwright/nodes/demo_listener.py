"""listener: logs the messages of a talker.

The packages demo_nodes_cpp, demo_nodes_py and composition have this node.
"""

from __future__ import annotations

from linkwright.graph import Graph, QoSProfile
from linkwright.messages import String
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors

_QUEUE_DEPTH = 10


class Listener(SingleNode):
    """The running listener node."""

    DEFAULT_NAME = "listener"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        with handle_start_errors(self._node):
            self._node.create_subscription(String, "chatter", self._receive, QoSProfile.of(_QUEUE_DEPTH))

    def _receive(self, message: String) -> None:
        self._node.get_logger().info(f"I heard: [{message.data}]")
