"""Stands in for ``rclpy.duration``."""

from linkwright.graph.time import INFINITE as Infinite
from linkwright.graph.time import Duration
from linkwright.standins.rclpy_api.imported_names import imported_there as __getattr__

__all__ = ["Duration", "Infinite"]
