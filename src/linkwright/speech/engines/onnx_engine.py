"""The engine ``onnx``: a user's ONNX network that spots keywords.

The network classifies a speech segment. The input is ``[1, n]`` float32, the sound at 16 kHz with full scale at 1. The
output is ``[1, classes]``, scores or probabilities. The metadata ``names`` contains the classes, as JSON (a list, or an
object of numbers and names) or separated by commas. Classes that do not match any phrase, such as ``background``,
represent all other sound.

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
from linkwright.speech.sound.spectra import HOP_LENGTH, MelFrames

MIN_PROBABILITY = 0.6
"""The minimum probability at which a class is reported."""

_LEAD_IN_SAMPLES = RATE // 5  # the number of samples before the start of speech that are included
_MAX_SAMPLES = 10 * RATE  # the maximum number of samples in an utterance
_FULL_SCALE = 32_768.0
"""The full scale of 16-bit samples."""


class OnnxEngine(SpeechEngine):
    """An engine that recognizes phrases with the ONNX network in the file of option ``model``.

    Raises:
        LinkwrightError: VOICE102, onnxruntime is not installed; VOICE104, the file is not such a network.
    """

    def __init__(self, options: EngineOptions) -> None:
        if options.model is None:
            hint = phrase("give an ONNX file as the model")
            raise LinkwrightError(Diagnostic("VOICE104", phrase("the engine 'onnx' needs a model"), hint=hint))
        self._session = _load_session(options.model)
        self._input, self._length, self._names = _read_interface(self._session, options.model)
        self._phrases = {_normalize(phrase): phrase for phrase in options.phrases}
        self._frames, self._activity = MelFrames(), VoiceActivity()
        self._buffer: Samples = np.zeros(0, np.int16)
        self._sample_count = 0  # the number of samples so far

    def hear(self, samples: Samples) -> Sequence[Heard]:
        """Process samples, and return results at the end of an utterance.

        There are no partial results, because the network classifies whole utterances.
        """
        self._buffer = np.concatenate((self._buffer, samples))[-_MAX_SAMPLES:]
        self._sample_count += len(samples)
        results: list[Heard] = []
        for frame in self._frames.feed(samples):
            was_speaking = self._activity.speaking
            is_speaking = self._activity.step(frame)
            if was_speaking and not is_speaking:
                results += self._end_utterance()
            elif not was_speaking and not is_speaking:
                self._buffer = self._buffer[-_LEAD_IN_SAMPLES - len(samples) :]
        return results

    def finish(self) -> Sequence[Heard]:
        """End the utterance, and return its result."""
        if not self._activity.speaking:
            return []
        self._activity.end()
        return self._end_utterance()

    def _end_utterance(self) -> list[Heard]:
        utterance = self._buffer[: max(1, len(self._buffer) - self._activity.quiet_frames * HOP_LENGTH)]
        end = (self._sample_count - len(self._buffer) + len(utterance)) / RATE
        scores = self._session.run(None, {self._input: _fit_length(utterance, self._length)[None]})[0][0]
        probabilities = _to_probabilities(np.asarray(scores, np.float64))
        best = int(np.argmax(probabilities))
        name, probability = self._names[best], float(probabilities[best])
        text = self._phrases.get(_normalize(name), "") if probability >= MIN_PROBABILITY else ""
        self._buffer = self._buffer[-_LEAD_IN_SAMPLES:]
        return [Heard(text, probability, True, max(0.0, end - len(utterance) / RATE), end)]


def _normalize(text: str) -> str:
    return " ".join(text.replace("_", " ").lower().split())


def _fit_length(utterance: Samples, length: int) -> NDArray[np.float32]:
    """Return the sound in a fixed number of samples.

    A longer utterance is cut to its middle, and a shorter one is padded with silence on both sides.
    """
    start = (len(utterance) - length) // 2
    sound: NDArray[np.float32] = np.zeros(length, np.float32)
    if start >= 0:
        sound[:] = utterance[start : start + length] / _FULL_SCALE
    else:
        sound[-start : -start + len(utterance)] = utterance / _FULL_SCALE
    return sound


def _to_probabilities(scores: NDArray[np.float64]) -> NDArray[np.float64]:
    """Convert scores to probabilities with softmax, unless they already are probabilities."""
    if scores.min() >= 0.0 and abs(scores.sum() - 1.0) < 1e-3:
        return scores
    exponentials: NDArray[np.float64] = np.exp(scores - scores.max())
    return np.asarray(exponentials / exponentials.sum())


def _load_session(path: Path) -> Any:
    try:
        return load_session(path, threads=1)
    except ModuleNotFoundError as error:
        raise missing_extra("VOICE102", error) from None
    except UnloadableNetworkError as error:
        raise _model_error(path, error.reason) from None


def _read_interface(session: Any, path: Path) -> tuple[str, int, tuple[str, ...]]:
    """Return the name and length of the network's input, and the names of its classes."""
    inputs, outputs = session.get_inputs(), session.get_outputs()
    shape = inputs[0].shape if len(inputs) == 1 else []
    if len(shape) != 2 or not isinstance(shape[1], int) or not 0 < shape[1] <= _MAX_SAMPLES:
        raise _model_error(path, phrase("its input must be one array of [1, n], not {shape}", shape=foreign(shape)))
    if inputs[0].type != "tensor(float)":
        raise _model_error(
            path, phrase("the type of its input must be float32, not {type}", type=foreign(inputs[0].type))
        )
    names = _parse_names(session.get_modelmeta().custom_metadata_map.get("names", ""))
    classes = outputs[0].shape[-1] if outputs[0].shape else None
    if not names or (isinstance(classes, int) and classes != len(names)):
        raise _model_error(path, phrase("its metadata 'names' must have a name for each class"))
    return inputs[0].name, shape[1], names


def _parse_names(text: str) -> tuple[str, ...]:
    try:
        names = json.loads(text)
    except json.JSONDecodeError:
        names = [name.strip() for name in text.split(",") if name.strip()]
    if isinstance(names, dict):
        try:
            names = [names[key] for key in sorted(names, key=int)]
        except ValueError:
            return ()
    return tuple(map(str, names)) if isinstance(names, list) else ()


def _model_error(path: Path, reason: Phrase) -> LinkwrightError:
    message = phrase("'{path}' is not a keyword spotter: {reason}", path=path, reason=reason)
    hint = phrase(
        "use a network that accepts 16 kHz audio as float32 [1, n], outputs [1, classes], and "
        "names the classes in its metadata 'names'"
    )
    return LinkwrightError(Diagnostic("VOICE104", message, hint=hint))
