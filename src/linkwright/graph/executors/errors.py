"""Why an executor's wait for work ended without any (the names are rclpy's)."""

from __future__ import annotations


class TimeoutException(Exception):  # noqa: N818  # rclpy's name
    """The time given has passed."""


class ShutdownException(Exception):  # noqa: N818  # rclpy's name
    """The executor was shut down."""


class ExternalShutdownException(Exception):  # noqa: N818  # rclpy's name
    """The context was shut down, by a signal for one."""


class ConditionReachedException(Exception):  # noqa: N818  # rclpy's name
    """What was waited for has come true."""
