"""Stands in for ``rclpy.logging``."""

from linkwright.standins.rclpy_api.logging import (
    LoggingSeverity,
    clear_config,
    get_logger,
    get_logger_effective_level,
    get_logger_level,
    get_logging_directory,
    get_logging_severity_from_string,
    initialize,
    set_logger_level,
    shutdown,
)
from linkwright.standins.rclpy_api.logging import root_logger as _root_logger

__all__ = [
    "LoggingSeverity",
    "clear_config",
    "get_logger",
    "get_logger_effective_level",
    "get_logger_level",
    "get_logging_directory",
    "get_logging_severity_from_string",
    "initialize",
    "set_logger_level",
    "shutdown",
]
