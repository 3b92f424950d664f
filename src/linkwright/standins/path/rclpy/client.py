"""Stands in for ``rclpy.client``."""

from linkwright.graph.client import Client
from linkwright.standins.rclpy_api.imported_names import imported_there as __getattr__
from linkwright.standins.rclpy_api.type_support import SrvType, SrvTypeRequest, SrvTypeResponse

__all__ = ["Client", "SrvType", "SrvTypeRequest", "SrvTypeResponse"]
