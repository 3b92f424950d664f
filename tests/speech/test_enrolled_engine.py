"""The engine of enrolled words, with synthetic words in blocks as from a microphone."""

from __future__ import annotations

from unittest.mock import Mock

import numpy as np
import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.speech.engine import EngineOptions, make_engine
from linkwright.speech.enrolled.engine import EnrolledEngine
from linkwright.speech.enrolled.enrollment import enroll
from linkwright.speech.enrolled.recognition import Guess
from linkwright.speech.enrolled.words import Words
from linkwright.speech.sound.samples import BLOCK_LENGTH, RATE
from tests.speech.voices import WORDS, add_noise, babble, say

OTHER_WORDS = ("mumi", "faso.t", "ri.tamu", "om", "se.pifu", "tatata", "u", "moramifu")
"""Words that are not commands, in the letters of `voices`."""


@pytest.fixture(scope="module")
def words():
    words = Words()
    for name, phones in WORDS.items():
        for number in range(3):
            assert (
                enroll(words, name, say(phones, speed=0.95 + 0.05 * number, pitch=115 + 5 * number, seed=number)) == ()
            )
    return words


@pytest.fixture
def path(words, tmp_path):
    words.write(tmp_path / "words.json")
    return tmp_path / "words.json"


@pytest.fixture
def engine(path):
    return EnrolledEngine(EngineOptions(tuple(WORDS), model=path))


def results_of(engine, samples, block=BLOCK_LENGTH):
    results = []
    for start in range(0, len(samples), block):
        results += engine.hear(samples[start : start + block])
    return results


def final_texts(engine, samples):
    return [result.text for result in results_of(engine, samples) if result.final]


@pytest.mark.parametrize("name", WORDS)
@pytest.mark.parametrize(("speed", "pitch", "level"), [(0.9, 122, 1000), (1.1, 117, 8000), (1.0, 120, 300)])
def test_word_is_recognized_at_other_speed_pitch_and_level(engine, name, speed, pitch, level):
    samples = say(WORDS[name], speed=speed, pitch=pitch, level=level, silence=0.8, seed=9)
    (result_of_word,) = [result for result in results_of(engine, samples) if result.final]
    assert result_of_word.text == name
    assert 0.5 < result_of_word.confidence <= 1.0
    assert abs(result_of_word.start - 0.8) < 0.15
    assert abs(result_of_word.end - (len(samples) / RATE - 0.8)) < 0.15


@pytest.mark.parametrize("name", WORDS)
def test_word_is_recognized_in_noise(engine, name):
    samples = say(WORDS[name], speed=1.05, level=2000, noise=2000 / 10 ** (15 / 20), silence=0.8, seed=10)
    assert final_texts(engine, samples) == [name]


def with_reverberation(samples, direct_db, seed):
    """Add a reverberation of 0.4 s.

    Its energy is `direct` dB below the energy of the direct sound.
    """
    times = np.arange(int(0.4 * RATE)) / RATE
    decay = np.random.default_rng(seed).normal(size=len(times)) * 10 ** (-3 * times / 0.4)
    decay *= 10 ** (-direct_db / 20) / np.sqrt(np.sum(decay**2))
    decay[0] = 1.0
    size = len(samples) + len(decay)
    sound = np.fft.irfft(np.fft.rfft(samples, size) * np.fft.rfft(decay, size), size)[: len(samples)]
    return np.rint(sound).astype(np.int16)


def results_in_room(engine, phones, number):
    samples = say(phones, speed=(0.9, 1.1)[number % 2], level=2000, silence=0.8, seed=20 + number)
    return final_texts(engine, with_reverberation(samples, 8.0, number))


def test_word_is_recognized_two_meters_away_in_room(engine):
    result = [(name, results_in_room(engine, WORDS[name], number)) for name in WORDS for number in range(3)]
    assert all(set(texts) <= {name, ""} for name, texts in result)
    assert sum(texts == [name] for name, texts in result) >= 13


@pytest.mark.parametrize("phones", OTHER_WORDS)
def test_unknown_word_is_not_recognized_in_room(engine, phones):
    assert set(results_in_room(engine, phones, 1)) <= {""}


def test_phrase_with_number_requires_higher_confidence(words, tmp_path, monkeypatch):
    phrases = ("stop", "two meters", "两米")
    words_with_numbers = Words({name: words.takes("stop") for name in phrases})
    words_with_numbers.write(tmp_path / "words.json")
    engine = EnrolledEngine(EngineOptions(phrases, model=tmp_path / "words.json"))
    for name, confidence, expected in (
        *((name, 0.6, name if name == "stop" else "") for name in phrases),
        *((name, 0.8, name) for name in phrases),
    ):
        monkeypatch.setattr(engine._recognizer, "guess", Mock(return_value=Guess(name, confidence, 0, 9)))
        assert final_texts(engine, say("mumi", silence=0.8)) == [expected]


def with_babble(phones, seed):
    samples = say(phones, speed=1.05, level=2000, silence=0.8, seed=10)
    return add_noise(samples, babble(len(samples) / RATE + 0.1, np.random.default_rng(seed)), 15.0, 2000.0)


def test_words_are_recognized_in_babble(path):
    right = []
    for name in ("forward", "turn left", "turn right", "stop"):
        for seed in range(1, 4):
            engine = EnrolledEngine(EngineOptions(tuple(WORDS), model=path))
            results = results_of(engine, with_babble(WORDS[name], seed)) + list(engine.finish())
            text = {result.text for result in results if result.final} - {""}
            assert text <= {name}
            right.append(text == {name})
    assert sum(right) >= 10


@pytest.mark.parametrize("phones", OTHER_WORDS)
def test_unknown_word_is_not_recognized_in_babble(engine, phones):
    results = results_of(engine, with_babble(phones, 1)) + list(engine.finish())
    assert {result.text for result in results} <= {""}


def test_babble_alone_is_not_recognized(engine):
    sound = np.rint(300 * babble(20.0, np.random.default_rng(4))).astype(np.int16)
    assert not [result.text for result in results_of(engine, sound) if result.text]


@pytest.mark.parametrize("phones", OTHER_WORDS)
def test_unknown_word_gives_empty_text(engine, phones):
    assert final_texts(engine, say(phones, silence=0.8, seed=11)) == [""]


@pytest.mark.parametrize("phones", ["s.to.s", "s.to.t", "s.to.f", ".pae.s"])
def test_word_differing_in_one_sound_is_not_recognized(engine, phones):
    samples = say(phones, level=2000, silence=0.8, seed=9)
    assert [result.text for result in results_of(engine, samples) if result.text] == []


def test_similar_utterance_reports_nearest_word(engine, path):
    noisy = say(WORDS["turn left"], speed=1.05, level=2000, noise=1000, silence=0.8, seed=1)
    (final_result,) = [result for result in results_of(engine, noisy) if result.final]
    assert (final_result.text, final_result.nearest) == ("", "turn left")
    # A word that is not a phrase is not reported.
    other_engine = EnrolledEngine(EngineOptions(("stop", "back"), model=path))
    (final_result,) = [result for result in results_of(other_engine, noisy) if result.final]
    assert (final_result.text, final_result.nearest) == ("", "")
    (final_result,) = [
        result for result in results_of(other_engine, say(OTHER_WORDS[0], silence=0.8, seed=11)) if result.final
    ]
    assert (final_result.text, final_result.nearest) == ("", "")


@pytest.mark.parametrize("kind", ["silence", "noise", "hum", "click", "chirp"])
def test_sound_without_speech_is_not_recognized(engine, kind):
    rng = np.random.default_rng(12)
    times = np.arange(10 * RATE) / RATE
    sound = {
        "silence": np.zeros(len(times)),
        "noise": 500 * rng.normal(size=len(times)) * (times > 3),
        "hum": 3000 * np.sin(2 * np.pi * 50 * times) + 1000 * np.sin(2 * np.pi * 150 * times),
        "click": 20_000.0 * (np.arange(len(times)) % RATE < 30) + rng.normal(size=len(times)),
        "chirp": 3000 * np.sin(2 * np.pi * (200 * times + 300 * times**2)) + rng.normal(size=len(times)),
    }[kind]
    assert not [result.text for result in results_of(engine, sound.astype(np.int16)) if result.text]


def test_partial_is_reported_within_300_ms_of_word(engine):
    samples = say(WORDS["stop"], silence=0.8, seed=13)
    end = len(samples) - int(0.8 * RATE)
    partial_time = None
    for start in range(0, len(samples), BLOCK_LENGTH):
        results = engine.hear(samples[start : start + BLOCK_LENGTH])
        if partial_time is None and any(result.text == "stop" for result in results):
            partial_time = start + BLOCK_LENGTH
            assert not results[0].final
    assert partial_time is not None
    assert partial_time - end <= 0.3 * RATE


def test_templates_are_computed_before_first_word(engine, monkeypatch):
    monkeypatch.setattr("linkwright.speech.enrolled.recognition.Templates", None)
    assert final_texts(engine, say(WORDS["stop"], silence=0.8, seed=13)) == ["stop"]


def test_finish_ends_utterance(engine):
    samples = say(WORDS["back"], silence=0.5, seed=14)
    results_of(engine, samples[: -int(0.45 * RATE)])
    (final_result,) = engine.finish()
    assert (final_result.text, final_result.final) == ("back", True)
    assert engine.finish() == []


@pytest.mark.parametrize("block", [37, 480, 16_000])
def test_results_do_not_depend_on_block_size(engine, block):
    sound = np.concatenate([say(WORDS[name], silence=0.6, seed=15) for name in ("forward", "stop")])
    assert [result.text for result in results_of(engine, sound, block) if result.final] == ["forward", "stop"]


def test_enrolled_words_outside_phrases_are_not_reported(path):
    engine = EnrolledEngine(EngineOptions(("stop",), model=path))
    assert final_texts(engine, say(WORDS["forward"], silence=0.8)) == [""]
    assert final_texts(engine, say(WORDS["stop"], silence=0.8)) == ["stop"]


def test_phrases_are_reported_with_requested_spelling(path):
    engine = EnrolledEngine(EngineOptions(("Turn  Left",), model=path))
    assert final_texts(engine, say(WORDS["turn left"], silence=0.8)) == ["Turn  Left"]


def test_long_speech_is_not_recognized(engine):
    sound = np.concatenate([say(WORDS[name], silence=0.0, seed=16) for name in list(WORDS) * 4])
    results = results_of(engine, np.concatenate((say("a", level=1.0), sound, np.zeros(RATE, np.int16))))
    assert [result.text for result in results if result.final] == [""]


def test_single_enrolled_word_is_recognized(words, tmp_path):
    single_word = Words({"stop": words.takes("stop")[:1]})
    single_word.write(tmp_path / "words.json")
    engine = EnrolledEngine(EngineOptions(("stop",), model=tmp_path / "words.json"))
    assert final_texts(engine, say(WORDS["stop"], silence=0.8, seed=17)) == ["stop"]
    assert final_texts(engine, say("mumi", silence=0.8, seed=18)) == [""]


def test_words_file_is_followed_when_created_changed_and_deleted(words, tmp_path):
    path = tmp_path / "words.json"
    engine = EnrolledEngine(EngineOptions(("stop", "back"), model=path))
    samples = say(WORDS["stop"], silence=0.8)
    assert engine.problem.code == "VOICE201"
    assert final_texts(engine, samples) == [""]
    words.write(path)
    assert final_texts(engine, samples) == ["stop"]
    assert engine.problem is None
    path.write_text("{", encoding="utf-8")
    assert final_texts(engine, samples) == ["stop"]
    assert engine.problem.code == "VOICE203"
    path.unlink()
    assert final_texts(engine, samples) == [""]
    assert engine.problem.code == "VOICE201"


def test_damaged_words_file_is_rejected_at_start(tmp_path):
    (tmp_path / "words.json").write_text("[]", encoding="utf-8")
    with pytest.raises(LinkwrightError) as error:
        make_engine("enrolled", EngineOptions(("stop",), model=tmp_path / "words.json"))
    assert error.value.diagnostics[0].code == "VOICE203"
