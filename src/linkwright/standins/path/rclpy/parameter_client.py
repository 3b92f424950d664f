"""Stands in for ``rclpy.parameter_client``."""

from linkwright.graph.parameters.client import AsyncParameterClient
from linkwright.standins.rclpy_api.imported_names import imported_there as __getattr__

__all__ = ["AsyncParameterClient"]
