"""A substitute for Gazebo's window: a node that points the user to the page in the browser."""

from __future__ import annotations

from linkwright.graph import Graph
from linkwright.nodes.options import NodeOptions, SingleNode, create_node


class Window(SingleNode):
    """The node of ``gzclient``, which logs where the world is shown and then stays idle.

    The node keeps running, because launch files end all other processes when it ends.
    """

    DEFAULT_NAME = "_gzclient"  # hidden, because Gazebo's gzclient does not create a node

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        self._node.get_logger().info(
            "Linkwright does not open a window of Gazebo: the page in the browser shows the world"
        )
