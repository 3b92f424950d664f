"""A substitute for Gazebo's window: a node that refers the user to the page in the browser."""

from __future__ import annotations

from linkwright.graph import Graph
from linkwright.nodes.options import NodeOptions, SingleNode, create_node


class Window(SingleNode):
    """The node of ``gzclient``, which runs without effect until it is closed.

    Launch files end all other processes when this node ends.
    """

    DEFAULT_NAME = "_gzclient"  # hidden, because gzclient is not a node

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        self._node.get_logger().info(
            "Linkwright does not open a window of Gazebo: the page in the browser shows the world"
        )
