"""The engine vosk with a scripted fake recognizer.

Tests cannot have a model of Vosk.
"""

from __future__ import annotations

import sys

import numpy as np
import pytest

from linkwright.diagnostics import LinkwrightError, install_hint
from linkwright.speech.engine import EngineOptions, Heard
from linkwright.speech.engines.vosk_engine import MIN_CONFIDENCE, VoskEngine
from tests.speech.engines import fake_vosk

SILENT_BLOCK = np.zeros(1_600, np.int16)
ENGLISH_WORDS = ("forward", "turn left", "stop", "turn left now")


@pytest.fixture(autouse=True)
def vosk(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "vosk", fake_vosk)
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))
    for record in (fake_vosk.SCRIPT, fake_vosk.MADE, fake_vosk.LEVELS):
        record.clear()
    monkeypatch.setattr(fake_vosk, "WORDS", {"forward", "turn", "left", "stop", "now", "go"})
    return fake_vosk


@pytest.fixture
def model(tmp_path):
    (tmp_path / "model" / "am").mkdir(parents=True)
    (tmp_path / "model" / "am" / "final.mdl").write_bytes(b"model")
    return tmp_path / "model"


def make_engine(model, phrases=ENGLISH_WORDS, language="en"):
    return VoskEngine(EngineOptions(phrases, language, model))


def recognize_script(engine, *script):
    """Return the results of as many blocks as the script has items."""
    fake_vosk.SCRIPT[:] = script
    return [result for _ in script for result in engine.hear(SILENT_BLOCK)]


def engine_rejection(*arguments, **options):
    with pytest.raises(LinkwrightError) as error:
        make_engine(*arguments, **options)
    (diagnostic,) = error.value.diagnostics
    return diagnostic


def test_grammar_has_phrases_and_unknown_token(model, vosk):
    make_engine(model)
    (recognizer,) = vosk.MADE
    assert recognizer.grammar == [*ENGLISH_WORDS, "[unk]"]
    assert recognizer.rate == 16_000
    assert vosk.LEVELS == [-1]  # quiet


def test_phrase_has_lowest_word_confidence_and_times(model):
    recognizer = make_engine(model)
    results = recognize_script(recognizer, "", "", "", "", "", "", "", [("turn", 0.8), ("left", 0.95)])
    assert results == [Heard("turn left", 0.8, True, pytest.approx(0.2), pytest.approx(0.8))]


def test_silence_gives_no_result(model):
    assert recognize_script(make_engine(model), "", [], "") == []


@pytest.mark.parametrize(
    ("words", "nearest"),
    [
        ([("[unk]", 1.0)], ""),
        ([("[unk]", 1.0), ("forward", 1.0)], ""),
        ([("forward", MIN_CONFIDENCE - 0.01)], "forward"),
        ([("turn", 0.5), ("left", 1.0)], "turn left"),
        ([("forward", 0.2)], ""),
        ([("forward", 0.5), ("stop", 0.5)], ""),
        ([("turn", 1.0)], ""),
        ([("left", 1.0), ("turn", 1.0)], ""),
    ],
)
def test_unknown_speech_gives_empty_text_and_nearest_phrase(words, nearest, model):
    (result,) = recognize_script(make_engine(model), "", words)
    assert (result.text, result.final, result.nearest) == ("", True, nearest)


def test_consecutive_phrases_are_separated(model):
    results = recognize_script(make_engine(model), [("turn", 1.0), ("left", 0.9), ("now", 0.7), ("stop", 1.0)])
    assert [(result.text, result.confidence) for result in results] == [("turn left now", 0.7), ("stop", 1.0)]


def test_partials_are_reported_on_change_if_they_are_phrases(model):
    recognizer = make_engine(model)
    results = recognize_script(recognizer, "", "turn", "turn left", "turn left", "turn left now")
    assert [(result.text, result.final) for result in results] == [("turn left", False), ("turn left now", False)]
    assert results[0].start == pytest.approx(0.2)
    assert results[0].end == pytest.approx(0.3)
    assert [result.text for result in recognize_script(recognizer, [("stop", 1.0)], "stop")] == ["stop", "stop"]


def test_stop_within_other_speech_is_reported_as_partial(model):
    results = recognize_script(make_engine(model), "[unk]", "[unk] stop", [("[unk]", 1.0), ("stop", 1.0)])
    assert [(result.text, result.final) for result in results] == [("stop", False), ("", True)]


def test_finish_ends_utterance(model):
    recognizer = make_engine(model)
    recognize_script(recognizer, "forward")
    assert [(result.text, result.final) for result in recognizer.finish()] == [("forward", True)]
    assert list(recognizer.finish()) == []
    assert list(recognizer.hear(np.zeros(0, np.int16))) == []


def test_chinese_phrases_are_segmented_into_model_words(model, vosk, monkeypatch):
    monkeypatch.setattr(vosk, "WORDS", {"前进", "向", "左", "转", "左转", "停"})
    recognizer = make_engine(model, ("前进", "向左", "向左转", "停"), "zh")
    assert vosk.MADE[0].grammar == ["前进", "向 左", "向 左转", "停", "[unk]"]
    results = recognize_script(recognizer, [("向", 1.0), ("左", 1.0)], [("向", 1.0), ("左转", 1.0)])
    assert [result.text for result in results] == ["向左", "向左转"]


def test_phrase_matching_ignores_case(model):
    recognizer = make_engine(model, ("Turn Left",))
    assert [result.text for result in recognize_script(recognizer, [("turn", 1.0), ("left", 1.0)])] == ["Turn Left"]


def test_words_missing_from_model_are_reported_together(model, vosk, monkeypatch):
    diagnostic = engine_rejection(model, ("forward", "engage hyperdrive", "stop", "hyperdrive off"))
    assert diagnostic.code == "VOICE103"
    assert "'engage', 'hyperdrive', 'off'" in str(diagnostic.message)
    monkeypatch.setattr(vosk, "WORDS", {"向"})
    assert "'向龘'" in str(engine_rejection(model, ("向龘",), "zh").message)


def test_default_model_of_language_is_used(tmp_path, monkeypatch):
    diagnostic = engine_rejection(None, language="zh-CN")
    assert diagnostic.code == "MODEL102"
    assert "linkwright models get vosk-zh" in str(diagnostic.hint)
    folder = tmp_path / "data" / "linkwright" / "models" / "vosk-model-small-en-us-0.15" / "am"
    folder.mkdir(parents=True)
    (folder / "final.mdl").write_bytes(b"model")
    assert make_engine(None, language="en-US")


def test_language_without_default_model_is_rejected(model):
    diagnostic = engine_rejection(None, language="de")
    assert diagnostic.code == "VOICE105"
    assert make_engine(model, language="de")


@pytest.mark.parametrize("content", [None, b"broken"])
def test_folder_without_model_is_rejected(content, tmp_path):
    if content is not None:
        (tmp_path / "am").mkdir()
        (tmp_path / "am" / "final.mdl").write_bytes(content)
    diagnostic = engine_rejection(tmp_path)
    assert diagnostic.code == "VOICE104"
    assert str(tmp_path) in str(diagnostic.message)


def test_missing_vosk_is_reported(model, monkeypatch):
    monkeypatch.setitem(sys.modules, "vosk", None)
    diagnostic = engine_rejection(model)
    assert diagnostic.code == "VOICE102"
    assert diagnostic.hint == install_hint("voice")
