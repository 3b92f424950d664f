"""The timeline: which time of a recording is shown, and control of its playback. Times are seconds since the epoch."""

from __future__ import annotations

from linkwright.viewer.protocol.message import PageMessage, Record, ServerMessage


class TimelineTopic(Record):
    """A topic of a recording, with how many messages it has.

    `counts` are those in equal parts of the recording; empty where that is not known.
    """

    name: str
    kind: str
    count: int
    counts: list[int]


class Timeline(ServerMessage):
    """The recording that is shown: its name, its times and topics.

    With `live` it is what came in the last minutes: it has no name, and `Kept` tells how its ends move on.
    """

    name: str
    start: float
    end: float
    topics: list[TimelineTopic]
    live: bool


class Kept(ServerMessage):
    """The part of the last minutes that is kept: from when to when, its bytes, and how many it may take."""

    start: float
    end: float
    size: int
    most: int


class Playhead(ServerMessage):
    """The position in a recording. While `playing`, sent a few times a second.

    `live` is whether the present is shown, of a timeline of the last minutes.
    `seeks` is how often somebody went to another time: a page whose own has been done goes on to the next.
    `problem` says why it stands still where it cannot be read; else it is empty.
    """

    position: float
    playing: bool
    speed: float
    loop: bool
    seeks: int
    problem: str
    live: bool


class Play(PageMessage):
    """The user has a recording go on, or stand still."""

    playing: bool


class SeekTime(PageMessage):
    """The user goes to a time of a recording."""

    position: float


class StepTime(PageMessage):
    """The user goes to the next message of what is shown, or to the one before; or to that of a single topic."""

    forward: bool
    topic: str = ""


class GoLive(PageMessage):
    """The user goes back from the last minutes to the present."""


class SetPlayback(PageMessage):
    """The user plays a recording slower or faster, once or over and over."""

    speed: float
    loop: bool
