"""Stands in for ``rclpy._rclpy_pybind11``, as far as its exceptions go, which users' code catches."""

from linkwright.graph.faults import InvalidHandleError as InvalidHandle
from linkwright.standins.rclpy_api.errors import (
    NodeNameNonExistentError,
    RCLError,
    RCLInvalidROSArgsError,
    TimerCancelledError,
    UnknownROSArgsError,
    UnsupportedEventTypeError,
)

__all__ = [
    "InvalidHandle",
    "NodeNameNonExistentError",
    "RCLError",
    "RCLInvalidROSArgsError",
    "TimerCancelledError",
    "UnknownROSArgsError",
    "UnsupportedEventTypeError",
]
