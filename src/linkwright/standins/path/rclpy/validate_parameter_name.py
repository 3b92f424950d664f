"""Stands in for ``rclpy.validate_parameter_name``."""

from linkwright.standins.rclpy_api.naming import validate_parameter_name

__all__ = ["validate_parameter_name"]
