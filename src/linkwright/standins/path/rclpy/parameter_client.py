"""Stands in for ``rclpy.parameter_client``."""

from linkwright.graph.parameter_client import AsyncParameterClient

__all__ = ["AsyncParameterClient"]
