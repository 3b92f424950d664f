"""Stands in for ``rclpy.validate_namespace``."""

from linkwright.standins.rclpy_api.naming import validate_namespace

__all__ = ["validate_namespace"]
