"""The example engine of the page about voice, with a fake Whisper."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import ClassVar

import numpy as np
import pytest

from linkwright.loading import extensions
from linkwright.speech.engine import EngineOptions, make_engine
from linkwright.speech.sound.samples import BLOCK_LENGTH
from tests.speech.voices import WORDS, say

DOCS = Path(__file__).resolve().parents[3] / "docs"
PAGES = ("voice.md", "zh/voice.md")


class WhisperModel:
    """A fake that transcribes the next of some texts, in two segments."""

    texts: ClassVar[list[str]] = []
    sounds: ClassVar[list[np.ndarray]] = []

    def __init__(self, model: str, **settings: str) -> None:
        self.model = model

    def transcribe(self, sound: np.ndarray, language: str):
        assert (self.model, language, sound.dtype) == ("tiny", "en", np.float32)
        self.sounds.append(sound)
        text = self.texts.pop(0)
        middle = len(text) // 2
        return (SimpleNamespace(text=half_text, avg_logprob=-0.1) for half_text in (text[:middle], text[middle:])), None


@pytest.fixture(params=PAGES)
def engine(request, monkeypatch):
    (code,) = re.findall(
        r'```python title="my_ears/whisper_engine.py"\n(.*?)```', (DOCS / request.param).read_text("utf-8"), re.DOTALL
    )
    whisper, package = ModuleType("faster_whisper"), ModuleType("whisper_engine")
    whisper.WhisperModel = WhisperModel
    monkeypatch.setitem(sys.modules, "faster_whisper", whisper)
    exec(compile(code, request.param, "exec"), package.__dict__)
    monkeypatch.setitem(sys.modules, "whisper_engine", package)
    entry = extensions.EntryPoint("whisper", "whisper_engine:WhisperEngine", "my_ears")
    monkeypatch.setattr("linkwright.speech.engine.extensions", lambda group: {"whisper": entry})
    return make_engine("whisper", EngineOptions(("turn left", "stop"), "en"))


def test_engine_recognizes_utterances(engine):
    WhisperModel.texts[:] = [" Turn left.", " Nothing of that kind.", " Stop!"]
    WhisperModel.sounds.clear()
    results = []
    for phones in (WORDS["turn left"], "mumi", WORDS["stop"]):
        sound = say(phones, silence=0.8)
        for start in range(0, len(sound), BLOCK_LENGTH):
            results += engine.hear(sound[start : start + BLOCK_LENGTH])
    assert [(result.text, result.final) for result in results] == [("turn left", True), ("", True), ("stop", True)]
    assert results[0].confidence == pytest.approx(np.exp(-0.1))
    assert all(result.start < result.end for result in results)
    assert all(np.abs(sound).max() > 0.1 for sound in WhisperModel.sounds)


def test_finish_ends_utterance(engine):
    WhisperModel.texts[:] = ["stop"]
    assert list(engine.hear(say(WORDS["stop"], silence=0.3)[:-3200])) == []
    assert [result.text for result in engine.finish()] == ["stop"]
    assert list(engine.finish()) == []
