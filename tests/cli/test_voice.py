"""`linkwright voice`: engines receive recordings in blocks, and words are stored in a file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from linkwright.cli import main
from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.loading import extensions
from linkwright.speech.engine import Heard, SpeechEngine
from linkwright.speech.sound.samples import BLOCK_LENGTH, RATE
from linkwright.speech.sound.wav import encode_wav
from tests.full_disk import full_disk, needs_limits

FORWARD, STOP, OTHER = 1_000, 2_000, 3_000
TEXTS = {FORWARD: "forward", STOP: "stop", OTHER: ""}


class ByLevel(SpeechEngine):
    """An engine that recognizes a phrase by the level of a sound, half a second after its end."""

    def __init__(self, options):
        assert "stop" in options.phrases or options.language == "zh"
        if options.language == "zh":
            hint = phrase("say it in English")
            raise LinkwrightError(Diagnostic("VOICE105", phrase("no Chinese"), hint=hint))
        self.heard, self.quiet, self.level, self.began = 0, 0, 0, 0

    def hear(self, samples):
        assert len(samples) <= BLOCK_LENGTH
        self.heard += len(samples)
        now, peak = self.heard / RATE, int(samples.max())
        if peak and not self.level:
            self.level, self.began = peak, now - 0.1
            return [Heard(TEXTS[peak], 0.6, False, self.began, now)]
        self.quiet = 0 if peak else self.quiet + 1
        if self.level and self.quiet == 5:
            text, self.level = TEXTS[self.level], 0
            return [Heard(text, 0.9, True, self.began, now - 0.5)]
        return []

    def finish(self):
        return []


@pytest.fixture(autouse=True)
def home(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    monkeypatch.chdir(tmp_path)
    entry = extensions.EntryPoint("level", f"{__name__}:ByLevel", "tests")
    monkeypatch.setattr("linkwright.speech.engine.extensions", lambda group: {"level": entry})
    return tmp_path


def recorded(name, level):
    silence = np.zeros(RATE // 2, np.int16)
    Path(name).write_bytes(encode_wav(np.concatenate((silence, np.full(RATE // 2, level, np.int16)))))
    return name


def word(name):
    """Return a tone of half a second with a rising pitch, between noisy silences."""
    times = np.arange(RATE // 2) / RATE
    tone = 6_000 * np.sin(2 * np.pi * (300 + 400 * times) * times) + 4_000 * np.sin(2 * np.pi * 1_500 * times)
    sound = np.concatenate((np.zeros(RATE // 2), tone, np.zeros(RATE // 2)))
    noise = np.random.default_rng(3).normal(0, 10, len(sound))
    Path(name).write_bytes(encode_wav((sound + noise).astype(np.int16)))
    return name


def test_voice_try_prints_command_times_and_latency(capsys):
    files = [recorded("a.wav", FORWARD), recorded("b.wav", OTHER), recorded("c.wav", STOP)]
    Path("d.wav").write_bytes(encode_wav(np.zeros(RATE, np.int16)))
    assert main(["voice", "try", *files, "d.wav", "--engine", "level"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.partition(", recognized")[0] for line in lines] == [
        "a.wav: 'forward' (0.90), command forward, 0.50 s to 1.00 s",
        "b.wav: none of the phrases, 0.50 s to 1.00 s",
        "c.wav: 'stop' (0.90), command stop, 0.50 s to 1.00 s",
        "d.wav: nothing recognized",
    ]
    assert " s later" in lines[0]


def test_voice_try_prints_partials_and_custom_commands(capsys, home):
    (home / "mine.yaml").write_text("commands:\n  halt:\n    phrases: {en: [stop]}\n    stop: true\n", encoding="utf-8")
    words = ["voice", "try", recorded("a.wav", STOP), recorded("b.wav", FORWARD)]
    assert main([*words, "--engine", "level", "--partials", "--commands", "mine.yaml"]) == 0
    lines = [line.partition(", 0.5")[0] for line in capsys.readouterr().out.splitlines()]
    assert lines == [
        "a.wav: partial: 'stop' (0.60)",
        "a.wav: 'stop' (0.90), command halt",
        "b.wav: partial: 'forward' (0.60)",
        "b.wav: 'forward' (0.90), no command",
    ]


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (["try", "nowhere.wav", "--engine", "level"], "VOICE401"),
        (["try", "a.wav", "--engine", "levle"], "VOICE101"),
        (["try", "a.wav", "--engine", "level", "--commands", "nowhere.yaml"], "VOICE301"),
        (["try", "a.wav", "--engine", "level", "--language", "zh"], "VOICE105"),
        (["forget", "stop"], "VOICE210"),
        (["enroll", "stop", "silence.wav"], "VOICE205"),
    ],
)
def test_invalid_input_is_one_error(words, code, capsys):
    recorded("a.wav", STOP)
    Path("silence.wav").write_bytes(encode_wav(np.zeros(RATE, np.int16)))
    assert main(["voice", *words]) == 1
    assert f"error[{code}]" in capsys.readouterr().err


def test_voice_engines_lists_missing_requirements(capsys):
    assert main(["voice", "engines"]) == 0
    assert capsys.readouterr().out.splitlines() == ["level en: ready", "level zh: no Chinese; say it in English"]


def test_words_are_enrolled_listed_and_removed(capsys, home):
    assert main(["voice", "words"]) == 0
    assert "no word is enrolled" in capsys.readouterr().err
    assert main(["voice", "enroll", "前进", word("a.wav"), word("b.wav")]) == 0
    printed = capsys.readouterr()
    assert printed.out == "'前进': 2 recordings\n"
    assert "3 recordings make the recognition more reliable" in printed.err
    assert (home / "config" / "linkwright" / "voice" / "words.json").is_file()
    assert main(["voice", "words"]) == 0
    assert capsys.readouterr().out == "'前进': 2 recordings\n"
    assert main(["voice", "forget", "前进"]) == 0
    assert main(["voice", "words"]) == 0
    assert "no word is enrolled" in capsys.readouterr().err


def test_unusable_recording_prevents_enrolling(capsys, home):
    Path("silence.wav").write_bytes(encode_wav(np.zeros(RATE, np.int16)))
    assert main(["voice", "enroll", "stop", word("a.wav"), "silence.wav", "--file", "mine.json"]) == 1
    printed = capsys.readouterr().err
    assert "'silence.wav'" in printed
    assert not (home / "mine.json").exists()


@needs_limits
def test_full_disk_keeps_enrolled_words(capsys, home):
    assert main(["voice", "enroll", "stop", word("a.wav"), "--file", "mine.json"]) == 0
    before = (home / "mine.json").read_bytes()
    with full_disk(50):
        assert main(["voice", "enroll", "stop", "a.wav", "--file", "mine.json"]) == 1
    assert "error[CLI201]" in capsys.readouterr().err
    assert (home / "mine.json").read_bytes() == before
