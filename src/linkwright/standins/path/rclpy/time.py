"""Stands in for ``rclpy.time``."""

from linkwright.graph.time import Time
from linkwright.standins.rclpy_api.imported_names import imported_there as __getattr__

CONVERSION_CONSTANT = 10**9

__all__ = ["CONVERSION_CONSTANT", "Time"]
