"""Stands in for ``rclpy.clock_type``."""

from linkwright.graph.time import ClockType

__all__ = ["ClockType"]
