"""Stands in for ``rclpy.executors``."""

from linkwright.graph.executors import (
    ConditionReachedException,
    ExternalShutdownException,
    ShutdownException,
    TimeoutException,
)
from linkwright.standins.rclpy_api.executors import (
    Executor,
    MultiThreadedExecutor,
    SingleThreadedExecutor,
    await_or_execute,
)
from linkwright.standins.rclpy_api.imported_names import imported_there as __getattr__

__all__ = [
    "ConditionReachedException",
    "Executor",
    "ExternalShutdownException",
    "MultiThreadedExecutor",
    "ShutdownException",
    "SingleThreadedExecutor",
    "TimeoutException",
    "await_or_execute",
]
