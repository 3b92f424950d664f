"""The exceptions of rclpy that nothing in `linkwright.graph` raises; names and texts are rclpy's."""

from __future__ import annotations

from linkwright.graph.faults import NodeNotFoundError as NodeNameNonExistentError
from linkwright.graph.faults import RclError as RCLError

__all__ = [
    "NoTypeSupportImportedException",
    "NodeNameNonExistentError",
    "RCLError",
    "RCLInvalidROSArgsError",
    "TimerCancelledError",
    "UnknownROSArgsError",
    "UnsupportedEventTypeError",
]


class NoTypeSupportImportedException(Exception):
    """An interface class cannot be used."""

    def __init__(self) -> None:
        super().__init__("no type_support imported")


class RCLInvalidROSArgsError(RCLError):
    """A ROS argument is malformed."""


class UnknownROSArgsError(RuntimeError):
    """There are ROS arguments that are not known."""


class TimerCancelledError(RCLError):
    """A timer is called that is cancelled."""


class UnsupportedEventTypeError(RCLError):
    """The middleware has no events of a type."""
