"""Executors: which thread runs which callback, as in rclpy."""

from linkwright.graph.executors.callback_groups import (
    CallbackGroup,
    MutuallyExclusiveCallbackGroup,
    ReentrantCallbackGroup,
)
from linkwright.graph.executors.errors import (
    ConditionReachedException,
    ExternalShutdownException,
    ShutdownException,
    TimeoutException,
)
from linkwright.graph.executors.executor import Context, Executor
from linkwright.graph.executors.multi_threaded import MultiThreadedExecutor
from linkwright.graph.executors.single_threaded import SingleThreadedExecutor
from linkwright.graph.executors.task import Task

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
