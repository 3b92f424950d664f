"""Loggers with the methods of rclpy's: their records, levels and filters (once, skip the first, throttle)."""

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
    """Severities with rcutils' numbers and names."""

    UNSET = 0
    DEBUG = 10
    INFO = 20
    WARN = 30
    ERROR = 40
    FATAL = 50


def level_named(name: str) -> LogLevel | None:
    """The severity of a name, in upper or lower case; None for an unknown name."""
    return LogLevel.__members__.get(name.upper())


class LogLevels:
    """The levels of the loggers of a graph.

    A logger without a level of its own has that of the nearest one above it, ``robot`` for ``robot.arm``; the topmost
    is the default level.

    Attributes:
        revision: changes with every change of a level.
    """

    def __init__(self, default: LogLevel = LogLevel.INFO) -> None:
        self._default = default
        self._own: dict[str, LogLevel] = {}
        self.revision = 0

    def set(self, name: str, level: LogLevel) -> None:
        """Set the level of a logger; UNSET removes it. The empty name sets the default level."""
        if not name:
            self._default = level or LogLevel.INFO
        else:
            self._own[name] = level
        self.revision += 1

    def reset(self) -> None:
        """Forget every level that was set."""
        self._default = LogLevel.INFO
        self._own.clear()
        self.revision += 1

    def own(self, name: str) -> LogLevel:
        """The level that was set for a logger itself; UNSET where none was."""
        return self._own.get(name, LogLevel.UNSET) if name else self._default

    def effective(self, name: str) -> LogLevel:
        """The level in force for a logger: its own, or that of the nearest logger above it, or the default."""
        while name:
            level = self._own.get(name)
            if level:
                return level
            name = name.rpartition(".")[0]
        return self._default


@dataclass(frozen=True, slots=True)
class LogRecord:
    """One message of a logger.

    Attributes:
        node: the logger's name: the node's name with its namespace before it, joined by dots.
        level: its severity.
        stamp_ns: the time, nanoseconds since the epoch by the graph's clock.
        text: the message; it may have several lines.
        file: path of the source file that logged it; empty where that is not known.
        function: the function in it.
        line: the line in it.
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
    """Logs under one name, with the methods of rclpy's loggers.

    The methods ``debug`` to ``fatal`` and `log` take the filters ``once=True``, ``skip_first=True`` and
    ``throttle_duration_sec=SECONDS``, with the last one also ``throttle_time_source_type=CLOCK``. A filter holds for
    the place in the code that logs. The methods return whether the record was logged.

    Args:
        name: the name in its records.
        sink: receives the records.
        now_ns: the clock that stamps them, nanoseconds since the epoch.
        levels: the tree of levels that it belongs to; a separate one when left out.
        steady_ns: the steady time that throttles use, nanoseconds.

    Attributes:
        name: the name in its records.
        rosout: receives the records too, for ``/rosout``; None for no topic. Children inherit it.
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
        """Records below this level are dropped. Setting it is `set_level`."""
        return self.get_effective_level()

    @level.setter
    def level(self, level: LogLevel) -> None:
        self.set_level(level)

    def set_level(self, level: int) -> None:
        """Set its level, which its children inherit; with UNSET it inherits one again."""
        self._levels.set(self.name, LogLevel(level))

    def get_effective_level(self) -> LogLevel:
        """The level in force: its own, or that of the nearest logger above it, or the default level."""
        if self._revision != self._levels.revision:
            self._effective = self._levels.effective(self.name)
            self._revision = self._levels.revision
        return self._effective

    def is_enabled_for(self, severity: int) -> bool:
        """Whether records of a severity are logged."""
        return severity >= self.get_effective_level()

    def get_child(self, name: str) -> Logger:
        """A logger whose name is this one's, a dot and the name given.

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
        """Log a record unless its severity is below the level or a filter holds it back; returns whether it was logged.

        Raises:
            TypeError: a filter is not known or incomplete.
            ValueError: the same place in the code called with another severity or other filters before.
        """
        enabled = severity >= self.get_effective_level()
        if not enabled and not filters:
            return False
        frame = _caller()
        name = filters.pop("name", self.name)
        key = (frame.f_code, frame.f_lasti)
        call = self._calls.get(key)
        if call is None:
            self._calls[key] = call = CallFilter(severity, name, filters, self._steady_ns)
        else:
            call.check_unchanged(severity, name, filters)
        if not enabled or not call.lets_through():
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
        """The same as `warning`, which rclpy prefers."""
        return self.log(message, LogLevel.WARN, **filters)

    def error(self, message: object, **filters: Any) -> bool:
        """Log with severity ERROR."""
        return self.log(message, LogLevel.ERROR, **filters)

    def fatal(self, message: object, **filters: Any) -> bool:
        """Log with severity FATAL."""
        return self.log(message, LogLevel.FATAL, **filters)


def _caller() -> FrameType:
    """The frame that called a logger: the first one outside of this module."""
    frame = sys._getframe(2)
    while frame.f_code.co_filename == __file__ and frame.f_back is not None:
        frame = frame.f_back
    return frame


def log_failure(logger: Logger, what: str, error: BaseException) -> None:
    """Log a failure: a mistake in the user's input by its own words, any other exception with its traceback."""
    if isinstance(error, LinkwrightError):
        problem = f" {error}"
    else:
        problem = "\n" + "".join(traceback.format_exception(error)).rstrip()
    logger.error(f"{what} failed:{problem}")


def run_logged(logger: Logger, what: str, callback: Callable[[], object]) -> None:
    """Call a function; an exception is logged, not raised."""
    try:
        callback()
    except Exception as error:  # noqa: BLE001  # one callback must not take the other nodes of the process with it
        log_failure(logger, what, error)


_DEFAULT_TIME_SOURCE = "RCUTILS_STEADY_TIME"
_OPTIONS = ("throttle_duration_sec", "throttle_time_source_type", "skip_first", "once")


class CallFilter:
    """The filters of one place in the code that logs, and their state.

    Args:
        severity: that of the place's records.
        name: the name of their logger.
        options: ``throttle_duration_sec``, ``throttle_time_source_type``, ``skip_first``, ``once``.
        steady_ns: the steady time that is used where no time source is given, nanoseconds.

    Raises:
        TypeError: an option is not known, or requires another one.
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
        self._now_s = _clock_of(options.get("throttle_time_source_type", _DEFAULT_TIME_SOURCE), steady_ns)
        self._last_s: float | None = None
        self._skip = bool(options.get("skip_first"))
        self._once = bool(options.get("once"))
        self._logged = False

    def check_unchanged(self, severity: int, name: str, options: dict[str, Any]) -> None:
        """Raise ValueError if a call has another severity, name or other filters than the first one at the place."""
        if severity != self._severity_and_name[0]:
            raise ValueError("Logger severity cannot be changed between calls.")
        if name != self._severity_and_name[1]:
            raise ValueError("Logger name cannot be changed between calls.")
        if options != self._options:
            if _filters(options) != _filters(self._options):
                raise ValueError("Requested logging filters cannot be changed between calls.")
            raise ValueError("Logging filter parameters cannot be changed between calls.")

    def lets_through(self) -> bool:
        """Whether this call is logged; counts it."""
        if self._duration_s:
            now_s = self._now_s()
            # A clock that jumped back starts again.
            if self._last_s is not None and self._last_s <= now_s < self._last_s + self._duration_s:
                return False
            self._last_s = now_s
        if self._skip:
            self._skip = False
            return False
        if self._once:
            first, self._logged = not self._logged, True
            return first
        return True


def _filters(options: dict[str, Any]) -> list[bool]:
    return [bool(options.get(option)) for option in ("throttle_duration_sec", "skip_first", "once")]


def _clock_of(source: Any, steady_ns: Callable[[], int]) -> Callable[[], float]:
    if source == _DEFAULT_TIME_SOURCE:
        return lambda: steady_ns() / 1e9
    now = getattr(source, "now", None)
    if now is None:
        raise ValueError(
            f'Received throttle_time_source_type of "{source}"; it must be a clock or "{_DEFAULT_TIME_SOURCE}"'
        )
    return lambda: float(now().nanoseconds) / 1e9
