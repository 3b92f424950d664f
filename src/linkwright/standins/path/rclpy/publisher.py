"""Stands in for ``rclpy.publisher``."""

from linkwright.graph.publisher import Publisher

__all__ = ["Publisher"]
