"""Functions for command lines, timeouts and middleware names (rclpy ``utilities``)."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from linkwright.graph.command_line import ros_arguments
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND


def remove_ros_args(args: Sequence[str] | None = None) -> list[str]:
    """Return a command line without its ROS arguments.

    Args:
        args: the command line with the program's name; None for ``sys.argv``.
    """
    return ros_arguments.remove_ros_arguments(sys.argv if args is None else args)


def timeout_sec_to_nsec(timeout_sec: float | None) -> int:
    """Convert a timeout to nanoseconds.

    For None and negative numbers, return -1 (no limit).
    """
    if timeout_sec is None or timeout_sec < 0:
        return -1
    return int(float(timeout_sec) * NANOSECONDS_PER_SECOND)


def get_rmw_implementation_identifier() -> str:
    """Return the name of the ROS middleware with which Linkwright's middleware is compatible."""
    from linkwright.wire.joining import select_middleware

    return select_middleware()


def get_available_rmw_implementations() -> set[str]:
    """Return the names of the available middleware implementations."""
    return {get_rmw_implementation_identifier()}
