"""Recording from pages: the messages of topics from now on, or of the last minutes, as files of the server."""

from __future__ import annotations

from linkwright.page.protocol.message import PageMessage, Record, ServerMessage


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
