"""Stands in for ``rclpy.action.server``."""

from linkwright.graph.actions.goal import CancelResponse, GoalEvent, GoalResponse, ServerGoalHandle
from linkwright.graph.actions.server import (
    default_cancel_callback,
    default_goal_callback,
    default_handle_accepted_callback,
)
from linkwright.standins.rclpy_api.action import ActionServer
from linkwright.standins.rclpy_api.imported_names import imported_there as __getattr__

__all__ = [
    "ActionServer",
    "CancelResponse",
    "GoalEvent",
    "GoalResponse",
    "ServerGoalHandle",
    "default_cancel_callback",
    "default_goal_callback",
    "default_handle_accepted_callback",
]
