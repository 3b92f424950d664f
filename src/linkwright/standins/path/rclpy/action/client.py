"""Stands in for ``rclpy.action.client``."""

from linkwright.graph.actions.client import ClientGoalHandle
from linkwright.standins.rclpy_api.action import ActionClient
from linkwright.standins.rclpy_api.imported_names import imported_there as __getattr__

__all__ = ["ActionClient", "ClientGoalHandle"]
