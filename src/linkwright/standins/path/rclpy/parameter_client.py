"""Stands in for ``rclpy.parameter_client``."""

from linkwright.graph.parameters.client import AsyncParameterClient

__all__ = ["AsyncParameterClient"]
