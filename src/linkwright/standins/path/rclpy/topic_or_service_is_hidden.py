"""Stands in for ``rclpy.topic_or_service_is_hidden``."""

from linkwright.standins.rclpy_api.naming import HIDDEN_TOPIC_PREFIX, topic_or_service_is_hidden

__all__ = ["HIDDEN_TOPIC_PREFIX", "topic_or_service_is_hidden"]
