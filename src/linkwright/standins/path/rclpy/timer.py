"""Stands in for ``rclpy.timer``."""

from linkwright.graph.rate import Rate
from linkwright.graph.timer import Timer, TimerInfo
from linkwright.standins.rclpy_api.imported_names import imported_there as __getattr__

__all__ = ["Rate", "Timer", "TimerInfo"]
