"""Stands in for ``rclpy.topic_or_service_is_hidden``."""

from linkwright.standins.rclpy_api.naming import topic_or_service_is_hidden

__all__ = ["topic_or_service_is_hidden"]
