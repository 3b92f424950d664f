"""A fake of vosk 0.3.45 whose recognizer follows a script.

The sound is ignored; each block takes the next item of the script: a str for a partial result, a list of (word,
confidence) for the end of an utterance. The JSON has the form of Vosk's own recognizer.
"""

from __future__ import annotations

import json
from pathlib import Path

WORDS: set[str] = set()
SCRIPT: list = []
MADE: list = []
LEVELS: list[int] = []


class Model:
    def __init__(self, model_path=None, model_name=None, lang=None):
        if (Path(model_path) / "am" / "final.mdl").read_bytes() == b"broken":
            raise Exception("Failed to create a model")  # noqa: TRY002 - as Vosk does

    def vosk_model_find_word(self, word):
        return 7 if word in WORDS else -1


class KaldiRecognizer:
    def __init__(self, model, rate, grammar):
        self.model, self.rate, self.grammar = model, rate, json.loads(grammar)
        self.words, self.seconds, self.partial, self.ended = False, 0.0, "", None
        MADE.append(self)

    def SetWords(self, enabled):  # noqa: N802
        self.words = enabled

    def AcceptWaveform(self, data):  # noqa: N802
        assert isinstance(data, bytes)
        self.seconds += len(data) / 2 / self.rate
        item = SCRIPT.pop(0) if SCRIPT else self.partial
        if isinstance(item, str):
            self.partial = item
            return 0
        self.ended = item
        return 1

    def Result(self):  # noqa: N802
        words, self.ended, self.partial = self.ended, None, ""
        return self._written(words)

    def FinalResult(self):  # noqa: N802
        words = [(word, 1.0) for word in self.partial.split()]
        self.partial = ""
        return self._written(words)

    def PartialResult(self):  # noqa: N802
        return json.dumps({"partial": self.partial}, ensure_ascii=False, indent=2)

    def _written(self, words):
        if not words:
            return '{\n  "text" : ""\n}'
        first = self.seconds - 0.3 * len(words)
        result = [
            {"conf": conf, "end": first + 0.3 * (index + 1), "start": first + 0.3 * index, "word": word}
            for index, (word, conf) in enumerate(words)
        ]
        text = " ".join(word for word, _ in words)
        return json.dumps({"result": result, "text": text} if self.words else {"text": text}, ensure_ascii=False)


def SetLogLevel(level):  # noqa: N802
    LEVELS.append(level)
