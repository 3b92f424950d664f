"""Stands in for ``rclpy.expand_topic_name``."""

from linkwright.standins.rclpy_api.naming import expand_topic_name

__all__ = ["expand_topic_name"]
