"""Recording from pages: what topics carry from now on, and what came in the last minutes, as files of the server."""

from __future__ import annotations

from linkwright.viewer.protocol.message import PageMessage, Record, ServerMessage


class RecordedFile(Record):
    """A recording that was made: its file on the server, bytes, seconds, and where pages can fetch it.

    `simulated` are the seconds that passed in the simulation meanwhile; None where time is not simulated, or not known.
    """

    name: str
    path: str
    size: int
    length: float
    url: str
    simulated: float | None = None


class RecordingState(ServerMessage):
    """Whether something is recorded, which all pages see; told each second meanwhile.

    `possible` is false beside a recording that is shown. `path` is that of what is being written, empty where nothing
    is; `length` are seconds, `size` bytes. `saved` is the part of the last minutes that is written, null while none is.
    `problem` says why the last one could not be made or ended early. `files` are those of this program, the last first.
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
    """The user has topics recorded; without any, all that there are and those to come."""

    topics: list[str]


class StopRecording(PageMessage):
    """The user ends what is being recorded."""


class SaveMinutes(PageMessage):
    """The user has the last minutes saved, or the part between two times, seconds since the epoch."""

    start: float | None
    end: float | None
