"""The engine vosk, with a recogniser that hears what a test says: no model of Vosk can be had in tests."""

from __future__ import annotations

import sys

import numpy as np
import pytest

from linkwright.diagnostics import LinkwrightError, install_hint
from linkwright.speech.engine import EngineOptions, Heard
from linkwright.speech.engines.vosk_engine import MIN_CONFIDENCE, VoskEngine
from tests.speech.engines import fake_vosk

BLOCK = np.zeros(1_600, np.int16)
ENGLISH = ("forward", "turn left", "stop", "turn left now")


@pytest.fixture(autouse=True)
def vosk(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "vosk", fake_vosk)
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))
    for each in (fake_vosk.SCRIPT, fake_vosk.MADE, fake_vosk.LEVELS):
        each.clear()
    monkeypatch.setattr(fake_vosk, "WORDS", {"forward", "turn", "left", "stop", "now", "go"})
    return fake_vosk


@pytest.fixture
def model(tmp_path):
    (tmp_path / "model" / "am").mkdir(parents=True)
    (tmp_path / "model" / "am" / "final.mdl").write_bytes(b"model")
    return tmp_path / "model"


def engine(model, phrases=ENGLISH, language="en"):
    return VoskEngine(EngineOptions(phrases, language, model))


def heard_by(engine, *script):
    """What is heard in as many blocks as the script has items."""
    fake_vosk.SCRIPT[:] = script
    return [each for _ in script for each in engine.hear(BLOCK)]


def refused(*given, **more):
    with pytest.raises(LinkwrightError) as caught:
        engine(*given, **more)
    (diagnostic,) = caught.value.diagnostics
    return diagnostic


def test_the_grammar_is_the_phrases_and_all_other_speech(model, vosk):
    engine(model)
    (recognizer,) = vosk.MADE
    assert recognizer.grammar == [*ENGLISH, "[unk]"]
    assert recognizer.rate == 16_000
    assert vosk.LEVELS == [-1]  # quiet


def test_a_phrase_with_its_least_certain_word_and_its_times(model):
    made = engine(model)
    heard = heard_by(made, "", "", "", "", "", "", "", [("turn", 0.8), ("left", 0.95)])
    assert heard == [Heard("turn left", 0.8, True, pytest.approx(0.2), pytest.approx(0.8))]


def test_silence_is_nothing(model):
    assert heard_by(engine(model), "", [], "") == []


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
def test_other_speech_is_heard_as_none_of_the_phrases(words, nearest, model):
    (heard,) = heard_by(engine(model), "", words)
    assert (heard.text, heard.final, heard.nearest) == ("", True, nearest)


def test_phrases_one_after_another(model):
    heard = heard_by(engine(model), [("turn", 1.0), ("left", 0.9), ("now", 0.7), ("stop", 1.0)])
    assert [(each.text, each.confidence) for each in heard] == [("turn left now", 0.7), ("stop", 1.0)]


def test_partials_come_when_they_change_and_are_phrases(model):
    made = engine(model)
    heard = heard_by(made, "", "turn", "turn left", "turn left", "turn left now")
    assert [(each.text, each.final) for each in heard] == [("turn left", False), ("turn left now", False)]
    assert heard[0].start == pytest.approx(0.2)
    assert heard[0].end == pytest.approx(0.3)
    assert [each.text for each in heard_by(made, [("stop", 1.0)], "stop")] == ["stop", "stop"]


def test_stop_in_the_middle_of_other_speech_is_a_partial(model):
    heard = heard_by(engine(model), "[unk]", "[unk] stop", [("[unk]", 1.0), ("stop", 1.0)])
    assert [(each.text, each.final) for each in heard] == [("stop", False), ("", True)]


def test_the_end_of_a_button_press_ends_the_utterance(model):
    made = engine(model)
    heard_by(made, "forward")
    assert [(each.text, each.final) for each in made.finish()] == [("forward", True)]
    assert list(made.finish()) == []
    assert list(made.hear(np.zeros(0, np.int16))) == []


def test_chinese_is_put_in_the_words_of_the_model(model, vosk, monkeypatch):
    monkeypatch.setattr(vosk, "WORDS", {"前进", "向", "左", "转", "左转", "停"})
    made = engine(model, ("前进", "向左", "向左转", "停"), "zh")
    assert vosk.MADE[0].grammar == ["前进", "向 左", "向 左转", "停", "[unk]"]
    heard = heard_by(made, [("向", 1.0), ("左", 1.0)], [("向", 1.0), ("左转", 1.0)])
    assert [each.text for each in heard] == ["向左", "向左转"]


def test_capitals_are_no_other_words(model):
    made = engine(model, ("Turn Left",))
    assert [each.text for each in heard_by(made, [("turn", 1.0), ("left", 1.0)])] == ["Turn Left"]


def test_words_that_the_model_lacks_are_named_at_once(model, vosk, monkeypatch):
    diagnostic = refused(model, ("forward", "engage hyperdrive", "stop", "hyperdrive off"))
    assert diagnostic.code == "VOICE103"
    assert "'engage', 'hyperdrive', 'off'" in str(diagnostic.message)
    monkeypatch.setattr(vosk, "WORDS", {"向"})
    assert "'向龘'" in str(refused(model, ("向龘",), "zh").message)


def test_the_models_of_the_table_are_used(tmp_path, monkeypatch):
    diagnostic = refused(None, language="zh-CN")
    assert diagnostic.code == "MODEL102"
    assert "linkwright models get vosk-zh" in str(diagnostic.hint)
    folder = tmp_path / "data" / "linkwright" / "models" / "vosk-model-small-en-us-0.15" / "am"
    folder.mkdir(parents=True)
    (folder / "final.mdl").write_bytes(b"model")
    assert engine(None, language="en-US")


def test_a_language_without_a_model(model):
    diagnostic = refused(None, language="de")
    assert diagnostic.code == "VOICE105"
    assert engine(model, language="de")


@pytest.mark.parametrize("content", [None, b"broken"])
def test_a_folder_without_a_model(content, tmp_path):
    if content is not None:
        (tmp_path / "am").mkdir()
        (tmp_path / "am" / "final.mdl").write_bytes(content)
    diagnostic = refused(tmp_path)
    assert diagnostic.code == "VOICE104"
    assert str(tmp_path) in str(diagnostic.message)


def test_without_vosk(model, monkeypatch):
    monkeypatch.setitem(sys.modules, "vosk", None)
    diagnostic = refused(model)
    assert diagnostic.code == "VOICE102"
    assert diagnostic.hint == install_hint("voice")
