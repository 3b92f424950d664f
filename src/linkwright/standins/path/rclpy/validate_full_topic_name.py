"""Stands in for ``rclpy.validate_full_topic_name``."""

from linkwright.standins.rclpy_api.naming import validate_full_topic_name

__all__ = ["validate_full_topic_name"]
