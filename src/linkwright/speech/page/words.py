"""The enrollment of words on a page, with its recordings added to the user's file of words."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, foreign, phrase, translated
from linkwright.files.scratch_folders import ScratchFolder
from linkwright.page.audience import Page
from linkwright.page.protocol.voice_words import (
    BeginTake,
    EndTake,
    EnrolledWord,
    ImportWords,
    RemoveWord,
    RenameWord,
    RequestWordsFile,
    TakeJudged,
    VoiceWords,
    VoiceWordsFile,
    WatchWords,
)
from linkwright.speech.enrolled.enrollment import enroll
from linkwright.speech.enrolled.words import RECOMMENDED_TAKES, Words, find_name_problem, find_words_path
from linkwright.speech.sound.samples import RATE, Samples

_MAX_SAMPLES = 8 * RATE
"""The maximum number of samples of a recording."""


class Recording:
    """The recording of a word, in progress.

    Args:
        name: the name of the word.
    """

    def __init__(self, name: str) -> None:
        self.name = name
        self._blocks: list[Samples] = []
        self._length = 0

    def add(self, samples: Samples) -> None:
        """Append the next block, unless the recording is already too long."""
        if self._length < _MAX_SAMPLES:
            self._blocks.append(samples)
            self._length += samples.size

    @property
    def samples(self) -> Samples:
        """All recorded samples."""
        return np.concatenate([np.zeros(0, np.int16), *self._blocks])


class WordBook:
    """The user's file of words, which pages change and show.

    The file is read again before each change, because other programs also write it.
    """

    def __init__(self) -> None:
        self._watchers: set[Page] = set()
        self._recordings: dict[Page, Recording] = {}
        self._take_count = 0

    def receive(self, page: Page, message: object) -> None:
        """Handle a request of a page."""
        match message:
            case WatchWords(watched=True):
                self._watchers.add(page)
                self._send_words(page)
            case WatchWords():
                self._watchers.discard(page)
            case BeginTake(name=name):
                self._recordings[page] = Recording(name.strip())
            case EndTake(has_gaps=has_gaps):
                self._add_take(page, has_gaps=has_gaps)
            case RemoveWord(name=name):
                self._change_words(page, lambda words: words.remove(name))
            case RenameWord(name=name, new_name=new_name):
                self._change_words(page, lambda words: _rename_word(words, name, new_name.strip()))
            case ImportWords(text=text):
                self._change_words(page, lambda words: _import_words(words, text))
            case RequestWordsFile():
                self._send_file(page)

    def record_sound(self, page: Page, samples: Samples) -> bool:
        """Add sound to the recording of a page, and return whether the page is recording a word."""
        recording = self._recordings.get(page)
        if recording is not None:
            recording.add(samples)
        return recording is not None

    def remove_page(self, page: Page) -> None:
        """Forget a page and its recording."""
        self._watchers.discard(page)
        self._recordings.pop(page, None)

    def _add_take(self, page: Page, *, has_gaps: bool) -> None:
        recording = self._recordings.pop(page, None)
        if recording is None:
            return
        samples = recording.samples
        findings: list[Diagnostic] = []
        if self._change_words(page, lambda words: findings.extend(enroll(words, recording.name, samples, has_gaps))):
            finding = next(iter(translated(findings)), None)
            peak = float(np.max(np.abs(samples.astype(np.int32)), initial=0)) / 32768
            self._take_count += 1
            page.send(
                TakeJudged(
                    self._take_count,
                    recording.name,
                    finding.code if finding else None,
                    str(finding.message) if finding else "",
                    peak,
                    samples.size / RATE,
                )
            )

    def _change_words(self, page: Page, change: Callable[[Words], object]) -> bool:
        """Change the file and send the words to watching pages, or send the reason for a failure.

        Returns:
            Whether the file was changed.
        """
        try:
            words = _read_words()
            change(words)
            words.write(find_words_path())
        except LinkwrightError as error:
            self._send_words(page, _format_error(error))
            return False
        except OSError as error:
            reason = foreign(error.strerror or error)
            self._send_words(
                page, phrase("cannot write '{path}': {reason}", path=display_path(find_words_path()), reason=reason)
            )
            return False
        for watcher in {*self._watchers, page}:
            self._send_words(watcher)
        return True

    def _send_words(self, page: Page, problem: str | None = None) -> None:
        try:
            words = _read_words()
        except LinkwrightError as error:
            words, problem = Words(), problem or _format_error(error)
        enrolled = [EnrolledWord(name, len(words.takes(name))) for name in words.names]
        page.send(VoiceWords(enrolled, RECOMMENDED_TAKES, display_path(find_words_path()), problem))

    def _send_file(self, page: Page) -> None:
        try:
            page.send(VoiceWordsFile(find_words_path().read_text(encoding="utf-8")))
        except (OSError, UnicodeDecodeError):
            self._send_words(page)  # this sends the error, or that there are no words


def _read_words() -> Words:
    """Return the words in the user's file, or no words if there is no file.

    Raises:
        LinkwrightError: VOICE202, the file cannot be read; VOICE203, it is damaged.
    """
    path = find_words_path()
    return Words.read(path) if path.exists() else Words()


def _rename_word(words: Words, name: str, new_name: str) -> None:
    """Rename a word, keeping its takes."""
    reason = find_name_problem(new_name)
    if reason is None and new_name in words.names and new_name != name:
        reason = phrase("a word with this name already exists")
    if reason is not None:
        message = phrase("a word cannot be named '{name}': {reason}", name=new_name, reason=reason)
        raise LinkwrightError(Diagnostic("VOICE204", message))
    takes_by_name = {
        new_name if name_of_word == name else name_of_word: words.takes(name_of_word) for name_of_word in words.names
    }
    for name_of_word, takes in takes_by_name.items():
        words.remove(name_of_word)
        for take in takes:
            words.add(name_of_word, take)
    if new_name != name:
        words.remove(name)


def _import_words(words: Words, text: str) -> None:
    with ScratchFolder("words") as folder:
        path = Path(folder) / "words.json"
        path.write_text(text, encoding="utf-8", errors="replace")
        imported = Words.read(path)
    for name in imported.names:
        words.remove(name)
        for take in imported.takes(name):
            words.add(name, take)


def _format_error(error: LinkwrightError) -> str:
    """Return the message of an error, in the language of the terminal."""
    return str(next(iter(translated(error.diagnostics))).message)
