"""Log records of nodes, and the console format of ROS 2."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum

_NANOSECONDS_PER_SECOND = 1_000_000_000


class LogLevel(IntEnum):
    """Severities with rcutils' numbers and names."""

    DEBUG = 10
    INFO = 20
    WARN = 30
    ERROR = 40
    FATAL = 50


@dataclass(frozen=True, slots=True)
class LogRecord:
    """One message of a logger.

    Attributes:
        node: the logger's name: the node's name with its namespace before it, joined by dots.
        level: how bad it is.
        stamp_ns: when, nanoseconds since the epoch by the graph's clock.
        text: what was said; it may have several lines.
    """

    node: str
    level: LogLevel
    stamp_ns: int
    text: str


LogSink = Callable[[LogRecord], None]


class Logger:
    """Writes the records of one name.

    Args:
        name: the name that records carry.
        sink: what takes the records.
        now_ns: the clock that stamps them.
    """

    __slots__ = ("_now_ns", "_sink", "level", "name")

    def __init__(self, name: str, sink: LogSink, now_ns: Callable[[], int]) -> None:
        self.name = name
        self.level = LogLevel.INFO
        """Records below this level are dropped."""
        self._sink = sink
        self._now_ns = now_ns

    def log(self, level: LogLevel, text: str) -> None:
        """Write a record, unless the logger's level is higher."""
        if level >= self.level:
            self._sink(LogRecord(self.name, level, self._now_ns(), text))

    def debug(self, text: str) -> None:
        """Write what helps to find a fault."""
        self.log(LogLevel.DEBUG, text)

    def info(self, text: str) -> None:
        """Write what a user may want to know."""
        self.log(LogLevel.INFO, text)

    def warning(self, text: str) -> None:
        """Write what may be wrong."""
        self.log(LogLevel.WARN, text)

    def error(self, text: str) -> None:
        """Write what is wrong."""
        self.log(LogLevel.ERROR, text)

    def fatal(self, text: str) -> None:
        """Write why the node cannot go on."""
        self.log(LogLevel.FATAL, text)


def console_line(record: LogRecord) -> str:
    """A record in rcutils' default console format: ``[INFO] [1700000000.123456789] [node]: text``."""
    seconds, nanoseconds = divmod(record.stamp_ns, _NANOSECONDS_PER_SECOND)
    return f"[{record.level.name}] [{seconds}.{nanoseconds:09d}] [{record.node}]: {record.text}"


_COLOURS = {LogLevel.DEBUG: "32", LogLevel.WARN: "33", LogLevel.ERROR: "31", LogLevel.FATAL: "31"}


def print_to_console(record: LogRecord) -> None:
    """The default sink: standard error, coloured as rcutils does on a terminal unless NO_COLOR is set."""
    line = console_line(record)
    colour = _COLOURS.get(record.level)
    if colour and sys.stderr.isatty() and not os.environ.get("NO_COLOR"):
        line = f"\x1b[{colour}m{line}\x1b[0m"
    print(line, file=sys.stderr, flush=True)
