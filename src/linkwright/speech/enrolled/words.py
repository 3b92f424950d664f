"""The file of enrolled words: the spectra of their recordings.

The voice cannot be played back from this file. The file is JSON, version 1: ``{"format": "linkwright enrolled words",
"version": 1, "words": [...]}``, with words of the form ``{"name": "stop", "takes": [{"frames": BASE64, "noise":
BASE64}, ...]}``. ``frames`` contains the bands of `linkwright.speech.sound.spectra` from the first to the last frame of
the word, frame after frame, one byte each: the level in steps of 0.5 dB above a power of 1. ``noise`` is the level of
the take's background, one byte per band.
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

RECOMMENDED_TAKES = 3
"""The recommended number of takes of a word. With fewer takes, a word is recognized with less confidence."""

MAX_TAKES = 10
MAX_WORDS = 200

_FORMAT, _VERSION = "linkwright enrolled words", 1
_LEVEL_STEP_DB = 0.5  # the resolution of stored levels, in dB
_MAX_NAME_LENGTH = 100
_MAX_FRAMES = 400


def find_words_path() -> Path:
    """Return the path of the user's file of words.

    It is ``XDG_CONFIG_HOME/linkwright/voice/words.json``, or the same path below ``~/.config``.
    """
    return config_folder() / "voice" / "words.json"


@dataclass(frozen=True, slots=True)
class Take:
    """One recording of a word.

    Attributes:
        powers: the powers of the frames of the word, shape ``(frames, BANDS)``.
        noise: the power of the background in each band, shape ``(BANDS,)``.
    """

    powers: Powers
    noise: NDArray[np.float64]


class Words:
    """The words of a user, in the order of enrollment.

    >>> words = Words()
    >>> for samples in recordings: findings = enroll(words, "stop", samples)  # see `enrollment`
    >>> words.write(words_path())
    """

    def __init__(self, takes: Mapping[str, tuple[Take, ...]] | None = None) -> None:
        self._takes = dict(takes or {})

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the words."""
        return tuple(self._takes)

    def takes(self, name: str) -> tuple[Take, ...]:
        """Return the takes of a word, or an empty tuple if there is no such word."""
        return self._takes.get(name, ())

    def add(self, name: str, take: Take) -> None:
        """Add a take of a word, and remove the oldest take if there are more than `MAX_TAKES`."""
        self._takes[name] = (*self.takes(name), take)[-MAX_TAKES:]

    def remove(self, name: str) -> None:
        """Remove a word with all of its takes, if it exists."""
        self._takes.pop(name, None)

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Words:
        """Read the words from a file.

        Raises:
            LinkwrightError: VOICE202, the file cannot be read; VOICE203, it is damaged or not a file of words.
        """
        path_text = display_path(Path(path))
        try:
            text = read_text(path)
        except OSError as error:
            message = phrase("cannot read '{path}': {reason}", path=path_text, reason=foreign(error.strerror))
            raise LinkwrightError(Diagnostic("VOICE202", message, hint=missing_file_hint(Path(path)))) from None
        except UnicodeDecodeError:
            raise _damaged_error(path_text, phrase("it is not a text file")) from None
        try:
            document = json.loads(text)
        except json.JSONDecodeError as error:
            span = Span(path_text, error.lineno, error.colno, error.lineno, error.colno)
            raise _damaged_error(
                path_text, phrase("it is not JSON: {reason}", reason=foreign(error.msg)), span
            ) from None
        except RecursionError:
            raise _damaged_error(path_text, phrase("it is nested too deeply")) from None
        return cls(_parse_words(document, path_text))

    def write(self, path: str | os.PathLike[str]) -> None:
        """Write a file atomically, and create its folder if it is missing.

        Raises:
            OSError: the file cannot be written.
        """
        Path(path).parent.mkdir(parents=True, exist_ok=True)
        words = [
            {
                "name": name,
                "takes": [{"frames": _encode(take.powers), "noise": _encode(take.noise)} for take in takes],
            }
            for name, takes in self._takes.items()
        ]
        document = {"format": _FORMAT, "version": _VERSION, "words": words}
        write_whole_file(path, json.dumps(document, ensure_ascii=False, indent=1) + "\n")


def find_name_problem(name: str) -> Phrase | None:
    """Return the reason why a word cannot have a name, or None if the name is valid."""
    if not name.strip():
        return phrase("it is empty")
    if len(name) > _MAX_NAME_LENGTH:
        return phrase("it has more than {maximum} characters", maximum=_MAX_NAME_LENGTH)
    if not name.isprintable():
        return phrase("it contains non-printable characters")
    return None


def round_powers(powers: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return powers with the precision that they have in a file."""
    return _from_levels(_to_levels(powers)).reshape(powers.shape)


def _to_levels(powers: NDArray[np.float64]) -> NDArray[np.uint8]:
    decibels = 10.0 * np.log10(np.maximum(powers, 1.0))
    return np.asarray(np.clip(np.rint(decibels / _LEVEL_STEP_DB), 0, 255), dtype=np.uint8)


def _from_levels(levels: NDArray[np.uint8]) -> NDArray[np.float64]:
    return np.asarray(10.0 ** (levels.astype(np.float64) * _LEVEL_STEP_DB / 10.0))


def _encode(powers: NDArray[np.float64]) -> str:
    return base64.b64encode(_to_levels(powers).tobytes()).decode("ascii")


def _parse_words(document: Any, path_text: str) -> dict[str, tuple[Take, ...]]:
    if not isinstance(document, dict) or document.get("format") != _FORMAT:
        raise _damaged_error(path_text, phrase("it is not marked as a file of enrolled words"))
    if document.get("version") != _VERSION:
        version = document.get("version")
        raise _damaged_error(
            path_text,
            phrase(
                "its version is '{version}', but only version {known} is supported", version=version, known=_VERSION
            ),
        )
    words = document.get("words")
    if not isinstance(words, list) or len(words) > MAX_WORDS:
        raise _damaged_error(path_text, phrase("it must contain a list of at most {maximum} words", maximum=MAX_WORDS))
    takes_by_name: dict[str, tuple[Take, ...]] = {}
    for number, word in enumerate(words, 1):
        name = word.get("name") if isinstance(word, dict) else None
        if not isinstance(name, str) or find_name_problem(name) is not None or name in takes_by_name:
            raise _damaged_error(
                path_text, phrase("word {number} has no valid name, or the name of an earlier word", number=number)
            )
        takes = word.get("takes")
        if not isinstance(takes, list) or not 1 <= len(takes) <= MAX_TAKES:
            raise _damaged_error(
                path_text, phrase("the word '{name}' must have 1 to {maximum} recordings", name=name, maximum=MAX_TAKES)
            )
        takes_by_name[name] = tuple(_read_take(take, name, path_text) for take in takes)
    return takes_by_name


def _read_take(take: Any, name: str, path_text: str) -> Take:
    try:
        frames, noise = (
            np.frombuffer(base64.b64decode(take[key], validate=True), np.uint8) for key in ("frames", "noise")
        )
    except (TypeError, KeyError, ValueError, binascii.Error):
        raise _damaged_error(
            path_text, phrase("a recording of the word '{name}' cannot be decoded", name=name)
        ) from None
    count = len(frames) // BANDS
    if len(frames) % BANDS or not 1 <= count <= _MAX_FRAMES or len(noise) != BANDS:
        raise _damaged_error(path_text, phrase("a recording of the word '{name}' has the wrong length", name=name))
    return Take(_from_levels(frames).reshape(count, BANDS), _from_levels(noise))


def _damaged_error(path_text: str, reason: Phrase, location: Span | None = None) -> LinkwrightError:
    message = phrase("'{path}' cannot be read as a file of enrolled words: {reason}", path=path_text, reason=reason)
    hint = phrase("replace it with a backup, or remove it and enroll the words again")
    return LinkwrightError(Diagnostic("VOICE203", message, location, hint=hint))
