"""Log records: a message with its level, time and place in the code."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from linkwright.graph.log.levels import LogLevel


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
