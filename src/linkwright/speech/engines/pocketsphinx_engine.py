"""The engine ``pocketsphinx``: a grammar of phrases and a model of American English.

The grammar has no model of other speech: in our measurements a quarter of other utterances was recognized as a phrase,
and more in noise. The engine is therefore suitable for push-to-talk; Vosk or enrolled words are better where they are
available.
"""

from __future__ import annotations

import json
import math
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, install_hint, phrase
from linkwright.speech.engine import EngineOptions, Heard, SpeechEngine
from linkwright.speech.engines.phrasing import Phrasing
from linkwright.speech.sound.samples import RATE, Samples

_LANGUAGE = "en"
_GRAMMAR = "phrases"
_MODEL_FILES = ("mdef", "means", "variances", "transition_matrices")
_FILLER_PREFIXES = ("<", "[", "(")  # prefixes of pocketsphinx's names for silence and noise, which no word has
_MIDDLE_FIT = -8.0
"""The log score per frame with confidence 0.5. All of 72 correct phrases and a quarter of other sounds had more."""

_MIN_PROBABILITY = 1e-300  # avoids the logarithm of a probability that underflows to 0


class PocketsphinxEngine(SpeechEngine):
    """An engine that recognizes phrases with pocketsphinx.

    The confidence rates the acoustic fit, and is 0.5 for a log score of -8 per frame. The probability from pocketsphinx
    itself is not useful: it is divided among all paths through the grammar that sound alike, and a fifth of clear
    phrases had less than 0.1.

    Raises:
        LinkwrightError: VOICE102, pocketsphinx is not installed; VOICE103, the dictionary lacks a word; VOICE104, the
            folder does not contain a model; VOICE105, the language is not English and no model is given.
    """

    def __init__(self, options: EngineOptions) -> None:
        try:
            import pocketsphinx  # type: ignore[import-untyped, import-not-found, unused-ignore]
        except ModuleNotFoundError:
            message = phrase("the package '{package}' is not installed", package="pocketsphinx")
            raise LinkwrightError(Diagnostic("VOICE102", message, hint=install_hint("voice"))) from None
        if options.model is None and options.language.partition("-")[0].lower() != _LANGUAGE:
            message = phrase("pocketsphinx has no model for the language '{language}'", language=options.language)
            hint = phrase("use the engine 'vosk' or 'enrolled', or give the folder of a model")
            raise LinkwrightError(Diagnostic("VOICE105", message, hint=hint))
        self._decoder = _make_decoder(pocketsphinx, options.model)
        self._phrasing = Phrasing.of(
            options.phrases,
            lambda word: self._decoder.lookup_word(word) is not None,
            options.model or "pocketsphinx",
        )
        self._decoder.add_jsgf_string(_GRAMMAR, _format_grammar(self._phrasing))
        self._decoder.activate_search(_GRAMMAR)
        self._endpointer = pocketsphinx.Endpointer(sample_rate=RATE)
        self._waiting = b""
        self._is_speaking = False
        self._partial = ""

    def hear(self, samples: Samples) -> Sequence[Heard]:
        """Process samples.

        A partial result is a complete phrase that matches the words so far.
        """
        self._waiting += samples.astype("<i2").tobytes()
        size = self._endpointer.frame_bytes
        results: list[Heard] = []
        while len(self._waiting) >= size:
            frame, self._waiting = self._waiting[:size], self._waiting[size:]
            results += self._decode(self._endpointer.process(frame))
        if self._is_speaking:
            results += self._make_partial_if_changed()
        return results

    def finish(self) -> Sequence[Heard]:
        """End the utterance, and return its final results."""
        remaining, self._waiting = (
            self._waiting or b"\0\0",
            b"",
        )  # pocketsphinx cannot end an utterance without a sample
        results = self._decode(self._endpointer.end_stream(remaining)) if self._endpointer.in_speech else []
        return [*results, *self._end_utterance()]

    def close(self) -> None:
        """End the current utterance without a result."""
        self._end_utterance()

    def _decode(self, speech: bytes | None) -> list[Heard]:
        """Decode detected speech, and return the result at the end of the utterance."""
        if speech is None:
            return []
        if not self._is_speaking:
            self._decoder.start_utt()
            self._is_speaking, self._partial = True, ""
        self._decoder.process_raw(speech)
        return [] if self._endpointer.in_speech else self._end_utterance()

    def _end_utterance(self) -> list[Heard]:
        if not self._is_speaking:
            return []
        self._is_speaking = False
        self._decoder.end_utt()
        text, confidence = self._find_best_phrase()
        return [Heard(text, confidence, True, self._endpointer.speech_start, self._endpointer.speech_end)]

    def _make_partial_if_changed(self) -> list[Heard]:
        text, confidence = self._find_best_phrase()
        if text in ("", self._partial):
            return []
        self._partial = text
        end = self._endpointer.speech_start + self._decoder.n_frames() / self._decoder.config["frate"]
        return [Heard(text, confidence, False, self._endpointer.speech_start, end)]

    def _find_best_phrase(self) -> tuple[str, float]:
        """Return the recognized phrase as the user wrote it, and its confidence.

        The phrase is empty if no phrase was recognized.
        """
        hypothesis = self._decoder.hyp()
        if hypothesis is None:
            return "", 0.0
        words = [word for word in hypothesis.hypstr.split() if not word.startswith(_FILLER_PREFIXES)]
        return self._phrasing.phrases.get(tuple(words), ""), self._compute_confidence()

    def _compute_confidence(self) -> float:
        """Return the confidence of the current result, 0 to 1.

        It compares the score of the words with the score of the best sequence of any phones.
        """
        word_segments = [
            segment for segment in self._decoder.seg() or () if not segment.word.startswith(_FILLER_PREFIXES)
        ]
        frames = sum(segment.end_frame - segment.start_frame + 1 for segment in word_segments)
        if not frames:
            return 0.0
        fit = sum(math.log(max(segment.ascore, _MIN_PROBABILITY)) for segment in word_segments) / frames
        return 1.0 / (1.0 + math.exp(_MIDDLE_FIT - fit))


def _format_grammar(phrasing: Phrasing) -> str:
    """Return a grammar of complete phrases (JSpeech Grammar Format, W3C note of June 2000)."""
    alternatives = " | ".join(" ".join(words) for words in phrasing.phrases)
    return f"#JSGF V1.0;\ngrammar {_GRAMMAR};\npublic <said> = {alternatives};\n"


def _make_decoder(pocketsphinx: Any, folder: Path | None) -> Any:
    settings: dict[str, Any] = {"lm": None, "loglevel": "FATAL", "samprate": RATE, "compallsen": True}
    if folder is not None:
        dictionaries = sorted(path for path in folder.glob("*.dic*") if path.is_file()) if folder.is_dir() else []
        if not dictionaries or not all((folder / name).is_file() for name in _MODEL_FILES):
            message = phrase("'{path}' contains no pocketsphinx model", path=folder)
            hint = phrase("give a folder with 'mdef', its other files, and a dictionary such as 'words.dict'")
            raise LinkwrightError(Diagnostic("VOICE104", message, hint=hint))
        settings |= {"hmm": str(folder), "dict": str(dictionaries[0])}
        _load_in_subprocess(folder, settings)
    try:
        return pocketsphinx.Decoder(**settings)
    except (RuntimeError, ValueError) as error:
        message = phrase("pocketsphinx cannot start: {reason}", reason=foreign(error))
        raise LinkwrightError(Diagnostic("VOICE104", message)) from None


_TRIAL_SCRIPT = "import json, sys, pocketsphinx; pocketsphinx.Decoder(**json.loads(sys.argv[1]))"


def _load_in_subprocess(folder: Path, settings: dict[str, Any]) -> None:
    """Load a model in a separate process first, and raise an error if that fails.

    The library ends its process if a model is damaged.
    """
    command = [sys.executable, "-c", _TRIAL_SCRIPT, json.dumps(settings)]
    trial = subprocess.run(  # noqa: S603 - this very interpreter
        command, check=False, stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace"
    )
    if trial.returncode:
        message = phrase("pocketsphinx cannot load the model in '{path}'", path=folder)
        last_line = trial.stderr.strip().rpartition("\n")[2]
        hint = (
            phrase("it reports: {reason}", reason=foreign(last_line))
            if last_line
            else phrase("one of its files is damaged")
        )
        raise LinkwrightError(Diagnostic("VOICE104", message, hint=hint))
