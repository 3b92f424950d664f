"""Loggers with the methods of rclpy's loggers, log records, levels, and filters.

The filters are: once, skip the first, and throttle.
"""

from __future__ import annotations

import sys
import time
import traceback
from collections.abc import Callable
from dataclasses import dataclass, field
from enum import IntEnum
from types import CodeType, FrameType
from typing import Any

from linkwright.diagnostics import LinkwrightError


class LogLevel(IntEnum):
    """The severities, with rcutils' numbers and names."""

    UNSET = 0
    DEBUG = 10
    INFO = 20
    WARN = 30
    ERROR = 40
    FATAL = 50


def level_from_name(name: str) -> LogLevel | None:
    """Return the severity with a name, regardless of case, or None if the name is unknown."""
    return LogLevel.__members__.get(name.upper())


class LogLevels:
    """The levels of the loggers of a graph.

    A logger without a level of its own inherits the level of its nearest ancestor, such as ``robot`` for ``robot.arm``.
    The default level is the root of this tree.

    Attributes:
        revision: a counter that increases with every change to a level.
    """

    def __init__(self, default: LogLevel = LogLevel.INFO) -> None:
        self._default = default
        self._levels_by_name: dict[str, LogLevel] = {}
        self.revision = 0

    def set(self, name: str, level: LogLevel) -> None:
        """Set the level of a logger.

        UNSET removes the level. With an empty name, set the default level.
        """
        if not name:
            self._default = level or LogLevel.INFO
        else:
            self._levels_by_name[name] = level
        self.revision += 1

    def reset(self) -> None:
        """Remove all levels that were set, and reset the default level to INFO."""
        self._default = LogLevel.INFO
        self._levels_by_name.clear()
        self.revision += 1

    def own_level(self, name: str) -> LogLevel:
        """Return the level that was set for a logger itself, or UNSET if none was set.

        For an empty name, return the default level.
        """
        return self._levels_by_name.get(name, LogLevel.UNSET) if name else self._default

    def effective_level(self, name: str) -> LogLevel:
        """Return the level in force for a logger.

        It is the level of the logger or of its nearest ancestor, or the default level.
        """
        while name:
            level = self._levels_by_name.get(name)
            if level:
                return level
            name = name.rpartition(".")[0]
        return self._default


@dataclass(frozen=True, slots=True)
class LogRecord:
    """A message of a logger.

    Attributes:
        node: the logger's name, which consists of the node's namespace and name, joined by dots.
        level: the severity.
        stamp_ns: the time, in nanoseconds since the epoch by the graph's clock.
        text: the message; it may have several lines.
        file: the path of the source file that logged it; empty if it is not known.
        function: the function that logged it.
        line: the line number in the source file.
    """

    node: str
    level: LogLevel
    stamp_ns: int
    text: str
    file: str = field(default="", compare=False)
    function: str = field(default="", compare=False)
    line: int = field(default=0, compare=False)


LogSink = Callable[[LogRecord], None]
"""Receives records: the console, a file, ``/rosout``."""


class Logger:
    """A named logger with the methods of rclpy's loggers.

    The methods ``debug`` to ``fatal`` and `log` accept the filters ``once=True``, ``skip_first=True`` and
    ``throttle_duration_sec=SECONDS``. ``throttle_time_source_type=CLOCK`` sets the clock of the throttle. A filter
    applies to one call site. The methods return whether the record was logged.

    Args:
        name: the name in the records.
        sink: receives the records.
        now_ns: the clock that stamps the records, in nanoseconds since the epoch.
        levels: the tree of levels that the logger belongs to; a separate one by default.
        steady_ns: the steady time that throttles use, in nanoseconds.

    Attributes:
        name: the name in the records.
        rosout: publishes the records on ``/rosout``; None to publish nothing. Children inherit it.
    """

    __slots__ = ("_calls", "_effective", "_levels", "_now_ns", "_revision", "_sink", "_steady_ns", "name", "rosout")

    def __init__(
        self,
        name: str,
        sink: LogSink,
        now_ns: Callable[[], int],
        levels: LogLevels | None = None,
        steady_ns: Callable[[], int] = time.monotonic_ns,
    ) -> None:
        self.name = name
        self.rosout: LogSink | None = None
        self._sink = sink
        self._now_ns = now_ns
        self._steady_ns = steady_ns
        self._levels = levels or LogLevels()
        self._effective = LogLevel.INFO
        self._revision = -1
        self._calls: dict[tuple[CodeType, int], CallFilter] = {}

    @property
    def level(self) -> LogLevel:
        """The level in force for this logger.

        Assignment calls `set_level`.
        """
        return self.get_effective_level()

    @level.setter
    def level(self, level: LogLevel) -> None:
        self.set_level(level)

    def set_level(self, level: int) -> None:
        """Set the level of the logger, which its children inherit.

        With UNSET the logger inherits its level again.
        """
        self._levels.set(self.name, LogLevel(level))

    def get_effective_level(self) -> LogLevel:
        """Return the level in force for this logger.

        It is the level of the logger or of its nearest ancestor, or the default level.
        """
        if self._revision != self._levels.revision:
            self._effective = self._levels.effective_level(self.name)
            self._revision = self._levels.revision
        return self._effective

    def is_enabled_for(self, severity: int) -> bool:
        """Return whether records of a severity are logged at the logger's effective level."""
        return severity >= self.get_effective_level()

    def get_child(self, name: str) -> Logger:
        """Return a logger named ``PARENT.NAME``, where PARENT is the name of this logger.

        Raises:
            ValueError: the name is empty.
        """
        if not name:
            raise ValueError("Child logger name must not be empty.")
        child = Logger(f"{self.name}.{name}" if self.name else name, self._sink, self._now_ns, self._levels)
        child._steady_ns = self._steady_ns
        child.rosout = self.rosout
        return child

    def log(self, message: object, severity: int, **filters: Any) -> bool:
        """Log a record unless its severity is below the level or a filter suppresses it.

        Returns whether the record was logged.

        Raises:
            TypeError: a filter is unknown or incomplete.
            ValueError: an earlier call at the same call site had another severity or other filters.
        """
        is_enabled = severity >= self.get_effective_level()
        if not is_enabled and not filters:
            return False
        frame = _find_caller()
        name = filters.pop("name", self.name)
        key = (frame.f_code, frame.f_lasti)
        call = self._calls.get(key)
        if call is None:
            self._calls[key] = call = CallFilter(severity, name, filters, self._steady_ns)
        else:
            call.check_unchanged(severity, name, filters)
        if not is_enabled or not call.should_log():
            return False
        code = frame.f_code
        record = LogRecord(
            name, LogLevel(severity), self._now_ns(), str(message), code.co_filename, code.co_name, frame.f_lineno
        )
        self._sink(record)
        if self.rosout is not None:
            self.rosout(record)
        return True

    def debug(self, message: object, **filters: Any) -> bool:
        """Log with severity DEBUG."""
        return self.log(message, LogLevel.DEBUG, **filters)

    def info(self, message: object, **filters: Any) -> bool:
        """Log with severity INFO."""
        return self.log(message, LogLevel.INFO, **filters)

    def warning(self, message: object, **filters: Any) -> bool:
        """Log with severity WARN."""
        return self.log(message, LogLevel.WARN, **filters)

    def warn(self, message: object, **filters: Any) -> bool:
        """Log with severity WARN. `warning` is rclpy's preferred name."""
        return self.log(message, LogLevel.WARN, **filters)

    def error(self, message: object, **filters: Any) -> bool:
        """Log with severity ERROR."""
        return self.log(message, LogLevel.ERROR, **filters)

    def fatal(self, message: object, **filters: Any) -> bool:
        """Log with severity FATAL."""
        return self.log(message, LogLevel.FATAL, **filters)


def _find_caller() -> FrameType:
    """Return the frame that called a logger: the innermost frame outside this module."""
    frame = sys._getframe(2)
    while frame.f_code.co_filename == __file__ and frame.f_back is not None:
        frame = frame.f_back
    return frame


def log_failure(logger: Logger, operation: str, error: BaseException) -> None:
    """Log a failure, with a traceback unless the user caused it.

    Args:
        logger: the logger.
        operation: the operation that failed.
        error: the exception; a mistake of the user is a `LinkwrightError`.
    """
    if isinstance(error, LinkwrightError):
        details = f" {error}"
    else:
        details = "\n" + "".join(traceback.format_exception(error)).rstrip()
    logger.error(f"{operation} failed:{details}")


def run_logged(logger: Logger, operation: str, callback: Callable[[], object]) -> None:
    """Call a function, and log an exception instead of raising it.

    Args:
        logger: the logger.
        operation: the operation, for the log message.
        callback: the function.
    """
    try:
        callback()
    except Exception as error:  # noqa: BLE001  # a failing callback must not stop the other nodes of the process
        log_failure(logger, operation, error)


_DEFAULT_TIME_SOURCE = "RCUTILS_STEADY_TIME"
_OPTIONS = ("throttle_duration_sec", "throttle_time_source_type", "skip_first", "once")


class CallFilter:
    """The filters of one call site of a logger, and their state.

    Args:
        severity: the severity of the records logged there.
        name: the name of the logger.
        options: ``throttle_duration_sec``, ``throttle_time_source_type``, ``skip_first``, ``once``.
        steady_ns: returns the steady time, in nanoseconds, that is used if no time source is given.

    Raises:
        TypeError: an option is unknown, or requires another option.
        ValueError: the time source is neither a clock nor rcutils' steady time.
    """

    __slots__ = ("_duration_s", "_last_s", "_logged", "_now_s", "_once", "_options", "_severity_and_name", "_skip")

    def __init__(
        self,
        severity: int,
        name: str,
        options: dict[str, Any],
        steady_ns: Callable[[], int] = time.monotonic_ns,
    ) -> None:
        for option in options:
            if option not in _OPTIONS:
                raise TypeError(f'parameter "{option}" is not one of the recognized logging options "{list(_OPTIONS)}"')
        if options.get("throttle_time_source_type") and options.get("throttle_duration_sec") is None:
            raise TypeError(
                'required parameter "throttle_duration_sec" not specified but is required for the the logging '
                'filter "throttle"'
            )
        self._options = dict(options)
        self._severity_and_name = (severity, name)
        self._duration_s = float(options.get("throttle_duration_sec") or 0.0)
        self._now_s = _make_time_function(options.get("throttle_time_source_type", _DEFAULT_TIME_SOURCE), steady_ns)
        self._last_s: float | None = None
        self._skip = bool(options.get("skip_first"))
        self._once = bool(options.get("once"))
        self._logged = False

    def check_unchanged(self, severity: int, name: str, options: dict[str, Any]) -> None:
        """Raise ValueError unless a call has the first call's severity, logger name and filters."""
        if severity != self._severity_and_name[0]:
            raise ValueError("Logger severity cannot be changed between calls.")
        if name != self._severity_and_name[1]:
            raise ValueError("Logger name cannot be changed between calls.")
        if options != self._options:
            if _list_active_filters(options) != _list_active_filters(self._options):
                raise ValueError("Requested logging filters cannot be changed between calls.")
            raise ValueError("Logging filter parameters cannot be changed between calls.")

    def should_log(self) -> bool:
        """Count a call, and return whether it must be logged."""
        if self._duration_s:
            now_s = self._now_s()
            # If the clock jumped back, the throttle starts again.
            if self._last_s is not None and self._last_s <= now_s < self._last_s + self._duration_s:
                return False
            self._last_s = now_s
        if self._skip:
            self._skip = False
            return False
        if self._once:
            is_first_call, self._logged = not self._logged, True
            return is_first_call
        return True


def _list_active_filters(options: dict[str, Any]) -> list[bool]:
    return [bool(options.get(option)) for option in ("throttle_duration_sec", "skip_first", "once")]


def _make_time_function(source: Any, steady_ns: Callable[[], int]) -> Callable[[], float]:
    if source == _DEFAULT_TIME_SOURCE:
        return lambda: steady_ns() / 1e9
    now = getattr(source, "now", None)
    if now is None:
        raise ValueError(
            f'Received throttle_time_source_type of "{source}"; it must be a clock or "{_DEFAULT_TIME_SOURCE}"'
        )
    return lambda: float(now().nanoseconds) / 1e9
