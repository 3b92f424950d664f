"""Stands in for ``rclpy.duration``."""

from linkwright.graph.time import INFINITE as Infinite
from linkwright.graph.time import Duration

__all__ = ["Duration", "Infinite"]
