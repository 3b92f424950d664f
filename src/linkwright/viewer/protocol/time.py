"""The Time panel: pause, synchronization and clocks. Pausing is shared by all pages, as what they show is."""

from __future__ import annotations

from typing import Literal

from linkwright.viewer.protocol.record import record

SyncMode = Literal["Off", "Exact", "Approximate"]


@record
class TimeState:
    """How time goes, whenever that changes. `sources` are the displays whose messages can lead it."""

    paused: bool
    mode: SyncMode
    source: str
    sources: list[str]
    type: Literal["time_state"] = "time_state"


@record
class Clock:
    """The clocks now, in seconds, for pages that watch them.

    `ros_start` and `wall_start` are when the time that elapsed began. While `running` the ROS time goes on as the
    wall time does and the page counts by itself; a simulated or paused one is told anew whenever it has changed.
    """

    ros: float
    ros_start: float
    wall: float
    wall_start: float
    running: bool
    type: Literal["clock"] = "clock"


@record
class TimeReset:
    """Time began anew: what displays keep of messages is gone."""

    type: Literal["time_reset"] = "time_reset"


@record
class SetTime:
    """The user pauses, goes on, or leads time by a display's messages."""

    paused: bool
    mode: SyncMode
    source: str
    type: Literal["set_time"] = "set_time"


@record
class ResetTime:
    """The Reset button: displays are cleared, and elapsed times begin at zero."""

    type: Literal["reset_time"] = "reset_time"


@record
class WatchClock:
    """A page shows the clocks, or no more."""

    watching: bool
    type: Literal["watch_clock"] = "watch_clock"
