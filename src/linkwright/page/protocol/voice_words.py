"""Words that the user enrolls in the Voice panel.

Each word is recorded three times and stored in a file of the user.
"""

from __future__ import annotations

from typing import ClassVar

from linkwright.page.protocol.message import PageMessage, Record, ServerMessage


class EnrolledWord(Record):
    """A word and its number of recordings."""

    name: str
    takes: int


class WatchWords(PageMessage):
    """Whether the page receives the words, initially and after every change."""

    watched: bool


class BeginTake(PageMessage):
    """The start of the recording of a word.

    The sound until `EndTake` contains the word once, and is not published.
    """

    name: str


class EndTake(PageMessage):
    """The end of the recording of a word.

    Attributes:
        has_gaps: whether some of the sound was lost.
    """

    has_gaps: bool


class RemoveWord(PageMessage):
    """A request to remove an enrolled word."""

    name: str


class RenameWord(PageMessage):
    """A request to rename an enrolled word."""

    name: str
    new_name: str


class ImportWords(PageMessage):
    """A request to import the words of a file.

    An imported word replaces a word with the same name.
    """

    text: str


class RequestWordsFile(PageMessage):
    """A request for the text of the file that contains the words."""


class VoiceWords(ServerMessage):
    """The enrolled words.

    Attributes:
        words: the words, in the order in which they were enrolled.
        enough: the number of recordings that a word needs.
        file: the path of the file in which the words are stored.
        problem: the reason why the file cannot be read or written, or why a request failed.
    """

    words: list[EnrolledWord]
    enough: int
    file: str
    problem: str | None


class TakeJudged(ServerMessage):
    """The assessment of a recording of a word.

    Attributes:
        number: the number of the recording.
        name: the word.
        code: the code of the finding that refused the recording; None if it was accepted.
        text: the text of that finding.
        peak: the peak amplitude, 0 to 1.
        seconds: the duration of the recording, in seconds.
    """

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("number",)

    number: int
    name: str
    code: str | None
    text: str
    peak: float
    seconds: float


class VoiceWordsFile(ServerMessage):
    """The text of the file that contains the words."""

    text: str
