"""nav2's costmap_filter_info_server, which states the mask of a costmap filter and the meaning of its values.

Source: nav2_map_server ``CostmapFilterInfoServer``.
"""

from __future__ import annotations

from typing import Any

from linkwright.graph import LATCHED_QOS
from linkwright.messages import get_message
from linkwright.navigation.nodes.managed import ManagedNode, ManagedServer


class CostmapFilterInfoNode(ManagedNode):
    """The managed node of costmap_filter_info_server."""

    def declare(self) -> None:
        """Declare nav2's parameters."""
        self.declare_parameter("filter_info_topic", "costmap_filter_info")
        self.declare_parameter("type", 0)
        self.declare_parameter("mask_topic", "filter_mask")
        self.declare_parameter("base", 0.0)
        self.declare_parameter("multiplier", 1.0)

    def configure(self) -> None:
        """Create the topic, and the message from the parameters."""
        info_class: Any = get_message("nav2_msgs/msg/CostmapFilterInfo")
        topic = self.get_parameter("filter_info_topic").value
        self._publisher = self.register(self.create_publisher(info_class, topic, LATCHED_QOS))
        self._message = info_class(
            type=self.get_parameter("type").value,
            filter_mask_topic=self.get_parameter("mask_topic").value,
            base=self.get_parameter("base").value,
            multiplier=self.get_parameter("multiplier").value,
        )
        self._message.header.stamp = self.get_clock().now().to_msg()

    def activate(self) -> None:
        """Publish the message."""
        self._publisher.publish(self._message)


class CostmapFilterInfoServer(ManagedServer):
    """The running costmap_filter_info_server node."""

    NODE = CostmapFilterInfoNode
    DEFAULT_NAME = "costmap_filter_info_server"
