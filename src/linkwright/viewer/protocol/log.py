"""The log console: what nodes write to ``/rosout``."""

from __future__ import annotations

from typing import Literal

from linkwright.viewer.protocol.record import record


@record
class LogLine:
    """A record. `level` is rcl_interfaces/msg/Log's: 10 debug, 20 info, 30 warning, 40 error, 50 fatal; `time` in s."""

    level: int
    node: str
    message: str
    time: float
    file: str
    function: str
    line: int


@record
class LogLines:
    """New records in the order they came; `missed` counts those that were too many to be sent."""

    lines: list[LogLine]
    missed: int
    type: Literal["log_lines"] = "log_lines"


@record
class WatchLog:
    """Whether the page wants to be told of new records."""

    watched: bool
    type: Literal["watch_log"] = "watch_log"
