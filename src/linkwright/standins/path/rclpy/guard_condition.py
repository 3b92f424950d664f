"""Stands in for ``rclpy.guard_condition``."""

from linkwright.graph.timer import GuardCondition

__all__ = ["GuardCondition"]
