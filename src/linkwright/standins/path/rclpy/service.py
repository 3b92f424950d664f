"""Stands in for ``rclpy.service``."""

from linkwright.graph.service import Service
from linkwright.standins.rclpy_api.imported_names import imported_there as __getattr__
from linkwright.standins.rclpy_api.type_support import SrvType, SrvTypeRequest, SrvTypeResponse

__all__ = ["Service", "SrvType", "SrvTypeRequest", "SrvTypeResponse"]
