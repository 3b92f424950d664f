"""Stands in for ``rclpy.utilities``."""

from linkwright.standins.rclpy_api.imported_names import imported_there as __getattr__
from linkwright.standins.rclpy_api.session import get_default_context, ok, shutdown, try_shutdown
from linkwright.standins.rclpy_api.utilities import (
    get_available_rmw_implementations,
    get_rmw_implementation_identifier,
    remove_ros_args,
    timeout_sec_to_nsec,
)

__all__ = [
    "get_available_rmw_implementations",
    "get_default_context",
    "get_rmw_implementation_identifier",
    "ok",
    "remove_ros_args",
    "shutdown",
    "timeout_sec_to_nsec",
    "try_shutdown",
]
