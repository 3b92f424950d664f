"""Stands in for ``rclpy.client``."""

from linkwright.graph.client import Client
from linkwright.standins.rclpy_api.type_support import SrvType, SrvTypeRequest, SrvTypeResponse

__all__ = ["Client", "SrvType", "SrvTypeRequest", "SrvTypeResponse"]
