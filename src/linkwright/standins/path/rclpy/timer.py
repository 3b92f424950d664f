"""Stands in for ``rclpy.timer``."""

from linkwright.graph.rate import Rate
from linkwright.graph.timer import Timer, TimerInfo

__all__ = ["Rate", "Timer", "TimerInfo"]
