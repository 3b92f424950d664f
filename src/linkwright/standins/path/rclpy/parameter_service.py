"""Stands in for ``rclpy.parameter_service``."""

from linkwright.standins.rclpy_api.parameters import ParameterService

__all__ = ["ParameterService"]
