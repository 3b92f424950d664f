"""Stands in for ``rclpy.guard_condition``."""

from linkwright.graph.timer import GuardCondition
from linkwright.standins.rclpy_api.imported_names import imported_there as __getattr__

__all__ = ["GuardCondition"]
