"""The engine ``enrolled``: recognizes words in any language that the user has recorded."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Diagnostic, LinkwrightError, Severity, display_path, phrase
from linkwright.speech.commands.numbers import has_number
from linkwright.speech.commands.words import split_into_words
from linkwright.speech.engine import EngineOptions, Heard, SpeechEngine
from linkwright.speech.enrolled.recognition import ACCEPTED_CONFIDENCE, Guess, Recognizer
from linkwright.speech.enrolled.words import Words, find_words_path
from linkwright.speech.sound.activity import VoiceActivity, estimate_unsteady_noise
from linkwright.speech.sound.samples import RATE, Samples
from linkwright.speech.sound.spectra import BANDS, HOP_LENGTH, MelFrames, Powers

_LEAD_IN_FRAMES = 20  # the number of frames before the start of speech, because a word starts softly
_NOISE_FRAMES = 30  # the number of earlier frames, which are used only to measure the noise
_MATCH_INTERVAL_FRAMES = 5  # the number of new frames after which an utterance is matched again
_MAX_LENGTH_FACTOR = 2.5  # the maximum length of a word, as a multiple of the longest take
_MIN_NEAREST_CONFIDENCE = 0.1
"""The minimum confidence of a word that is reported as the nearest.

Most words that are missed in noise reach it, and so does one of twenty other words.
"""
_MIN_NUMBER_CONFIDENCE = 0.7
"""The minimum confidence of a phrase with a number, because other numbers differ in only one short word."""


class EnrolledEngine(SpeechEngine):
    """An engine that recognizes enrolled words by comparing utterances with their recordings.

    The file can appear, change and disappear at run time: it is checked with each block of samples.

    Args:
        options: `model` is the file of words; None for `find_words_path`. Only words that are also phrases are
            recognized; the other words help to reject sound. Case and surrounding spaces are ignored.

    Raises:
        LinkwrightError: the file exists but cannot be read; see `Words.read`.
    """

    def __init__(self, options: EngineOptions) -> None:
        self._path = options.model or find_words_path()
        self._phrases = {_normalize(text): text for text in options.phrases}
        self._file_stamp = _read_stamp(self._path)
        self._problem: Diagnostic | None = None
        self._recognizer: Recognizer | None = None
        if self._file_stamp is not None:
            self._use_words(Words.read(self._path))
        else:
            self._report_nothing_enrolled()
        self._frames = MelFrames()
        self._activity = VoiceActivity()
        self._noise_frames: Powers = np.zeros((0, BANDS))
        self._buffer: Powers = np.zeros((0, BANDS))
        self._frame_count = 0
        self._last_match_frame = 0
        self._partial: str | None = None

    @property
    def problem(self) -> Diagnostic | None:
        """The reason why the engine recognizes less than it should, or None if it works fully.

        VOICE201, none of the phrases is enrolled; VOICE202 or VOICE203, the changed file is damaged.
        """
        return self._problem

    def hear(self, samples: Samples) -> Sequence[Heard]:
        """Process samples.

        A word becomes a partial result in the block in which it ends.
        """
        self._reload_if_changed()
        results: list[Heard] = []
        for frame in self._frames.feed(samples):
            was_speaking = self._activity.speaking
            is_speaking = self._activity.step(frame)
            self._frame_count += 1
            self._store_frame(frame, is_speaking or was_speaking)
            if was_speaking and not is_speaking:
                results += self._end_utterance()
        if self._activity.speaking and self._frame_count - self._last_match_frame >= _MATCH_INTERVAL_FRAMES:
            results += self._make_partial_result()
        return results

    def finish(self) -> Sequence[Heard]:
        """End the utterance, and return its final results."""
        return self._end_utterance() if self._activity.speaking else []

    def _store_frame(self, frame: NDArray[np.float64], is_speech: bool) -> None:
        max_frames = self._max_frames() if is_speech else _LEAD_IN_FRAMES
        frames = np.concatenate((self._buffer, frame[None]))
        if len(frames) > max_frames:
            self._noise_frames = np.concatenate((self._noise_frames, frames[:-max_frames]))[-_NOISE_FRAMES:]
        self._buffer = frames[-max_frames:]

    def _max_frames(self) -> int:
        longest = self._recognizer.longest if self._recognizer is not None else 100
        return int(_MAX_LENGTH_FACTOR * longest) + 2 * _LEAD_IN_FRAMES

    def _make_partial_result(self) -> list[Heard]:
        """Return the partial result of an utterance if it has changed, else an empty list."""
        self._last_match_frame = self._frame_count
        guess = self._recognize()
        name = self._find_phrase(guess)
        if guess is None or name is None or name == self._partial:
            return []
        self._partial = name
        return [self._make_result(name, guess, final=False)]

    def _end_utterance(self) -> list[Heard]:
        """End the utterance, and return its final result in a list."""
        guess = self._recognize()
        self._activity.end()
        name = self._find_phrase(guess)
        self._partial = None
        result = self._make_result(name or "", guess, final=True)
        self._buffer, self._noise_frames = self._buffer[-_LEAD_IN_FRAMES:], self._noise_frames[:0]
        return [result]

    def _recognize(self) -> Guess | None:
        if self._recognizer is None:
            return None
        noise = estimate_unsteady_noise(np.concatenate((self._noise_frames, self._buffer)), self._activity.floor)
        if noise is None and len(self._buffer) >= self._max_frames():
            return None
        return self._recognizer.guess(self._buffer, self._activity.floor if noise is None else noise)

    def _find_phrase(self, guess: Guess | None) -> str | None:
        """Return the phrase of a guess, or None if the guess is too uncertain or not a phrase."""
        if guess is None:
            return None
        if guess.confidence < (
            _MIN_NUMBER_CONFIDENCE if has_number(split_into_words(guess.name)) else ACCEPTED_CONFIDENCE
        ):
            return None
        return self._phrases.get(_normalize(guess.name))

    def _make_result(self, name: str, guess: Guess | None, *, final: bool) -> Heard:
        buffer_start = self._frame_count - len(self._buffer)
        first, last = (guess.first, guess.last + 1) if guess is not None else (0, len(self._buffer))
        confidence = guess.confidence if guess is not None and name else 0.0
        is_near = guess is not None and not name and guess.confidence >= _MIN_NEAREST_CONFIDENCE
        nearest = self._phrases.get(_normalize(guess.name), "") if guess is not None and is_near else ""
        return Heard(
            name,
            confidence,
            final,
            (buffer_start + first) * HOP_LENGTH / RATE,
            (buffer_start + last) * HOP_LENGTH / RATE,
            nearest,
        )

    def _reload_if_changed(self) -> None:
        stamp = _read_stamp(self._path)
        if stamp == self._file_stamp:
            return
        self._file_stamp = stamp
        if stamp is None:
            self._recognizer = None
            self._report_nothing_enrolled()
            return
        try:
            self._use_words(Words.read(self._path))
        except LinkwrightError as error:
            self._problem = error.diagnostics[0]

    def _use_words(self, words: Words) -> None:
        self._problem = None
        self._recognizer = Recognizer(words) if words.names else None
        if self._recognizer is not None:
            self._recognizer.prepare()
        if not self._phrases.keys() & {_normalize(name) for name in words.names}:
            self._report_nothing_enrolled()

    def _report_nothing_enrolled(self) -> None:
        message = phrase("none of the phrases is enrolled in '{path}'", path=display_path(self._path))
        hint = phrase("enroll words on the page, or with 'linkwright voice enroll'")
        self._problem = Diagnostic("VOICE201", message, severity=Severity.WARNING, hint=hint)


def _normalize(name: str) -> str:
    return " ".join(name.casefold().split())


def _read_stamp(path: Path) -> tuple[int, int, int] | None:
    """Return a value that changes when a file is written, or None if there is no file."""
    with suppress(OSError):
        status = path.stat()
        return status.st_mtime_ns, status.st_size, status.st_ino
    return None
