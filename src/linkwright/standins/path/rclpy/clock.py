"""Stands in for ``rclpy.clock``."""

from linkwright.graph.clock import Clock, ClockChange, ClockType, JumpHandle, JumpThreshold, ROSClock, TimeJump
from linkwright.graph.faults import InterruptedWaitError as ROSInterruptException
from linkwright.standins.rclpy_api.imported_names import imported_there as __getattr__

__all__ = [
    "Clock",
    "ClockChange",
    "ClockType",
    "JumpHandle",
    "JumpThreshold",
    "ROSClock",
    "ROSInterruptException",
    "TimeJump",
]
