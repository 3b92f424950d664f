"""Stands in for ``rclpy``, the Python client library of ROS 2."""

from linkwright.graph.executors import Task
from linkwright.graph.future import Future
from linkwright.graph.parameters.parameter import Parameter
from linkwright.standins.imported_names import submodules_of
from linkwright.standins.rclpy_api.context import Context
from linkwright.standins.rclpy_api.node import Node
from linkwright.standins.rclpy_api.session import (
    InitContextManager,
    create_node,
    get_default_context,
    get_global_executor,
    init,
    ok,
    shutdown,
    spin,
    spin_once,
    spin_until_future_complete,
    try_shutdown,
)
from linkwright.standins.rclpy_api.signals import SignalHandlerOptions, uninstall_signal_handlers
from linkwright.standins.rclpy_api.utilities import get_rmw_implementation_identifier

__all__ = [
    "Context",
    "Future",
    "InitContextManager",
    "Node",
    "Parameter",
    "SignalHandlerOptions",
    "Task",
    "create_node",
    "get_default_context",
    "get_global_executor",
    "get_rmw_implementation_identifier",
    "init",
    "ok",
    "shutdown",
    "spin",
    "spin_once",
    "spin_until_future_complete",
    "try_shutdown",
    "uninstall_signal_handlers",
]

__getattr__ = submodules_of(__name__)
