"""The engine ``onnx``: a user's network in an ONNX file that classifies a section of sound (keyword spotting).

Its input is ``[1, n]`` float32, the sound at 16 kHz with full scale at 1; its output is ``[1, classes]``, scores or
probabilities. The metadata ``names`` contains the classes, as JSON (a list, or an object of numbers and names) or
separated by commas. Classes that do not match any phrase, such as ``background``, represent all other sound.

Speech between two silences is cut to ``n`` samples around its middle, or padded with silence on both sides.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, foreign, missing_extra, phrase
from linkwright.model_files.onnx_sessions import UnloadableNetworkError, load_session
from linkwright.speech.engine import EngineOptions, Heard, SpeechEngine
from linkwright.speech.sound.activity import VoiceActivity
from linkwright.speech.sound.samples import RATE, Samples
from linkwright.speech.sound.spectra import HOP, MelFrames

LEAST_PROBABILITY = 0.6
"""The least probability of a class that counts."""

_BEFORE = RATE // 5  # samples before the start of speech that are included
_LONGEST = 10 * RATE  # the maximum number of samples in an utterance
_FULL = 32_768.0


class OnnxEngine(SpeechEngine):
    """The engine ``onnx``, whose model is set by the option ``model``.

    Raises:
        LinkwrightError: VOICE102, onnxruntime is not installed; VOICE104, the file is not such a network.
    """

    def __init__(self, options: EngineOptions) -> None:
        if options.model is None:
            hint = phrase("give the ONNX file of your network as the model")
            raise LinkwrightError(
                Diagnostic("VOICE104", phrase("the engine 'onnx' has no model of its own"), hint=hint)
            )
        self._session = _session(options.model)
        self._input, self._length, self._names = _form(self._session, options.model)
        self._phrases = {_plain(phrase): phrase for phrase in options.phrases}
        self._frames, self._activity = MelFrames(), VoiceActivity()
        self._buffer: Samples = np.zeros(0, np.int16)
        self._heard = 0  # the number of samples

    def hear(self, samples: Samples) -> Sequence[Heard]:
        """Process a block; there are no partial results, because the network runs when an utterance is over."""
        self._buffer = np.concatenate((self._buffer, samples))[-_LONGEST:]
        self._heard += len(samples)
        found: list[Heard] = []
        for frame in self._frames.feed(samples):
            spoke = self._activity.speaking
            speaks = self._activity.step(frame)
            if spoke and not speaks:
                found += self._end()
            elif not spoke and not speaks:
                self._buffer = self._buffer[-_BEFORE - len(samples) :]
        return found

    def finish(self) -> Sequence[Heard]:
        """End the utterance, and return its result."""
        if not self._activity.speaking:
            return []
        self._activity.end()
        return self._end()

    def _end(self) -> list[Heard]:
        utterance = self._buffer[: max(1, len(self._buffer) - self._activity.quiet_frames * HOP)]
        end = (self._heard - len(self._buffer) + len(utterance)) / RATE
        scores = self._session.run(None, {self._input: _fitted(utterance, self._length)[None]})[0][0]
        chances = _probabilities(np.asarray(scores, np.float64))
        best = int(np.argmax(chances))
        name, probability = self._names[best], float(chances[best])
        text = self._phrases.get(_plain(name), "") if probability >= LEAST_PROBABILITY else ""
        self._buffer = self._buffer[-_BEFORE:]
        return [Heard(text, probability, True, max(0.0, end - len(utterance) / RATE), end)]


def _plain(text: str) -> str:
    return " ".join(text.replace("_", " ").lower().split())


def _fitted(utterance: Samples, length: int) -> NDArray[np.float32]:
    """Return sound of a given length.

    It is the middle of the utterance, or all of it with silence on both sides.
    """
    first = (len(utterance) - length) // 2
    whole: NDArray[np.float32] = np.zeros(length, np.float32)
    if first >= 0:
        whole[:] = utterance[first : first + length] / _FULL
    else:
        whole[-first : -first + len(utterance)] = utterance / _FULL
    return whole


def _probabilities(scores: NDArray[np.float64]) -> NDArray[np.float64]:
    """Convert scores to probabilities, unless they already are probabilities."""
    if scores.min() >= 0.0 and abs(scores.sum() - 1.0) < 1e-3:
        return scores
    powers: NDArray[np.float64] = np.exp(scores - scores.max())
    return np.asarray(powers / powers.sum())


def _session(path: Path) -> Any:
    try:
        return load_session(path, threads=1)
    except ModuleNotFoundError as error:
        raise missing_extra("VOICE102", error) from None
    except UnloadableNetworkError as error:
        raise _unfit(path, error.reason) from None


def _form(session: Any, path: Path) -> tuple[str, int, tuple[str, ...]]:
    """Return the name and length of the input, and the names of the classes."""
    inputs, outputs = session.get_inputs(), session.get_outputs()
    shape = inputs[0].shape if len(inputs) == 1 else []
    if len(shape) != 2 or not isinstance(shape[1], int) or not 0 < shape[1] <= _LONGEST:
        raise _unfit(path, phrase("its input is not one array of [1, n], but {shape}", shape=foreign(shape)))
    if inputs[0].type != "tensor(float)":
        raise _unfit(path, phrase("its input is {type}, not float32", type=foreign(inputs[0].type)))
    names = _names(session.get_modelmeta().custom_metadata_map.get("names", ""))
    classes = outputs[0].shape[-1] if outputs[0].shape else None
    if not names or (isinstance(classes, int) and classes != len(names)):
        raise _unfit(path, phrase("its metadata 'names' does not have a name for each class"))
    return inputs[0].name, shape[1], names


def _names(text: str) -> tuple[str, ...]:
    try:
        found = json.loads(text)
    except json.JSONDecodeError:
        found = [name.strip() for name in text.split(",") if name.strip()]
    if isinstance(found, dict):
        try:
            found = [found[key] for key in sorted(found, key=int)]
        except ValueError:
            return ()
    return tuple(map(str, found)) if isinstance(found, list) else ()


def _unfit(path: Path, reason: Phrase) -> LinkwrightError:
    message = phrase("'{path}' is not a keyword spotter: {reason}", path=path, reason=reason)
    hint = phrase(
        "use a network that takes 16 kHz sound as float32 [1, n], outputs [1, classes], and names "
        "the classes in its metadata 'names'"
    )
    return LinkwrightError(Diagnostic("VOICE104", message, hint=hint))
