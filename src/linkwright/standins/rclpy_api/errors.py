"""The exceptions of rclpy that nothing in `linkwright.graph` raises; names and texts are rclpy's."""

from __future__ import annotations


class NoTypeSupportImportedException(Exception):
    """An interface class cannot be used."""

    def __init__(self) -> None:
        super().__init__("no type_support imported")


class RCLError(RuntimeError):
    """What the C libraries below rclpy complain about."""


class NodeNameNonExistentError(RCLError):
    """There is no node of a name."""


class RCLInvalidROSArgsError(RCLError):
    """A ROS argument is malformed."""


class UnknownROSArgsError(RuntimeError):
    """There are ROS arguments that are not known."""


class TimerCancelledError(RCLError):
    """A timer is called that is cancelled."""


class UnsupportedEventTypeError(RCLError):
    """The middleware has no events of a type."""
