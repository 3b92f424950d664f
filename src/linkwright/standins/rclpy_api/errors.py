"""The exceptions of rclpy: those that nothing in `linkwright.graph` raises, and what all of them are called."""

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
"""Where classes of exceptions are defined; what is in the last one is imported from there by the others."""


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


def name_as_rclpy() -> None:
    """Have tracebacks and logs of a program with rclpy say ``rclpy.exceptions.InvalidNodeNameException``."""
    for module in _MODULES:
        described = table.find(module)
        assert described is not None
        for name, said in described.names.items():
            if said.origin.startswith("linkwright."):
                found = getattr(import_module(said.origin), said.name)
                if isinstance(found, type) and issubclass(found, Exception):
                    found.__module__, found.__name__, found.__qualname__ = module, name, name
