"""The engine ``vosk``: a grammar of phrases with a pretrained model.

The grammar consists of the phrases and ``[unk]``, which matches all other speech. A result with ``[unk]``, or with a
word of less confidence than `MIN_CONFIDENCE`, is rejected. In our measurements this reduced false commands in read
texts from one in sixty to none, at the cost of one correct command in a hundred.

Partial results come from the best path and arrive immediately; with confidences, Vosk would delay them until it has
built a lattice. They start after the last ``[unk]``, so that "stop" is also recognized in the middle of other speech.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, missing_extra, phrase
from linkwright.diagnostics.translation import LANGUAGES
from linkwright.model_files import find_model, model_entry
from linkwright.speech.engine import EngineOptions, Heard, SpeechEngine
from linkwright.speech.engines.phrasing import Phrasing
from linkwright.speech.sound.samples import RATE, Samples

MIN_CONFIDENCE = 0.6
"""The minimum confidence of each word of a phrase."""

_MIN_NEAREST_CONFIDENCE = 0.3
"""The minimum confidence at which a rejected phrase is reported as the nearest."""

MODELS = {language: f"vosk-{language}" for language in LANGUAGES}
"""The names of the models that can be downloaded, by language."""

_OTHER_SPEECH = "[unk]"
_SILENT_LOG_LEVEL = -1  # the log level of Vosk that suppresses messages
_ACOUSTIC_MODEL = Path("am") / "final.mdl"


class VoskEngine(SpeechEngine):
    """An engine that recognizes phrases with Vosk.

    Raises:
        LinkwrightError: MODEL102, the language's model has not been downloaded; VOICE102, Vosk is not installed;
            VOICE103, the model does not contain a word; VOICE104, the folder does not contain a Vosk model; VOICE105,
            there is no model for the language.
    """

    def __init__(self, options: EngineOptions) -> None:
        vosk = _load_library()
        folder = options.model or _find_language_model(options.language)
        vosk.SetLogLevel(_SILENT_LOG_LEVEL)
        model = _load_model(vosk, folder)
        self._phrasing = Phrasing.of(options.phrases, lambda word: model.vosk_model_find_word(word) >= 0, folder)
        grammar = [" ".join(words) for words in self._phrasing.phrases]
        self._recognizer = vosk.KaldiRecognizer(model, RATE, json.dumps([*grammar, _OTHER_SPEECH], ensure_ascii=False))
        self._recognizer.SetWords(True)
        self._partial: list[str] = []
        self._samples = 0  # the number of samples so far
        self._partial_start = 0.0  # start time of the partial result

    def hear(self, samples: Samples) -> Sequence[Heard]:
        """Process samples, and return new results.

        Partial results get the minimum accepted confidence, because Vosk does not report their confidence.
        """
        if not len(samples):
            return []
        self._samples += len(samples)
        if self._recognizer.AcceptWaveform(samples.astype("<i2").tobytes()):
            return self._make_final_results(self._recognizer.Result())
        return self._make_partial_if_changed(self._recognizer.PartialResult())

    def finish(self) -> Sequence[Heard]:
        """End the utterance, and return its final results."""
        return self._make_final_results(self._recognizer.FinalResult())

    def _make_final_results(self, result: str) -> list[Heard]:
        self._partial = []
        words = json.loads(result).get("result", [])
        if not words:
            return []
        confidence = min(word["conf"] for word in words)
        phrases = self._phrasing.split_into_phrases([word["word"] for word in words])
        if phrases is None or confidence < MIN_CONFIDENCE:
            is_near = phrases is not None and len(phrases) == 1 and confidence >= _MIN_NEAREST_CONFIDENCE
            nearest = phrases[0][0] if phrases and is_near else ""
            return [Heard("", confidence, True, words[0]["start"], words[-1]["end"], nearest)]
        return [
            Heard(
                text,
                min(word["conf"] for word in words[first:end]),
                True,
                words[first]["start"],
                words[end - 1]["end"],
            )
            for text, first, end in phrases
        ]

    def _make_partial_if_changed(self, result: str) -> list[Heard]:
        """Return the partial results if the words have changed and form phrases, else []."""
        words = json.loads(result).get("partial", "").split()
        if words == self._partial:
            return []
        time = self._samples / RATE
        if not self._partial:
            self._partial_start = time
        self._partial = words
        if _OTHER_SPEECH in words:
            words = words[len(words) - words[::-1].index(_OTHER_SPEECH) :]
        phrases = self._phrasing.split_into_phrases(words) or []
        return [Heard(text, MIN_CONFIDENCE, False, self._partial_start, time) for text, _, _ in phrases]


def _load_library() -> Any:
    try:
        import vosk  # type: ignore[import-untyped, import-not-found, unused-ignore]
    except ModuleNotFoundError as error:
        raise missing_extra("VOICE102", error) from None
    except OSError as error:
        message = phrase("the library of '{engine}' cannot be loaded: {reason}", engine="vosk", reason=foreign(error))
        raise LinkwrightError(Diagnostic("VOICE102", message)) from None
    return vosk


def _find_language_model(language: str) -> Path:
    name = MODELS.get(language.partition("-")[0].lower())
    if name is None:
        message = phrase("no Vosk model for the language '{language}' is installed", language=language)
        hint = phrase("download one from https://alphacephei.com/vosk/models, and give its folder as the model")
        raise LinkwrightError(Diagnostic("VOICE105", message, hint=hint))
    return find_model(model_entry(name))


def _load_model(vosk: Any, folder: Path) -> Any:
    if (folder / _ACOUSTIC_MODEL).is_file():
        try:
            return vosk.Model(str(folder))
        except Exception as error:  # noqa: BLE001 - Vosk raises nothing narrower
            reason = foreign(error)
    else:
        reason = phrase("it does not contain '{file}'", file=_ACOUSTIC_MODEL.as_posix())
    message = phrase("'{path}' contains no Vosk model: {reason}", path=folder, reason=reason)
    hint = phrase("give a model folder, such as `linkwright models get vosk-en` downloads")
    raise LinkwrightError(Diagnostic("VOICE104", message, hint=hint))
