"""Stands in for ``rclpy.context``."""

from linkwright.standins.rclpy_api.context import Context
from linkwright.standins.rclpy_api.imported_names import imported_there as __getattr__

__all__ = ["Context"]
