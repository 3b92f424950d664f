"""Enrolled words: accepted and rejected recordings, and the file."""

from __future__ import annotations

import json

import numpy as np
import pytest

from linkwright.diagnostics import LinkwrightError, Severity
from linkwright.speech.enrolled.enrollment import enroll
from linkwright.speech.enrolled.words import MAX_TAKES, MAX_WORDS, Words, find_words_path
from linkwright.speech.sound.spectra import BANDS
from tests.speech.voices import WORDS, say


def enrolled_words(names=("forward", "stop")):
    words = Words()
    for name in names:
        for number in range(3):
            assert enroll(words, name, say(WORDS[name], speed=0.95 + 0.05 * number, seed=number)) == ()
    return words


def test_words_keep_order_and_takes():
    words = enrolled_words()
    assert words.names == ("forward", "stop")
    assert len(words.takes("stop")) == 3
    assert words.takes("stop")[0].powers.shape[1] == BANDS
    assert words.takes("back") == ()


def test_word_can_be_removed():
    words = enrolled_words()
    words.remove("forward")
    words.remove("forward")
    assert words.names == ("stop",)


def test_words_file_round_trip_is_exact(tmp_path):
    words = enrolled_words()
    path = tmp_path / "a" / "words.json"
    words.write(path)
    words_read = Words.read(path)
    assert words_read.names == words.names
    for name in words.names:
        for original_take, read_take in zip(words.takes(name), words_read.takes(name), strict=True):
            assert np.array_equal(original_take.powers, read_take.powers)
            assert np.array_equal(original_take.noise, read_take.noise)


def test_word_names_in_any_language_are_kept(tmp_path):
    words = Words()
    enroll(words, "前进", say(WORDS["forward"]))
    words.write(tmp_path / "words.json")
    assert Words.read(tmp_path / "words.json").names == ("前进",)
    assert "前进" in (tmp_path / "words.json").read_text(encoding="utf-8")


def test_only_newest_takes_are_kept():
    words = Words()
    for number in range(MAX_TAKES + 2):
        enroll(words, "stop", say(WORDS["stop"], seed=number))
    assert len(words.takes("stop")) == MAX_TAKES


@pytest.mark.parametrize(
    ("samples", "code"),
    [
        (np.zeros(0, np.int16), "VOICE205"),
        (np.zeros(16_000, np.int16), "VOICE205"),
        (say(WORDS["stop"], level=20.0), "VOICE205"),
        (say(WORDS["stop"], level=300.0, noise=600.0), "VOICE205"),
        (say("a", speed=2.0), "VOICE206"),
        (say("a", speed=0.03), "VOICE206"),
        (say(WORDS["forward"], level=60_000.0), "VOICE207"),
    ],
)
def test_unsuitable_recording_is_rejected_with_reason(samples, code):
    words = Words()
    (finding,) = enroll(words, "stop", samples)
    assert (finding.code, finding.severity) == (code, Severity.ERROR)
    assert "'stop'" in str(finding.message)
    assert finding.hint is not None
    assert words.names == ()


@pytest.mark.parametrize("part", [slice(9_200, None), slice(0, 12_000)], ids=["beginning", "end"])
def test_truncated_word_is_rejected(part):
    words = Words()
    (finding,) = enroll(words, "forward", say(WORDS["forward"])[part])
    assert (finding.code, finding.severity) == ("VOICE211", Severity.ERROR)
    assert words.names == ()


def test_recording_with_gaps_is_rejected():
    words = Words()
    (finding,) = enroll(words, "forward", say(WORDS["forward"]), has_gaps=True)
    assert (finding.code, finding.severity) == ("VOICE212", Severity.ERROR)
    assert words.names == ()


@pytest.mark.parametrize(("name", "other"), [("forward", "back"), ("back", "stop"), ("stop", "turn left")])
def test_different_word_is_rejected_as_second_take(name, other):
    words = Words()
    assert enroll(words, name, say(WORDS[name], seed=1)) == ()
    (finding,) = enroll(words, name, say(WORDS[other], seed=2))
    assert finding.code == "VOICE208"
    assert enroll(words, name, say(WORDS[name], speed=1.1, pitch=130, seed=3)) == ()
    assert len(words.takes(name)) == 2


def test_take_unlike_previous_takes_is_rejected():
    words = enrolled_words()
    (finding,) = enroll(words, "stop", say("mumi", seed=5))
    assert (finding.code, finding.severity) == ("VOICE208", Severity.ERROR)
    assert len(words.takes("stop")) == 3


def test_word_similar_to_other_is_enrolled_with_warning():
    words = enrolled_words()
    assert enroll(words, "halt", say(WORDS["stop"], seed=6)) == ()
    (finding,) = enroll(words, "halt", say(WORDS["stop"], seed=7))
    assert (finding.code, finding.severity) == ("VOICE209", Severity.WARNING)
    assert "'halt'" in str(finding.message)
    assert "'stop'" in str(finding.message)
    assert len(words.takes("halt")) == 2


@pytest.mark.parametrize("name", ["", "  ", "a\nb", "x" * 200])
def test_invalid_word_name_is_rejected(name):
    (finding,) = enroll(Words(), name, say(WORDS["stop"]))
    assert finding.code == "VOICE204"


def test_number_of_words_is_limited():
    take = enrolled_words(("stop",)).takes("stop")
    words = Words({str(number): take[:1] for number in range(MAX_WORDS)})
    assert enroll(words, "more", say(WORDS["stop"]))[0].code == "VOICE204"
    assert enroll(words, "7", say(WORDS["stop"]))[0].code == "VOICE209"
    assert len(words.takes("7")) == 2


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda document: document.update(format="words"), "is not marked"),
        (lambda document: document.update(version=2), "version is '2', but only version 1 is supported"),
        (lambda document: document.update(words={}), "must contain a list of at most 200 words"),
        (lambda document: document["words"].append({"takes": []}), "word 3 has no valid name"),
        (lambda document: document["words"].append(document["words"][0]), "word 3 has no valid name, or the name of"),
        (lambda document: document["words"][1].update(takes=[]), "the word 'stop' must have 1 to 10 recordings"),
        (lambda document: document["words"][1]["takes"][0].update(frames="!"), "'stop' cannot be decoded"),
        (lambda document: document["words"][1]["takes"][0].update(frames=7), "'stop' cannot be decoded"),
        (lambda document: document["words"][1]["takes"][0].pop("noise"), "'stop' cannot be decoded"),
        (lambda document: document["words"][1]["takes"][0].update(frames="AAAA"), "the wrong length"),
    ],
)
def test_damaged_words_file_is_reported_with_hint(tmp_path, change, reason):
    path = tmp_path / "words.json"
    enrolled_words().write(path)
    document = json.loads(path.read_text(encoding="utf-8"))
    change(document)
    path.write_text(json.dumps(document), encoding="utf-8")
    with pytest.raises(LinkwrightError) as error:
        Words.read(path)
    (finding,) = error.value.diagnostics
    assert finding.code == "VOICE203"
    assert reason in str(finding.message)
    assert finding.hint is not None


@pytest.mark.parametrize("data", [b"", b"[1, 2", b"\xff\xfe", b"[" * 100_000, b"[]", b"null"])
def test_file_that_is_not_a_words_file_is_reported(tmp_path, data):
    path = tmp_path / "words.json"
    path.write_bytes(data)
    with pytest.raises(LinkwrightError) as error:
        Words.read(path)
    assert error.value.diagnostics[0].code == "VOICE203"


def test_json_error_is_reported_with_position(tmp_path):
    path = tmp_path / "words.json"
    path.write_text('{\n "format": }', encoding="utf-8")
    with pytest.raises(LinkwrightError) as error:
        Words.read(path)
    span = error.value.diagnostics[0].span
    assert (span.line, span.column) == (2, 12)


def test_missing_words_file_is_reported(tmp_path):
    with pytest.raises(LinkwrightError) as error:
        Words.read(tmp_path / "none.json")
    assert error.value.diagnostics[0].code == "VOICE202"


def test_words_file_is_in_user_configuration_folder(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    assert find_words_path() == tmp_path / "linkwright" / "voice" / "words.json"
