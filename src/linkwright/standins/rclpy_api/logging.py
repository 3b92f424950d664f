"""The loggers of the process, independent of contexts (rclpy ``logging``)."""

from __future__ import annotations

import os
import time
from pathlib import Path

from linkwright.graph.log.console import print_to_console
from linkwright.graph.log.logger import Logger, LogLevel, LogLevels, LogRecord, LogSink, level_from_name

LEVELS = LogLevels()
"""The levels of all loggers of the process."""

LoggingSeverity = LogLevel

_sinks: list[LogSink] = [print_to_console]


def write(record: LogRecord) -> None:
    """Write a log record to the current sink."""
    _sinks[-1](record)


def write_to(sink: LogSink) -> None:
    """Redirect all loggers of the process from the console to `sink`."""
    _sinks[1:] = [sink]


def is_configured() -> bool:
    """Return whether the loggers write to a sink other than the console."""
    return len(_sinks) > 1


root_logger = Logger("", write, time.time_ns, LEVELS)
"""The parent of all loggers."""


def get_logger(name: str) -> Logger:
    """Return the logger with a name.

    Dots in the name separate the levels of the hierarchy.

    Raises:
        ValueError: the name is empty.
    """
    if not name:
        raise ValueError("Logger name must not be empty.")
    return root_logger.get_child(name)


def initialize() -> None:
    """Reset the levels of all loggers to their defaults."""
    LEVELS.reset()


def shutdown() -> None:
    """Make all loggers write to the console again."""
    del _sinks[1:]


def clear_config() -> None:
    """Make all loggers write to the console again, and reset their levels."""
    shutdown()
    initialize()


def set_logger_level(name: str, level: int, detailed_error: bool = False) -> None:  # noqa: ARG001  # rclpy's signature
    """Set the level of a logger and its children.

    The empty name sets the default level.
    """
    LEVELS.set(name, LogLevel(level))


def get_logger_effective_level(name: str) -> LogLevel:
    """Return the effective level of a logger: its own level, or else the inherited level."""
    return LEVELS.effective_level(name)


def get_logger_level(name: str) -> LogLevel:
    """Return the level that was set for a logger, or UNSET if none was set."""
    return LEVELS.own_level(name)


def get_logging_severity_from_string(log_severity: str) -> LogLevel:
    """Return the severity with a name, such as ``INFO``.

    Raises:
        RuntimeError: there is no such severity.
    """
    level = level_from_name(log_severity)
    if level is None:
        raise RuntimeError(f"failed to get severity from string '{log_severity}'")
    return level


def get_logging_directory() -> Path:
    """Return the folder of log files.

    This is ROS_LOG_DIR, otherwise ``log`` below ROS_HOME, otherwise ``~/.ros/log``.
    """
    folder = os.environ.get("ROS_LOG_DIR")
    if folder:
        return Path(folder).expanduser()
    home = os.environ.get("ROS_HOME")
    return (Path(home).expanduser() if home else Path.home() / ".ros") / "log"
