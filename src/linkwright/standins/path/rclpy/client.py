"""Stands in for ``rclpy.client``."""

from linkwright.graph.client import Client

__all__ = ["Client"]
