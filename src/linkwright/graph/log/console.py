"""Outputs of log records: the console, in rcutils' format, and the topic ``/rosout``.

The environment variable RCUTILS_CONSOLE_OUTPUT_FORMAT sets the format, also for log files.
"""

from __future__ import annotations

import os
import re
import sys
import threading
from collections.abc import Callable
from contextlib import suppress
from datetime import datetime
from functools import lru_cache
from pathlib import PurePath
from typing import Any, Protocol, TextIO

from linkwright.graph.faults import RclError
from linkwright.graph.log.logger import Logger, LogLevel, LogRecord
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

DEFAULT_FORMAT = "[{severity}] [{time}] [{name}]: {message}"

_MAX_FORMAT_LENGTH = 2047
_TOKEN = re.compile(r"\{(\w+)\}")
_ESCAPES = {"a": "\a", "b": "\b", "n": "\n", "r": "\r", "t": "\t", "x1b": "\x1b"}
_ESCAPE = re.compile(r"\\(x1b|[abnrt])")

_Formatter = Callable[["LogRecord"], str]


def format_console_line(record: LogRecord) -> str:
    """Format a record as rcutils does.

    The default format is ``[INFO] [1700000000.123456789] [node]: text``.
    """
    return "".join(
        formatter(record)
        for formatter in _parse_format(os.environ.get("RCUTILS_CONSOLE_OUTPUT_FORMAT") or DEFAULT_FORMAT)
    )


@lru_cache(maxsize=8)
def _parse_format(format_text: str) -> tuple[_Formatter, ...]:
    """Return a function for each literal text and each known token of a format.

    Unknown tokens are left unchanged.
    """
    text = _ESCAPE.sub(lambda match: _ESCAPES[match[1]], format_text[:_MAX_FORMAT_LENGTH])
    formatters: list[_Formatter] = []
    end = 0
    for match in _TOKEN.finditer(text):
        token = _TOKENS.get(match[1])
        if token is not None:
            formatters += [_make_literal_formatter(text[end : match.start()]), token]
            end = match.end()
    formatters.append(_make_literal_formatter(text[end:]))
    return tuple(formatters)


def _make_literal_formatter(text: str) -> _Formatter:
    return lambda _: text


def _format_seconds(record: LogRecord) -> str:
    seconds, nanoseconds = divmod(record.stamp_ns, NANOSECONDS_PER_SECOND)
    return f"{seconds}.{nanoseconds:09d}"


def _format_date_time(record: LogRecord) -> str:
    seconds, nanoseconds = divmod(record.stamp_ns, NANOSECONDS_PER_SECOND)
    local_time = datetime.fromtimestamp(seconds).astimezone()
    return f"{local_time:%Y-%m-%d %H:%M:%S}.{nanoseconds // 1_000_000:03d}"


_TOKENS: dict[str, _Formatter] = {
    "severity": lambda record: record.level.name,
    "name": lambda record: record.node,
    "message": lambda record: record.text,
    "function_name": lambda record: record.function,
    "file_name": lambda record: record.file,
    "short_file_name": lambda record: PurePath(record.file).name,
    "time": _format_seconds,
    "time_as_nanoseconds": lambda record: str(record.stamp_ns),
    "date_time_with_ms": _format_date_time,
    "line_number": lambda record: str(record.line),
    "thread_id": lambda _: str(threading.get_native_id()),
}


_COLOR_RESET = "\x1b[0m"
_COLORS = {
    LogLevel.DEBUG: "\x1b[32m",
    LogLevel.INFO: _COLOR_RESET,
    LogLevel.WARN: "\x1b[33m",
    LogLevel.ERROR: "\x1b[31m",
    LogLevel.FATAL: "\x1b[31m",
}


def print_to_console(record: LogRecord) -> None:
    """Write a record to standard error, or to standard output on request.

    RCUTILS_LOGGING_USE_STDOUT=1 selects standard output. Records are colored on terminals. RCUTILS_COLORIZED_OUTPUT (0
    or 1) overrides this; if it is not set, NO_COLOR turns colors off. Each record is flushed immediately, regardless
    of RCUTILS_LOGGING_BUFFERED_STREAM, so that no record is lost if the process dies. Errors of the stream are ignored.
    """
    stream: TextIO | None = sys.stdout if os.environ.get("RCUTILS_LOGGING_USE_STDOUT") == "1" else sys.stderr
    if stream is None:  # A program without a console has no stream.
        return
    line = format_console_line(record)
    try:
        if _wants_color(stream):
            line = f"{_COLORS[record.level]}{line}{_COLOR_RESET}"
        stream.write(f"{line}\n")
        stream.flush()
    except (OSError, ValueError):
        # A broken pipe, a full disk or a closed stream must not end the program.
        return


def _wants_color(stream: TextIO) -> bool:
    setting = os.environ.get("RCUTILS_COLORIZED_OUTPUT")
    if setting in ("0", "1"):
        return setting == "1"
    return stream.isatty() and not os.environ.get("NO_COLOR")


LOG_TYPE = "rcl_interfaces/msg/Log"
ROSOUT_TOPIC = "/rosout"


class LogPublisher(Protocol):
    """A publisher of messages of the type `LOG_TYPE`."""

    @property
    def msg_type(self) -> type[Any]:
        """The message class."""

    def publish(self, msg: Any) -> None:
        """Publish a log message."""


class Rosout:
    """A publisher of the log records of a node's logger and its children on ``/rosout``.

    Args:
        publisher: the node's publisher of ``/rosout``.
        logger: the node's logger.
    """

    def __init__(self, publisher: LogPublisher, logger: Logger) -> None:
        self._publisher = publisher
        self._logger = logger
        self._is_publishing = False
        logger.rosout = self.publish

    def publish(self, record: LogRecord) -> None:
        """Publish a record.

        Records that are logged while one is being published, or after a signal, are not published.
        """
        if self._is_publishing:
            return
        self._is_publishing = True
        try:
            with suppress(RclError):
                self._publisher.publish(self._to_message(record))
        finally:
            self._is_publishing = False

    def close(self) -> None:
        """Stop publishing.

        The node, not this object, destroys the publisher.
        """
        self._logger.rosout = None

    def _to_message(self, record: LogRecord) -> Any:
        seconds, nanoseconds = divmod(record.stamp_ns, NANOSECONDS_PER_SECOND)
        message = self._publisher.msg_type()
        message.stamp.sec = seconds
        message.stamp.nanosec = nanoseconds
        message.level = int(record.level)
        message.name = record.node
        message.msg = record.text
        message.file = record.file
        message.function = record.function
        message.line = record.line
        return message
