"""Stands in for ``rclpy.publisher``."""

from linkwright.graph.publisher import Publisher
from linkwright.standins.rclpy_api.imported_names import imported_there as __getattr__
from linkwright.standins.rclpy_api.type_support import MsgType

__all__ = ["MsgType", "Publisher"]
