"""The log console: what nodes write to ``/rosout``."""

from __future__ import annotations

from linkwright.viewer.protocol.message import PageMessage, Record, ServerMessage


class LogLine(Record):
    """A record. `level` is rcl_interfaces/msg/Log's: 10 debug, 20 info, 30 warning, 40 error, 50 fatal; `time` in s."""

    level: int
    node: str
    message: str
    time: float
    file: str
    function: str
    line: int


class LogLines(ServerMessage):
    """New records in the order they came; `missed` counts those that were too many to be sent."""

    lines: list[LogLine]
    missed: int


class WatchLog(PageMessage):
    """Whether the page wants to be told of new records."""

    watched: bool
