"""Stands in for ``rclpy.service``."""

from linkwright.graph.service import Service

__all__ = ["Service"]
