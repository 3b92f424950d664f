"""Stands in for ``rclpy.time``."""

from linkwright.graph.time import Time

CONVERSION_CONSTANT = 10**9

__all__ = ["CONVERSION_CONSTANT", "Time"]
