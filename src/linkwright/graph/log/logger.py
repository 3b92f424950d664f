"""Loggers, with the methods of rclpy's."""

from __future__ import annotations

import sys
import time
import traceback
from collections.abc import Callable
from types import CodeType, FrameType
from typing import Any

from linkwright.diagnostics import LinkwrightError
from linkwright.graph.log.filters import CallFilter
from linkwright.graph.log.levels import LogLevel, LogLevels
from linkwright.graph.log.record import LogRecord, LogSink


class Logger:
    """Writes the records of one name. The methods are those of rclpy's loggers.

    The methods ``debug`` to ``fatal`` and `log` take the filters ``once=True``, ``skip_first=True`` and
    ``throttle_duration_sec=SECONDS``, each for the place in the code that calls, and with the last one
    ``throttle_time_source_type=CLOCK``. They give whether the record was written.

    Args:
        name: the name that records carry.
        sink: what takes the records.
        now_ns: the clock that stamps them.
        levels: the levels of this logger and those it belongs with; its own when left out.
        steady_ns: the steady count that throttles go by.

    Attributes:
        name: the name that records carry.
        rosout: what takes the records as well, for ``/rosout``; None for nothing. Children inherit it.
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
        """Give the logger a level of its own, which its children inherit; UNSET has it inherit again."""
        self._levels.set(self.name, LogLevel(level))

    def get_effective_level(self) -> LogLevel:
        """The level that holds: its own, or that of the nearest logger above it, or the default level."""
        if self._revision != self._levels.revision:
            self._effective = self._levels.effective(self.name)
            self._revision = self._levels.revision
        return self._effective

    def is_enabled_for(self, severity: int) -> bool:
        """Whether records of a severity are written."""
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
        """Write a record, unless the level or a filter is against it; gives whether it was written.

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
        """Write what helps to find a fault."""
        return self.log(message, LogLevel.DEBUG, **filters)

    def info(self, message: object, **filters: Any) -> bool:
        """Write what a user may want to know."""
        return self.log(message, LogLevel.INFO, **filters)

    def warning(self, message: object, **filters: Any) -> bool:
        """Write what may be wrong."""
        return self.log(message, LogLevel.WARN, **filters)

    def warn(self, message: object, **filters: Any) -> bool:
        """The same as `warning`, which rclpy prefers."""
        return self.log(message, LogLevel.WARN, **filters)

    def error(self, message: object, **filters: Any) -> bool:
        """Write what is wrong."""
        return self.log(message, LogLevel.ERROR, **filters)

    def fatal(self, message: object, **filters: Any) -> bool:
        """Write why the node cannot go on."""
        return self.log(message, LogLevel.FATAL, **filters)


def _caller() -> FrameType:
    """The frame that called a logger: the first one outside of this module."""
    frame = sys._getframe(2)
    while frame.f_code.co_filename == __file__ and frame.f_back is not None:
        frame = frame.f_back
    return frame


def log_failure(logger: Logger, what: str, error: BaseException) -> None:
    """Log that something failed: a mistake in the user's input by its own words, anything else with its traceback."""
    if isinstance(error, LinkwrightError):
        problem = f" {error}"
    else:
        problem = "\n" + "".join(traceback.format_exception(error)).rstrip()
    logger.error(f"{what} failed:{problem}")


def run_logged(logger: Logger, what: str, callback: Callable[[], object]) -> None:
    """Call something; if it fails, log that and go on."""
    try:
        callback()
    except Exception as error:  # noqa: BLE001  # one callback must not take the other nodes of the process with it
        log_failure(logger, what, error)
