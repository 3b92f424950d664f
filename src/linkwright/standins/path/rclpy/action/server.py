"""Stands in for ``rclpy.action.server``."""

from linkwright.graph.actions.goal import CancelResponse, GoalEvent, GoalResponse, ServerGoalHandle
from linkwright.graph.actions.server import (
    default_cancel_callback,
    default_goal_callback,
    default_handle_accepted_callback,
)
from linkwright.standins.rclpy_api.action import ActionServer

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
