"""Time: the Time panel, the timeline, and recording. Times are in seconds since the epoch."""

from __future__ import annotations

from typing import Literal

from linkwright.page.protocol.message import PageMessage, Record, ServerMessage


class TimelineTopic(Record):
    """A topic of a recording, with the number of its messages.

    `counts` are the numbers of messages in equal intervals of the recording. The list is empty if they are unknown.
    """

    name: str
    kind: str
    count: int
    counts: list[int]


class Timeline(ServerMessage):
    """The displayed recording: its name, its start and end, and its topics.

    Start and end are in seconds. If `live` is true, the timeline covers the last minutes. It then has no name, and
    `HistoryExtent` contains its changing start and end.
    """

    name: str
    start: float
    end: float
    topics: list[TimelineTopic]
    live: bool


class HistoryExtent(ServerMessage):
    """The extent of the stored last minutes: start, end, size and maximum size in bytes."""

    start: float
    end: float
    size: int
    max_size: int


class Playhead(ServerMessage):
    """The position in a recording, sent a few times per second while `playing`.

    `live` is whether the present is shown, in a timeline of the last minutes. `seeks` counts the seeks of all users, so
    that a page can wait until its previous seek is done. `problem` is the reason why the recording cannot be read
    further, or empty.
    """

    position: float
    playing: bool
    speed: float
    loop: bool
    seeks: int
    problem: str
    live: bool


class Play(PageMessage):
    """A request to resume or pause playback."""

    playing: bool


class SeekTime(PageMessage):
    """A request to jump to a time of a recording."""

    position: float


class StepTime(PageMessage):
    """A request to jump to the next or previous message of the displayed topics or of one topic."""

    forward: bool
    topic: str = ""


class GoLive(PageMessage):
    """A request to show the present again instead of the last minutes."""


class SetPlayback(PageMessage):
    """The speed of playback, and whether playback repeats."""

    speed: float
    loop: bool


class RecordedFile(Record):
    """A completed recording: path on the server, size in bytes, length in s, download address.

    `simulated` is the simulated duration in seconds. It is None if time is not simulated, or the duration is unknown.
    """

    name: str
    path: str
    size: int
    length: float
    url: str
    simulated: float | None = None


class RecordingState(ServerMessage):
    """The state of recording, sent to all pages on changes and every second during a recording.

    `possible` is false while a recording is shown. `path` is the path of the recording being written, empty if there is
    none. `length` is in seconds, `size` in bytes. `saved` is the fraction of the last minutes that is already written,
    or None if they are not being saved. `problem` is the reason why the last recording failed or ended early.
    `files` are the recordings that this program has made, newest first.
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
    """A request to record topics. An empty list means all present and future topics."""

    topics: list[str]


class StopRecording(PageMessage):
    """A request to stop the recording."""


class SaveMinutes(PageMessage):
    """A request to save the last minutes, or only the messages between two times."""

    start: float | None
    end: float | None


SyncMode = Literal["Off", "Exact", "Approximate"]


class TimeState(ServerMessage):
    """The state of the Time panel, sent on changes.

    `sources` are the displays whose messages can drive time.
    """

    paused: bool
    mode: SyncMode
    source: str
    sources: list[str]


class Clock(ServerMessage):
    """The current clocks in seconds, for pages that watch them.

    `ros_start` and `wall_start` are the times from which elapsed times are counted. If `running` is true, ROS time
    advances at the speed of the wall clock, and the page advances it. Other clocks are sent again when they have
    changed.
    """

    ros: float
    ros_start: float
    wall: float
    wall_start: float
    running: bool


class TimeReset(ServerMessage):
    """The notice that time was reset and displays have discarded their messages."""


class SetTime(PageMessage):
    """A request to pause or resume time, or to synchronize it with a display's messages."""

    paused: bool
    mode: SyncMode
    source: str


class ResetTime(PageMessage):
    """A press of the Reset button: displays are cleared, and elapsed times restart at zero."""


class WatchClock(PageMessage):
    """Whether the page receives the clocks from now on."""

    watching: bool
