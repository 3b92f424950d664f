"""Stands in for ``rclpy.topic_endpoint_info``."""

from linkwright.graph.introspection import TopicEndpointInfo, TopicEndpointTypeEnum

__all__ = ["TopicEndpointInfo", "TopicEndpointTypeEnum"]
