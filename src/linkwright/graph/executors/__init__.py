"""Executors, which decide which thread runs which callback, as in rclpy."""

from linkwright.graph.executors.base import Context, Executor
from linkwright.graph.executors.multi_threaded import MultiThreadedExecutor
from linkwright.graph.executors.single_threaded import SingleThreadedExecutor
from linkwright.graph.executors.task import Task
from linkwright.graph.faults import (
    ConditionReachedException,
    ExternalShutdownException,
    ShutdownException,
    TimeoutException,
)
from linkwright.graph.loop.node_handle import (
    CallbackGroup,
    MutuallyExclusiveCallbackGroup,
    ReentrantCallbackGroup,
)

__all__ = [
    "CallbackGroup",
    "ConditionReachedException",
    "Context",
    "Executor",
    "ExternalShutdownException",
    "MultiThreadedExecutor",
    "MutuallyExclusiveCallbackGroup",
    "ReentrantCallbackGroup",
    "ShutdownException",
    "SingleThreadedExecutor",
    "Task",
    "TimeoutException",
]
