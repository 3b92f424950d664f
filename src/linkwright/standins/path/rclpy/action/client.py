"""Stands in for ``rclpy.action.client``."""

from linkwright.graph.actions.client import ClientGoalHandle
from linkwright.standins.rclpy_api.action import ActionClient

__all__ = ["ActionClient", "ClientGoalHandle"]
