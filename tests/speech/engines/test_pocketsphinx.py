"""The engine pocketsphinx: phrases with the real library, streams with a fake one."""

from __future__ import annotations

import math
import shutil
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from linkwright.diagnostics import LinkwrightError, install_hint
from linkwright.speech.engine import EngineOptions, engine_names
from linkwright.speech.engines.pocketsphinx_engine import PocketsphinxEngine
from tests.speech.voices import WORDS, say

pocketsphinx = pytest.importorskip("pocketsphinx", reason="pocketsphinx is not installed")

FRAME_SAMPLES = 480
SPEECH_FRAME, QUIET_FRAME = np.full(FRAME_SAMPLES, 1_000, np.int16), np.zeros(FRAME_SAMPLES, np.int16)


class Endpointer:
    """A fake that takes loud frames for speech; one quiet frame ends it."""

    frame_bytes = 2 * FRAME_SAMPLES

    def __init__(self, sample_rate):
        assert sample_rate == 16_000
        self.in_speech, self.speech_start, self.speech_end, self.frames = False, 0.0, 0.0, 0

    def process(self, frame):
        assert len(frame) == self.frame_bytes
        self.frames += 1
        is_loud, was_in_speech = bool(np.frombuffer(frame, np.int16).any()), self.in_speech
        if is_loud and not was_in_speech:
            self.speech_start = (self.frames - 1) * 0.03
        if was_in_speech and not is_loud:
            self.speech_end = self.frames * 0.03
        self.in_speech = is_loud
        return frame if is_loud or was_in_speech else None

    def end_stream(self, frame):
        self.in_speech, self.speech_end = False, self.frames * 0.03
        return frame


class Decoder:
    """A fake that recognizes as many words of a sentence as there are frames of speech."""

    says = ("go", "to", "<sil>", "the", "kitchen")
    fit = -7.0  # logarithm of the probability of each frame
    decoders = ()

    def __init__(self, **settings):
        self.config, self.grammar, self.frames = {"frate": 100}, "", 0
        self.decoders.append(self)

    def lookup_word(self, word):
        return "A B" if word in ("go", "to", "the", "kitchen", "stop") else None

    def add_jsgf_string(self, name, text):
        self.grammar = text

    def activate_search(self, name):
        pass

    def start_utt(self):
        self.frames = 0

    def process_raw(self, data):
        self.frames += 1

    def end_utt(self):
        pass

    def n_frames(self):
        return 3 * self.frames

    def hyp(self):
        text = " ".join(self.says[: self.frames])
        return SimpleNamespace(hypstr=text, prob=0.06) if text else None

    def seg(self):
        scores = {"<sil>": -1.0}
        return [
            SimpleNamespace(
                word=word,
                start_frame=3 * index,
                end_frame=3 * index + 2,
                ascore=math.exp(3 * scores.get(word, self.fit)),
            )
            for index, word in enumerate((*self.says[: self.frames], "(NULL)"))
        ]


@pytest.fixture
def fake_decoder(monkeypatch):
    monkeypatch.setitem(sys.modules, "pocketsphinx", SimpleNamespace(Decoder=Decoder, Endpointer=Endpointer))
    monkeypatch.setattr(Decoder, "decoders", [])


def engine_rejection(*arguments):
    with pytest.raises(LinkwrightError) as error:
        PocketsphinxEngine(EngineOptions(*arguments))
    (diagnostic,) = error.value.diagnostics
    return diagnostic


def test_vosk_and_pocketsphinx_are_registered():
    assert {"vosk", "pocketsphinx"} <= set(engine_names())


def test_utterance_is_recognized_in_blocks_of_any_length(fake_decoder):
    engine = PocketsphinxEngine(EngineOptions(("go to the kitchen", "Stop")))
    assert "public <said> = go to the kitchen | stop;" in Decoder.decoders[0].grammar
    sound = np.concatenate([QUIET_FRAME, QUIET_FRAME, *[SPEECH_FRAME] * 5, QUIET_FRAME, QUIET_FRAME])
    results = [result for start in range(0, len(sound), 700) for result in engine.hear(sound[start : start + 700])]
    assert [(result.text, result.final) for result in results] == [
        ("go to the kitchen", False),
        ("go to the kitchen", True),
    ]
    assert results[-1].confidence == pytest.approx(1 / (1 + math.exp(-1)))
    assert (results[-1].start, results[-1].end) == pytest.approx((0.06, 0.24))


@pytest.mark.parametrize(("fit", "confidence"), [(-4.0, 0.982), (-8.0, 0.5), (-11.0, 0.047), (-900.0, 0.0)])
def test_acoustic_fit_sets_confidence(fake_decoder, monkeypatch, fit, confidence):
    monkeypatch.setattr(Decoder, "fit", fit)
    engine = PocketsphinxEngine(EngineOptions(("go to",)))
    (result,) = [*engine.hear(SPEECH_FRAME), *engine.finish()]
    assert (result.text, result.final) == ("go to", True)
    assert result.confidence == pytest.approx(confidence, abs=1e-3)


def test_unknown_words_give_empty_text(fake_decoder):
    engine = PocketsphinxEngine(EngineOptions(("stop",)))
    (result,) = engine.hear(np.concatenate([SPEECH_FRAME, SPEECH_FRAME, QUIET_FRAME]))
    assert (result.text, result.final) == ("", True)


def test_finish_ends_utterance(fake_decoder):
    engine = PocketsphinxEngine(EngineOptions(("go", "stop")))
    assert [result.text for result in engine.hear(np.concatenate([SPEECH_FRAME, SPEECH_FRAME[:100]]))] == ["go"]
    (final_result,) = engine.finish()
    assert final_result.final
    assert list(engine.finish()) == []
    assert [result.text for result in engine.hear(SPEECH_FRAME)] == ["go"]
    engine.close()


def test_silence_and_noise_are_not_recognized_by_real_library():
    engine = PocketsphinxEngine(EngineOptions(("forward", "turn left", "stop")))
    noise = np.random.default_rng(1).normal(0, 30, 16_000).astype(np.int16)
    assert [result for result in engine.hear(np.concatenate([np.zeros(16_000, np.int16), noise])) if result.text] == []
    assert [result for result in engine.finish() if result.text] == []


def test_finish_at_frame_end_works_with_real_library():
    engine = PocketsphinxEngine(EngineOptions(("forward", "stop")))
    sound = say(WORDS["forward"], silence=0.6)
    speech_end = 480 * (int(np.flatnonzero(np.abs(sound.astype(int)) > 500)[-1]) // 480)
    list(engine.hear(sound[:speech_end]))
    (result,) = engine.finish()
    assert result.final
    assert 0.0 <= result.confidence <= 1.0


def test_words_missing_from_real_dictionary_are_reported():
    diagnostic = engine_rejection(("go forward", "engage the frobnicator", "前进"))
    assert diagnostic.code == "VOICE103"
    assert "'frobnicator', '前进'" in str(diagnostic.message)


def test_unsupported_language_is_rejected():
    assert engine_rejection(("前进",), "zh").code == "VOICE105"


def test_folder_without_model_is_rejected(tmp_path):
    assert engine_rejection(("stop",), "en", tmp_path).code == "VOICE104"
    (tmp_path / "mdef").write_text("nothing")
    (tmp_path / "words.dict").write_text("stop S T AA P\n")
    assert engine_rejection(("stop",), "en", tmp_path).code == "VOICE104"
    assert engine_rejection(("stop",), "en", tmp_path / "nowhere").code == "VOICE104"


@pytest.mark.parametrize(
    ("file_name", "content"),
    [("mdef", b"nothing"), ("mdef", b"BMDF\x01\0\0\0" + 40 * b"\xff"), ("means", b"")],
    ids=["text", "numbers", "empty"],
)
def test_damaged_model_is_reported_without_crash(tmp_path, file_name, content):
    model = Path(pocketsphinx.get_model_path()) / "en-us"
    folder = tmp_path / "model"
    shutil.copytree(model / "en-us", folder)
    shutil.copy(model / "cmudict-en-us.dict", folder)
    (folder / file_name).write_bytes(content)
    diagnostic = engine_rejection(("stop",), "en", folder)
    assert diagnostic.code == "VOICE104"
    assert str(folder) in str(diagnostic.message)


def test_user_model_is_loaded(tmp_path):
    model = Path(pocketsphinx.get_model_path()) / "en-us"
    shutil.copytree(model / "en-us", tmp_path / "model")
    (tmp_path / "model" / "words.dict").write_text("stop S T AA P\n")
    PocketsphinxEngine(EngineOptions(("stop",), "en", tmp_path / "model")).close()


def test_missing_pocketsphinx_is_reported(monkeypatch):
    monkeypatch.setitem(sys.modules, "pocketsphinx", None)
    diagnostic = engine_rejection(("stop",))
    assert diagnostic.code == "VOICE102"
    assert diagnostic.hint == install_hint("voice")
