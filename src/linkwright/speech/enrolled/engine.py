"""The engine ``enrolled``: words that the user has recorded three times each, in any language, without a model."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Diagnostic, LinkwrightError, Severity, display_path, phrase
from linkwright.speech.commands.numbers import has_number
from linkwright.speech.commands.words import words_of
from linkwright.speech.engine import EngineOptions, Heard, SpeechEngine
from linkwright.speech.enrolled.recognition import ACCEPTED, Guess, Recogniser
from linkwright.speech.enrolled.words import Words, words_path
from linkwright.speech.sound.activity import VoiceActivity, unsteady_noise
from linkwright.speech.sound.samples import RATE, Samples
from linkwright.speech.sound.spectra import BANDS, HOP, MelFrames, Powers

_BEFORE = 20  # frames before the start of speech that are included, because a word starts softly
_EARLIER = 30  # earlier frames, used only to measure the noise
_STEP = 5  # number of new frames after which an utterance is matched again
_TOO_LONG = 2.5  # times the longest take: longer utterances are not words
_NEAR = 0.1
"""The confidence from which a word is reported as the nearest: most missed words in noise have it, and one of twenty
other words.
"""
_OF_A_NUMBER = 0.7
"""Confidence from which a phrase with a number counts: other numbers make phrases that differ in one short word."""


class EnrolledEngine(SpeechEngine):
    """Compares each utterance with the enrolled words.

    The file may appear, change and disappear at run time: it is checked with each block.

    Args:
        options: `model` is the file of words, or `words_path` if it is None. Only words that are among the phrases are
            recognized; the others help to reject sound. Case and surrounding spaces are ignored.

    Raises:
        LinkwrightError: the file exists but cannot be read, see `Words.read`.
    """

    def __init__(self, options: EngineOptions) -> None:
        self._path = options.model or words_path()
        self._phrases = {_plain(text): text for text in options.phrases}
        self._stamp = _stamp(self._path)
        self._problem: Diagnostic | None = None
        self._recogniser: Recogniser | None = None
        if self._stamp is not None:
            self._use(Words.read(self._path))
        else:
            self._nothing_enrolled()
        self._frames = MelFrames()
        self._activity = VoiceActivity()
        self._earlier: Powers = np.zeros((0, BANDS))
        self._buffer: Powers = np.zeros((0, BANDS))
        self._seen = 0
        self._looked = 0
        self._partial: str | None = None

    @property
    def problem(self) -> Diagnostic | None:
        """The reason why the engine recognises less than it should, or None.

        VOICE201, no enrolled word is used; VOICE202, VOICE203, the file was changed and is damaged.
        """
        return self._problem

    def hear(self, samples: Samples) -> Sequence[Heard]:
        """Process a block; a word becomes a partial result with the block in which it ends."""
        self._follow_file()
        heard: list[Heard] = []
        for frame in self._frames.feed(samples):
            spoke = self._activity.speaking
            speaks = self._activity.step(frame)
            self._seen += 1
            self._store(frame, speaks or spoke)
            if spoke and not speaks:
                heard += self._end()
        if self._activity.speaking and self._seen - self._looked >= _STEP:
            heard += self._partial_result()
        return heard

    def finish(self) -> Sequence[Heard]:
        """End the utterance, and return its final results."""
        return self._end() if self._activity.speaking else []

    def _store(self, frame: NDArray[np.float64], speech: bool) -> None:
        most = self._most() if speech else _BEFORE
        kept = np.concatenate((self._buffer, frame[None]))
        if len(kept) > most:
            self._earlier = np.concatenate((self._earlier, kept[:-most]))[-_EARLIER:]
        self._buffer = kept[-most:]

    def _most(self) -> int:
        longest = self._recogniser.longest if self._recogniser is not None else 100
        return int(_TOO_LONG * longest) + 2 * _BEFORE

    def _partial_result(self) -> list[Heard]:
        """Return the partial result of an utterance if it has changed, otherwise an empty list."""
        self._looked = self._seen
        guess = self._guess()
        name = self._name(guess)
        if guess is None or name is None or name == self._partial:
            return []
        self._partial = name
        return [self._result(name, guess, final=False)]

    def _end(self) -> list[Heard]:
        """End the utterance, and return its final result."""
        guess = self._guess()
        self._activity.end()
        name = self._name(guess)
        self._partial = None
        heard = self._result(name or "", guess, final=True)
        self._buffer, self._earlier = self._buffer[-_BEFORE:], self._earlier[:0]
        return [heard]

    def _guess(self) -> Guess | None:
        if self._recogniser is None:
            return None
        noise = unsteady_noise(np.concatenate((self._earlier, self._buffer)), self._activity.floor)
        if noise is None and len(self._buffer) >= self._most():
            return None
        return self._recogniser.guess(self._buffer, self._activity.floor if noise is None else noise)

    def _name(self, guess: Guess | None) -> str | None:
        """Return the recognised phrase, or None."""
        if guess is None:
            return None
        if guess.confidence < (_OF_A_NUMBER if has_number(words_of(guess.name)) else ACCEPTED):
            return None
        return self._phrases.get(_plain(guess.name))

    def _result(self, name: str, guess: Guess | None, *, final: bool) -> Heard:
        begin = self._seen - len(self._buffer)
        first, last = (guess.first, guess.last + 1) if guess is not None else (0, len(self._buffer))
        confidence = guess.confidence if guess is not None and name else 0.0
        is_near = guess is not None and not name and guess.confidence >= _NEAR
        nearest = self._phrases.get(_plain(guess.name), "") if guess is not None and is_near else ""
        return Heard(name, confidence, final, (begin + first) * HOP / RATE, (begin + last) * HOP / RATE, nearest)

    def _follow_file(self) -> None:
        stamp = _stamp(self._path)
        if stamp == self._stamp:
            return
        self._stamp = stamp
        if stamp is None:
            self._recogniser = None
            self._nothing_enrolled()
            return
        try:
            self._use(Words.read(self._path))
        except LinkwrightError as error:
            self._problem = error.diagnostics[0]

    def _use(self, words: Words) -> None:
        self._problem = None
        self._recogniser = Recogniser(words) if words.names else None
        if self._recogniser is not None:
            self._recogniser.prepare()
        if not self._phrases.keys() & {_plain(name) for name in words.names}:
            self._nothing_enrolled()

    def _nothing_enrolled(self) -> None:
        message = phrase("none of the phrases is enrolled in '{path}'", path=display_path(self._path))
        hint = phrase("enrol words on the page, or with 'linkwright voice enrol'")
        self._problem = Diagnostic("VOICE201", message, severity=Severity.WARNING, hint=hint)


def _plain(name: str) -> str:
    return " ".join(name.casefold().split())


def _stamp(path: Path) -> tuple[int, int, int] | None:
    """Return a value that changes when a file is written; None if there is no file."""
    with suppress(OSError):
        facts = path.stat()
        return facts.st_mtime_ns, facts.st_size, facts.st_ino
    return None
