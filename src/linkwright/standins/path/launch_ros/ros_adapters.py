"""Stands in for ``launch_ros.ros_adapters``."""

from linkwright.standins.launch_names import imported_there as __getattr__
from linkwright.standins.ros_adapter import ROSAdapter, get_ros_adapter, get_ros_node

__all__ = ["ROSAdapter", "get_ros_adapter", "get_ros_node"]
