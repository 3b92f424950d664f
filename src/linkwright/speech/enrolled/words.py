"""The file of enrolled words: spectra of their recordings, from which the voice cannot be played back.

The file is JSON, version 1: ``{"format": "linkwright enrolled words", "version": 1, "words": [...]}``, with words of
the form ``{"name": "stop", "takes": [{"frames": BASE64, "noise": BASE64}, ...]}``. ``frames`` contains the bands of
`linkwright.speech.sound.spectra` from the first to the last frame of the word, frame after frame, one byte each: the
level in steps of 0.5 dB above a power of 1. ``noise`` is the level of the take's background, one byte per band.
"""

from __future__ import annotations

import base64
import binascii
import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, display_path, foreign, missing_file_hint, phrase
from linkwright.diagnostics.diagnostic import Span
from linkwright.files.input_files import read_text
from linkwright.files.user_folders import config_folder
from linkwright.files.whole_files import write_whole_file
from linkwright.speech.sound.spectra import BANDS, Powers

TAKES = 3
"""The number of takes of a word; it is recognised from the first on, but less surely."""

MOST_TAKES = 10
MOST_WORDS = 200

_FORMAT, _VERSION = "linkwright enrolled words", 1
_STEP = 0.5  # dB
_LONGEST_NAME = 100
_MOST_FRAMES = 400


def words_path() -> Path:
    """Return the path of the user's file.

    It is ``XDG_CONFIG_HOME/linkwright/voice/words.json``, or the same path below ``~/.config``.
    """
    return config_folder() / "voice" / "words.json"


@dataclass(frozen=True, slots=True)
class Take:
    """One recording of a word.

    Attributes:
        powers: the powers of the frames of the word.
        noise: the power of the background, shape ``(BANDS,)``.
    """

    powers: Powers
    noise: NDArray[np.float64]


class Words:
    """The words of a user, in the order in which they were enrolled.

    >>> words = Words()
    >>> for samples in said: findings = words.enrol("stop", samples)
    >>> words.write(words_path())
    """

    def __init__(self, takes: Mapping[str, tuple[Take, ...]] | None = None) -> None:
        self._takes = dict(takes or {})

    @property
    def names(self) -> tuple[str, ...]:
        """The phrases of the words."""
        return tuple(self._takes)

    def takes(self, name: str) -> tuple[Take, ...]:
        """Return the takes of a word; empty for an unknown word."""
        return self._takes.get(name, ())

    def add(self, name: str, take: Take) -> None:
        """Add a take; the oldest take is removed if there are more than `MOST_TAKES`."""
        self._takes[name] = (*self.takes(name), take)[-MOST_TAKES:]

    def remove(self, name: str) -> None:
        """Remove a word with all of its takes; an unknown word is ignored."""
        self._takes.pop(name, None)

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Words:
        """Read the words from a file.

        Raises:
            LinkwrightError: VOICE202, it cannot be read; VOICE203, it is not a file of words, or it is damaged.
        """
        shown = display_path(Path(path))
        try:
            text = read_text(path)
        except OSError as error:
            message = phrase("cannot read '{path}': {reason}", path=shown, reason=foreign(error.strerror))
            raise LinkwrightError(Diagnostic("VOICE202", message, hint=missing_file_hint(Path(path)))) from None
        except UnicodeDecodeError:
            raise _damaged(shown, phrase("it is not a text file")) from None
        try:
            document = json.loads(text)
        except json.JSONDecodeError as error:
            place = Span(shown, error.lineno, error.colno, error.lineno, error.colno)
            raise _damaged(shown, phrase("it is not JSON: {reason}", reason=foreign(error.msg)), place) from None
        except RecursionError:
            raise _damaged(shown, phrase("it is nested too deeply")) from None
        return cls(_words(document, shown))

    def write(self, path: str | os.PathLike[str]) -> None:
        """Write the file atomically; its folder is created if it is missing.

        Raises:
            OSError: it cannot be written.
        """
        Path(path).parent.mkdir(parents=True, exist_ok=True)
        words = [
            {
                "name": name,
                "takes": [{"frames": _encoded(take.powers), "noise": _encoded(take.noise)} for take in takes],
            }
            for name, takes in self._takes.items()
        ]
        document = {"format": _FORMAT, "version": _VERSION, "words": words}
        write_whole_file(path, json.dumps(document, ensure_ascii=False, indent=1) + "\n")


def name_problem(name: str) -> Phrase | None:
    """Return the reason why a word cannot have a name, or None if the name is valid."""
    if not name.strip():
        return phrase("it is empty")
    if len(name) > _LONGEST_NAME:
        return phrase("it has more than {most} characters", most=_LONGEST_NAME)
    if not name.isprintable():
        return phrase("it contains characters that cannot be shown")
    return None


def rounded(powers: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return powers rounded as in a file."""
    return _decoded(_levels(powers)).reshape(powers.shape)


def _levels(powers: NDArray[np.float64]) -> NDArray[np.uint8]:
    decibels = 10.0 * np.log10(np.maximum(powers, 1.0))
    return np.asarray(np.clip(np.rint(decibels / _STEP), 0, 255), dtype=np.uint8)


def _decoded(levels: NDArray[np.uint8]) -> NDArray[np.float64]:
    return np.asarray(10.0 ** (levels.astype(np.float64) * _STEP / 10.0))


def _encoded(powers: NDArray[np.float64]) -> str:
    return base64.b64encode(_levels(powers).tobytes()).decode("ascii")


def _words(document: Any, shown: str) -> dict[str, tuple[Take, ...]]:
    if not isinstance(document, dict) or document.get("format") != _FORMAT:
        raise _damaged(shown, phrase("it is not marked as a file of enrolled words"))
    if document.get("version") != _VERSION:
        version = document.get("version")
        raise _damaged(
            shown, phrase("it has version '{version}', but only {known} is supported", version=version, known=_VERSION)
        )
    words = document.get("words")
    if not isinstance(words, list) or len(words) > MOST_WORDS:
        raise _damaged(shown, phrase("it contains no list of words, or more than {most}", most=MOST_WORDS))
    found: dict[str, tuple[Take, ...]] = {}
    for number, word in enumerate(words, 1):
        name = word.get("name") if isinstance(word, dict) else None
        if not isinstance(name, str) or name_problem(name) is not None or name in found:
            raise _damaged(shown, phrase("word {number} has no name, or the name of an earlier word", number=number))
        takes = word.get("takes")
        if not isinstance(takes, list) or not 1 <= len(takes) <= MOST_TAKES:
            raise _damaged(
                shown, phrase("the word '{name}' has no takes, or more than {most}", name=name, most=MOST_TAKES)
            )
        found[name] = tuple(_read_take(take, name, shown) for take in takes)
    return found


def _read_take(take: Any, name: str, shown: str) -> Take:
    try:
        frames, noise = (
            np.frombuffer(base64.b64decode(take[key], validate=True), np.uint8) for key in ("frames", "noise")
        )
    except (TypeError, KeyError, ValueError, binascii.Error):
        raise _damaged(shown, phrase("a take of the word '{name}' cannot be decoded", name=name)) from None
    count = len(frames) // BANDS
    if len(frames) % BANDS or not 1 <= count <= _MOST_FRAMES or len(noise) != BANDS:
        raise _damaged(shown, phrase("a take of the word '{name}' has the wrong length", name=name))
    return Take(_decoded(frames).reshape(count, BANDS), _decoded(noise))


def _damaged(shown: str, why: Phrase, place: Span | None = None) -> LinkwrightError:
    message = phrase("'{path}' cannot be read as a file of enrolled words: {why}", path=shown, why=why)
    hint = phrase("replace it with a copy, or remove it and enrol the words again")
    return LinkwrightError(Diagnostic("VOICE203", message, place, hint=hint))
