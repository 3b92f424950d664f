"""Words that the user enrols in the Voice panel: recorded three times each, and stored in a file of the user's."""

from __future__ import annotations

from typing import ClassVar

from linkwright.page.protocol.message import PageMessage, Record, ServerMessage


class EnrolledWord(Record):
    """A word and the number of its takes."""

    name: str
    takes: int


class WatchWords(PageMessage):
    """Start or stop sending the words, now and whenever they change."""

    watched: bool


class BeginTake(PageMessage):
    """Start a take: the sound until `EndTake` is a word, said once; it is not published."""

    name: str


class EndTake(PageMessage):
    """End the take.

    Attributes:
        has_gaps: whether some of the sound was lost.
    """

    has_gaps: bool


class RemoveWord(PageMessage):
    """Remove a word."""

    name: str


class RenameWord(PageMessage):
    """Rename a word."""

    name: str
    new_name: str


class ImportWords(PageMessage):
    """Import the words of a file; they replace words of the same names."""

    text: str


class AskWordsFile(PageMessage):
    """Ask for the file of the words."""


class VoiceWords(ServerMessage):
    """The words.

    Attributes:
        words: in the order in which they were enrolled.
        enough: the number of takes that a word needs.
        file: the file in which they are stored.
        problem: why the file cannot be read or written, or a request failed.
    """

    words: list[EnrolledWord]
    enough: int
    file: str
    problem: str | None


class TakeJudged(ServerMessage):
    """The outcome of a take.

    Attributes:
        number: counts the recordings.
        name: the word.
        code: the code of the finding for which it was refused; None when it was accepted.
        text: the text of that finding.
        peak: the loudest sample, 0 to 1.
        seconds: the length of the recording.
    """

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("number",)

    number: int
    name: str
    code: str | None
    text: str
    peak: float
    seconds: float


class VoiceWordsFile(ServerMessage):
    """The text of the file of words."""

    text: str
