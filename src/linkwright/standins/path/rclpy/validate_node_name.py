"""Stands in for ``rclpy.validate_node_name``."""

from linkwright.standins.rclpy_api.naming import validate_node_name

__all__ = ["validate_node_name"]
