"""Stands in for ``rclpy.topic_endpoint_info``."""

from linkwright.graph.introspection import TopicEndpointInfo, TopicEndpointTypeEnum
from linkwright.standins.rclpy_api.imported_names import imported_there as __getattr__

__all__ = ["TopicEndpointInfo", "TopicEndpointTypeEnum"]
