"""Enrolled words on synthetic speech: right, confused, false; noise, music, reading; how soon and at what cost.

Run it with ``python -m benchmarks voice``. The voices are those of espeak-ng, flite and festival that are installed.
Each speaker enrols eight commands, three times each at speeds and pitches some percent apart; it says them again
faster, slower, higher and lower, and words that are no commands. **No person was recorded**: a synthesiser says a word
much more alike each time than people do, so the figures are an upper bound.
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from benchmarks import voices
from benchmarks.measure import Row
from linkwright.speech.engine import EngineOptions, Heard
from linkwright.speech.enrolled.engine import EnrolledEngine
from linkwright.speech.enrolled.enrolment import enrol
from linkwright.speech.enrolled.words import Words
from linkwright.speech.sound.samples import BLOCK, RATE, Samples

ENROLLED = ((0.95, 0.95), (1.0, 1.0), (1.06, 1.05))
SAID = ((0.85, 1.1), (0.93, 0.85), (1.1, 1.15), (1.18, 0.92))
"""Speeds and pitches, relative to the speaker's own."""

CONDITIONS = {"clean": None, "15 dB": 15.0, "5 dB": 5.0}
"""Noise so far below the speech, white and pink in turn."""

_READ = 600.0  # seconds
_OTHER_SOUND = 60.0


@dataclass
class _Tally:
    """What became of clips."""

    commands: int = 0
    right: int = 0
    wrong: int = 0
    others: int = 0
    false: int = 0
    delays: list[float] = field(default_factory=list)

    def rows(self, about: str) -> Iterator[Row]:
        yield Row(
            f"{about}: right",
            100 * self.right / max(1, self.commands),
            "%",
            "95" if about in ("clean", "15 dB") else "",
        )
        yield Row(f"{about}: another command", 100 * self.wrong / max(1, self.commands), "%", "2")
        yield Row(f"{about}: a command from other words", 100 * self.false / max(1, self.others), "%", "2")


def engine(speaker: voices.Speaker, folder: Path) -> EnrolledEngine:
    """One that knows the commands as this speaker says them."""
    words, rng = Words(), np.random.default_rng(1)
    for name in voices.COMMANDS[speaker.language]:
        for speed, pitch in ENROLLED:
            said = voices.clip(voices.say(speaker, name, speed=speed, pitch=pitch), rng, level=3000.0)
            for finding in enrol(words, name, said):
                print(f"{speaker.voice}, '{name}': {finding.message}")
    path = folder / f"{speaker.program}-{speaker.voice}.json"
    words.write(path)
    return EnrolledEngine(EngineOptions(words.names, model=path))


def listen(engine: EnrolledEngine, samples: Samples) -> Iterator[tuple[float, Heard]]:
    """What is heard in a sound, with the seconds of it that had been given by then."""
    for at in range(0, len(samples), BLOCK):
        for heard in engine.hear(samples[at : at + BLOCK]):
            yield (at + BLOCK) / RATE, heard
    for heard in engine.finish():
        yield len(samples) / RATE, heard


def clips(speaker: voices.Speaker, decibels: float | None, seed: int) -> Iterator[tuple[str | None, Samples]]:
    """Commands and other words of a speaker; None for what is no command."""
    rng = np.random.default_rng(seed)
    commands: Iterable[str] = voices.COMMANDS[speaker.language]
    for name in commands:
        for turn, (speed, pitch) in enumerate(SAID):
            said = voices.say(speaker, name, speed=speed, pitch=pitch)
            kind, level = ("pink", "white")[turn // 2], (800.0, 3000.0)[turn % 2]
            yield name, voices.clip(said, rng, kind=kind, decibels=decibels, level=level)
    for turn, text in enumerate(voices.OTHERS[speaker.language]):
        speed, pitch = SAID[turn % len(SAID)]
        kind = ("pink", "white")[turn % 2]
        yield None, voices.clip(voices.say(speaker, text, speed=speed, pitch=pitch), rng, kind=kind, decibels=decibels)


def judge(
    engine: EnrolledEngine, speaker: voices.Speaker, decibels: float | None, tally: _Tally, seed: int = 7
) -> None:
    """Say all clips of a speaker to an engine. A partial counts as a command where it is the one for stopping."""
    stop = voices.STOP[speaker.language]
    for name, samples in clips(speaker, decibels, seed):
        heard = list(listen(engine, samples))
        acted = [one.text for _, one in heard if one.text and (one.final or one.text == stop)]
        if name is None:
            tally.others += 1
            tally.false += bool(acted)
            continue
        tally.commands += 1
        tally.right += bool(acted) and set(acted) == {name}
        tally.wrong += any(text != name for text in acted)
        if name == stop and name in acted:
            end = len(samples) / RATE - 0.5
            tally.delays.append(next(at for at, one in heard if one.text == name) - end)


def rows() -> list[Row]:
    """The table."""
    if voices.missing():
        print(f"not installed here, so without their voices: {', '.join(voices.missing())}")
    speakers = voices.installed()
    found: list[Row] = []
    with tempfile.TemporaryDirectory() as folder:
        engines = {speaker: engine(speaker, Path(folder)) for speaker in speakers}
        for about, decibels in CONDITIONS.items():
            tally = _Tally()
            for speaker in speakers:
                judge(engines[speaker], speaker, decibels, tally)
            found += tally.rows(about)
            if tally.delays:
                found.append(Row(f"{about}: stop known after its end, latest", 1e3 * max(tally.delays), "ms", "300"))
        found += _other_voices(engines)
        found += _no_commands(engines)
    return found


def _other_voices(engines: dict[voices.Speaker, EnrolledEngine]) -> list[Row]:
    """Each speaker says its commands to the engine of the next with the same program and language."""
    tally = _Tally()
    for speaker in engines:
        alike = [one for one in engines if (one.program, one.language) == (speaker.program, speaker.language)]
        other = alike[(alike.index(speaker) + 1) % len(alike)]
        if other != speaker:
            judge(engines[other], speaker, None, tally)
    return list(tally.rows("clean, another voice than enrolled")) if tally.commands else []


def _no_commands(engines: dict[voices.Speaker, EnrolledEngine]) -> list[Row]:
    """Commands from what is no speech, and from reading; and the time that silence takes."""
    if not engines:
        return []
    rng = np.random.default_rng(11)
    first = next(iter(engines.values()))
    count = int(_OTHER_SOUND * RATE)
    sounds = {kind: (600 * voices.noise(kind, count, rng)).astype(np.int16) for kind in ("white", "pink", "hum")}
    sounds |= {"silence": np.zeros(count, np.int16), "music": voices.music(_OTHER_SOUND, rng)}
    found = []
    for kind, samples in sounds.items():
        begun = time.process_time()
        commands = sum(bool(heard.text) for _, heard in listen(first, samples))
        took = time.process_time() - begun
        found.append(Row(f"a minute of {kind}: commands", commands, "", "0"))
        if kind in ("silence", "pink"):
            found.append(Row(f"a minute of {kind}: of a core", 100 * took / _OTHER_SOUND, "%", "2"))
    commands, seconds, spent = 0, 0.0, 0.0
    for speaker, said in voices.reading(_READ, list(engines)):
        begun = time.process_time()
        heard = list(listen(engines[speaker], voices.clip(said, rng, level=2000.0)))
        spent += time.process_time() - begun
        seconds += len(said) / RATE
        commands += sum(bool(one.text) for _, one in heard)
    found.append(Row(f"{seconds / 60:.0f} minutes of reading by the enrolled voices: commands", commands, "", "0"))
    found.append(Row("the same: of a core", 100 * spent / seconds, "%"))
    return found
