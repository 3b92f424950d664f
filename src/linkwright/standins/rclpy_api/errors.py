"""The exceptions of rclpy that `linkwright.graph` does not raise, and rclpy's names of all exceptions."""

from __future__ import annotations

from importlib import import_module

from linkwright.graph.faults import NodeNotFoundError as NodeNameNonExistentError
from linkwright.graph.faults import RclError as RCLError
from linkwright.standins import table

__all__ = [
    "NoTypeSupportImportedException",
    "NodeNameNonExistentError",
    "RCLError",
    "RCLInvalidROSArgsError",
    "TimerCancelledError",
    "UnknownROSArgsError",
    "UnsupportedEventTypeError",
    "name_as_rclpy",
]

_MODULES = ("rclpy.exceptions", "rclpy.executors", "rclpy._rclpy_pybind11")
"""The modules of exception classes; the others import from the last one."""


class NoTypeSupportImportedException(Exception):
    """Raised when a class is not an interface class that can be used."""

    def __init__(self) -> None:
        super().__init__("no type_support imported")


class RCLInvalidROSArgsError(RCLError):
    """Raised when a ROS argument is malformed."""


class UnknownROSArgsError(RuntimeError):
    """Raised when there are unknown ROS arguments."""


class TimerCancelledError(RCLError):
    """Raised when a cancelled timer is called."""


class UnsupportedEventTypeError(RCLError):
    """Raised when the middleware does not support an event type."""


def name_as_rclpy() -> None:
    """Rename the exception classes, so that tracebacks and logs show rclpy's names.

    An example is ``rclpy.exceptions.InvalidNodeNameException``.
    """
    for module in _MODULES:
        described = table.find(module)
        assert described is not None
        for name, entry in described.names.items():
            if entry.origin.startswith("linkwright."):
                found = getattr(import_module(entry.origin), entry.name)
                if isinstance(found, type) and issubclass(found, Exception):
                    found.__module__, found.__name__, found.__qualname__ = module, name, name
