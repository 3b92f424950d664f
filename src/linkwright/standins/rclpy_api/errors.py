"""The exceptions of rclpy: those that `linkwright.graph` lacks, and the names of all."""

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
    "rename_exceptions",
]

_EXCEPTION_MODULES = ("rclpy.exceptions", "rclpy.executors", "rclpy._rclpy_pybind11")
"""The modules of rclpy's exception classes. A class in several modules gets the name of the last one."""


class NoTypeSupportImportedException(Exception):
    """Raised when a class is not a message, service or action class."""

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


def rename_exceptions() -> None:
    """Rename the exception classes, so that tracebacks and logs show rclpy's names.

    For example, they show ``rclpy.exceptions.InvalidNodeNameException``.
    """
    for module in _EXCEPTION_MODULES:
        module_table = table.find(module)
        assert module_table is not None
        for name, entry in module_table.names.items():
            if entry.origin.startswith("linkwright."):
                exception_class = getattr(import_module(entry.origin), entry.name)
                if isinstance(exception_class, type) and issubclass(exception_class, Exception):
                    exception_class.__module__, exception_class.__name__, exception_class.__qualname__ = (
                        module,
                        name,
                        name,
                    )
