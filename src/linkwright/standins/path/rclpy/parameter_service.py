"""Stands in for ``rclpy.parameter_service``."""

from linkwright.standins.rclpy_api.imported_names import imported_there as __getattr__
from linkwright.standins.rclpy_api.parameters import ParameterService

__all__ = ["ParameterService"]
