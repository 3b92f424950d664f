"""Stands in for ``rclpy.validate_topic_name``."""

from linkwright.standins.rclpy_api.naming import TOPIC_SEPARATOR_STRING, validate_topic_name

__all__ = ["TOPIC_SEPARATOR_STRING", "validate_topic_name"]
