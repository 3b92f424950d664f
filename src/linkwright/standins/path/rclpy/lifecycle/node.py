"""Stands in for ``rclpy.lifecycle.node``."""

from linkwright.graph.lifecycle.states import LifecycleState, TransitionCallbackReturn
from linkwright.standins.rclpy_api.imported_names import imported_there as __getattr__
from linkwright.standins.rclpy_api.lifecycle import LifecycleNode, LifecycleNodeMixin

__all__ = ["LifecycleNode", "LifecycleNodeMixin", "LifecycleState", "TransitionCallbackReturn"]
