"""Log records to the console, as rcutils writes them: which stream, which colours."""

from __future__ import annotations

import os
import sys
from typing import TextIO

from linkwright.graph.log.format import console_line
from linkwright.graph.log.levels import LogLevel
from linkwright.graph.log.record import LogRecord

_NORMAL = "\x1b[0m"
_COLOURS = {
    LogLevel.DEBUG: "\x1b[32m",
    LogLevel.INFO: _NORMAL,
    LogLevel.WARN: "\x1b[33m",
    LogLevel.ERROR: "\x1b[31m",
    LogLevel.FATAL: "\x1b[31m",
}


def print_to_console(record: LogRecord) -> None:
    """Write a record to standard error, or to standard output where RCUTILS_LOGGING_USE_STDOUT is 1.

    Terminals get colours; RCUTILS_COLORIZED_OUTPUT, 0 or 1, decides otherwise, and NO_COLOR where that says nothing.
    Each record is written out at once, whatever RCUTILS_LOGGING_BUFFERED_STREAM says, so that none is lost with the
    process; a stream that nobody reads any more is passed over.
    """
    stream = sys.stdout if os.environ.get("RCUTILS_LOGGING_USE_STDOUT") == "1" else sys.stderr
    line = console_line(record)
    if _wants_colour(stream):
        line = f"{_COLOURS[record.level]}{line}{_NORMAL}"
    try:
        stream.write(f"{line}\n")
        stream.flush()
    except (OSError, ValueError):
        # The reader has gone, the disk is full or the stream closed: a log line is no reason to end.
        return


def _wants_colour(stream: TextIO) -> bool:
    forced = os.environ.get("RCUTILS_COLORIZED_OUTPUT")
    if forced in ("0", "1"):
        return forced == "1"
    return stream.isatty() and not os.environ.get("NO_COLOR")
