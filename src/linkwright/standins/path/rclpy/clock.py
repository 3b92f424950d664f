"""Stands in for ``rclpy.clock``."""

from linkwright.graph.clock import Clock, ClockChange, ClockType, JumpHandle, JumpThreshold, ROSClock, TimeJump
from linkwright.graph.faults import InterruptedWaitError as ROSInterruptException

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
