"""The Time panel: pause, synchronization and clocks. All pages share a pause, as they share the content."""

from __future__ import annotations

from typing import Literal

from linkwright.page.protocol.message import PageMessage, ServerMessage

SyncMode = Literal["Off", "Exact", "Approximate"]


class TimeState(ServerMessage):
    """The state of time, sent when it changes. `sources` are the displays whose messages can drive it."""

    paused: bool
    mode: SyncMode
    source: str
    sources: list[str]


class Clock(ServerMessage):
    """The clocks now, in seconds, for pages that watch them.

    `ros_start` and `wall_start` are when the elapsed time began. While `running` the ROS time advances as the wall time
    does, and the page counts by itself; a simulated or paused clock is sent again whenever it has changed.
    """

    ros: float
    ros_start: float
    wall: float
    wall_start: float
    running: bool


class TimeReset(ServerMessage):
    """Time was reset: displays dropped their messages."""


class SetTime(PageMessage):
    """The user pauses or resumes, or synchronizes time with a display's messages."""

    paused: bool
    mode: SyncMode
    source: str


class ResetTime(PageMessage):
    """The Reset button: displays are cleared, and elapsed times begin at zero."""


class WatchClock(PageMessage):
    """Whether a page shows the clocks."""

    watching: bool
