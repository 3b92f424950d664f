"""Stands in for ``rclpy.serialization``."""

from linkwright.standins.rclpy_api.serialization import deserialize_message, serialize_message

__all__ = ["deserialize_message", "serialize_message"]
