"""The timeline: the time of a recording that is shown, and playback control. Times are seconds since the epoch."""

from __future__ import annotations

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
