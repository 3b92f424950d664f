"""Time: the Time panel, the timeline of a recording that is shown, and recording. Times are seconds since the epoch."""

from __future__ import annotations

from typing import Literal

from linkwright.page.protocol.message import PageMessage, Record, ServerMessage


class TimelineTopic(Record):
    """A topic of a recording, with the number of its messages.

    `counts` are those in equal parts of the recording; empty if unknown.
    """

    name: str
    kind: str
    count: int
    counts: list[int]


class Timeline(ServerMessage):
    """The recording that is shown: its name, its times and topics.

    With `live` it is the history of the last minutes: it has no name, and `HistoryExtent` reports how its ends move.
    """

    name: str
    start: float
    end: float
    topics: list[TimelineTopic]
    live: bool


class HistoryExtent(ServerMessage):
    """The stored part of the last minutes: its first and last time, its bytes, and their limit."""

    start: float
    end: float
    size: int
    most: int


class Playhead(ServerMessage):
    """The position in a recording. While `playing`, sent a few times a second.

    `live` is whether the present is shown, of a timeline of the last minutes.
    `seeks` counts the seeks of all users: a page whose own seek is done proceeds to its next one.
    `problem` is why playback stopped if the recording cannot be read; else it is empty.
    """

    position: float
    playing: bool
    speed: float
    loop: bool
    seeks: int
    problem: str
    live: bool


class Play(PageMessage):
    """The user resumes or pauses a recording."""

    playing: bool


class SeekTime(PageMessage):
    """The user goes to a time of a recording."""

    position: float


class StepTime(PageMessage):
    """The user goes to the next message that is shown, or to the one before; or to that of a single topic."""

    forward: bool
    topic: str = ""


class GoLive(PageMessage):
    """The user goes back from the last minutes to the present."""


class SetPlayback(PageMessage):
    """The user changes the speed of playback, or whether it repeats."""

    speed: float
    loop: bool


class RecordedFile(Record):
    """A finished recording: its file on the server, bytes, seconds, and its address for pages.

    `simulated` are the seconds that passed in the simulation meanwhile; None where time is not simulated, or not known.
    """

    name: str
    path: str
    size: int
    length: float
    url: str
    simulated: float | None = None


class RecordingState(ServerMessage):
    """The state of recording, for all pages; sent each second while there is a recording.

    `possible` is false while a recording is shown. `path` is that of the recording being written, empty if there is
    none; `length` are seconds, `size` bytes. `saved` is the written part of the last minutes, null if none is.
    `problem` is why the last recording failed or ended early. `files` are those of this program, the last first.
    """

    possible: bool
    path: str
    length: float
    size: int
    saved: float | None
    problem: str
    files: list[RecordedFile]


NOTHING_RECORDED = RecordingState(possible=True, path="", length=0.0, size=0, saved=None, problem="", files=[])


class RecordTopics(PageMessage):
    """The user records topics; without any, all present and future ones."""

    topics: list[str]


class StopRecording(PageMessage):
    """The user stops the recording."""


class SaveMinutes(PageMessage):
    """The user saves the last minutes, or the part between two times, seconds since the epoch."""

    start: float | None
    end: float | None


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
