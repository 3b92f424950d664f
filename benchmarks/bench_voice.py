"""Measure enrolled words on synthetic speech: errors, noise, music and reading, latency and cost.

Run it with ``python -m benchmarks voice``. The voices are those of espeak-ng, flite and festival that are installed.
Each speaker enrolls eight commands, three times each at speeds and pitches some percent apart; it says them again
faster, slower, higher and lower, and words that are no commands. **No person was recorded**: a synthesizer says a word
much more alike each time than people do, so the figures are an upper bound.
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field, fields
from pathlib import Path
from statistics import median

import numpy as np

from benchmarks import voices
from benchmarks.measure import Row
from linkwright.speech.engine import EngineOptions, Heard
from linkwright.speech.enrolled.engine import EnrolledEngine
from linkwright.speech.enrolled.enrollment import enroll
from linkwright.speech.enrolled.words import Words
from linkwright.speech.sound.samples import BLOCK, RATE, Samples

ENROLLED = ((0.95, 0.95), (1.0, 1.0), (1.06, 1.05))
SAID = ((0.85, 1.1), (0.93, 0.85), (1.1, 1.15), (1.18, 0.92))
"""Speeds and pitches relative to those of the speaker."""

CONDITIONS = {"clean": None, "15 dB": 15.0, "5 dB": 5.0}
"""The level of noise below the speech, alternately white and pink."""

_PROMISED = ("clean", "15 dB")
_OTHER_VOICE = "clean, another voice than enrolled"
_LONG = 600.0  # seconds
_SOUNDS = ("silence", "white", "pink", "hum", "music")
_SEED = 7


@dataclass
class _Tally:
    """The results of clips."""

    commands: int = 0
    right: int = 0
    wrong: int = 0
    others: int = 0
    false: int = 0
    delays: list[float] = field(default_factory=list)

    def __add__(self, other: _Tally) -> _Tally:
        return _Tally(*(getattr(self, field.name) + getattr(other, field.name) for field in fields(self)))

    def rows(self, about: str) -> Iterator[Row]:
        yield Row(
            f"{about}: right",
            100 * self.right / max(1, self.commands),
            "%",
            "95" if about in _PROMISED else "",
        )
        yield Row(f"{about}: another command", 100 * self.wrong / max(1, self.commands), "%", "2")
        if self.others:
            target = "2" if about in _PROMISED else ""
            yield Row(f"{about}: a command from other words", 100 * self.false / self.others, "%", target)


def engine(speaker: voices.Speaker, folder: Path) -> EnrolledEngine:
    """Return an engine with the commands that a speaker enrolled."""
    words, rng = Words(), np.random.default_rng(1)
    for name in voices.COMMANDS[speaker.language]:
        for speed, pitch in ENROLLED:
            said = voices.clip(voices.say(speaker, name, speed=speed, pitch=pitch), rng, level=3000.0)
            for finding in enroll(words, name, said):
                print(f"{speaker.voice}, '{name}': {finding.message}")
    words.write(_words_file(speaker, folder))
    return _made(speaker, folder)


def _words_file(speaker: voices.Speaker, folder: Path) -> Path:
    return folder / f"{speaker.program}-{speaker.voice}.json"


def _made(speaker: voices.Speaker, folder: Path) -> EnrolledEngine:
    return EnrolledEngine(EngineOptions(voices.COMMANDS[speaker.language], model=_words_file(speaker, folder)))


def listen(engine: EnrolledEngine, samples: Samples) -> Iterator[tuple[float, Heard]]:
    """Yield the recognized words of a sound, each with the seconds of sound processed so far."""
    for at in range(0, len(samples), BLOCK):
        for heard in engine.hear(samples[at : at + BLOCK]):
            yield (at + BLOCK) / RATE, heard
    for heard in engine.finish():
        yield len(samples) / RATE, heard


def clips(speaker: voices.Speaker, decibels: float | None, seed: int) -> Iterator[tuple[str | None, Samples]]:
    """Yield clips of a speaker, each with its command, or None for other words."""
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
    engine: EnrolledEngine, speaker: voices.Speaker, decibels: float | None, tally: _Tally, *, others: bool = True
) -> None:
    """Pass all clips of a speaker to an engine. A partial result counts as a command if it is the stop command."""
    stop = voices.STOP[speaker.language]
    for name, samples in clips(speaker, decibels, _SEED):
        if name is None and not others:
            continue
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
    """Measure, and return the rows of the table."""
    if voices.missing():
        print(f"not installed here, so without their voices: {', '.join(voices.missing())}")
    speakers = voices.installed()
    with tempfile.TemporaryDirectory() as folder, ProcessPoolExecutor() as pool:
        tallies = list(pool.map(_tallies, speakers, [Path(folder)] * len(speakers)))
        found: list[Row] = []
        for about in CONDITIONS:
            tally = sum((tally[about] for tally in tallies), _Tally())
            found += tally.rows(about)
            if tally.delays:
                found.append(Row(f"{about}: stop known after its end, median", 1e3 * median(tally.delays), "ms"))
                found.append(Row(f"{about}: stop known after its end, latest", 1e3 * max(tally.delays), "ms", "300"))
        other = sum((tally[_OTHER_VOICE] for tally in tallies), _Tally())
        found += list(other.rows(_OTHER_VOICE))
        if speakers:
            reading = pool.submit(_reading, speakers, Path(folder))
            for sound_rows in pool.map(_sound, _SOUNDS, speakers[:1] * len(_SOUNDS), [Path(folder)] * len(_SOUNDS)):
                found += sound_rows
            found += reading.result()
    return found


def _tallies(speaker: voices.Speaker, folder: Path) -> dict[str, _Tally]:
    """Return the results of the clips of a speaker in each condition, and of another voice."""
    made = engine(speaker, folder)
    found = {}
    for about, decibels in CONDITIONS.items():
        found[about] = _Tally()
        judge(made, speaker, decibels, found[about])
    found[_OTHER_VOICE] = _Tally()
    alike = [one for one in voices.installed() if (one.program, one.language) == (speaker.program, speaker.language)]
    other = alike[(alike.index(speaker) + 1) % len(alike)]
    if other != speaker:
        judge(made, other, None, found[_OTHER_VOICE], others=False)
    return found


def _sound(kind: str, speaker: voices.Speaker, folder: Path) -> list[Row]:
    """Measure false commands in ten minutes of sound without speech, and the processing time."""
    rng = np.random.default_rng(11)
    count = int(_LONG * RATE)
    if kind == "music":
        samples = voices.music(_LONG, rng)
    elif kind == "silence":
        samples = np.zeros(count, np.int16)
    else:
        samples = (600 * voices.noise(kind, count, rng)).astype(np.int16)
    begun = time.process_time()
    commands = sum(bool(heard.text) for _, heard in listen(_made(speaker, folder), samples))
    took = time.process_time() - begun
    found = [Row(f"{_LONG / 60:.0f} minutes of {kind}: commands", commands, "", "0")]
    if kind in ("silence", "pink"):
        found.append(Row("the same: of a core", 100 * took / _LONG, "%", "2"))
    return found


def _reading(speakers: list[voices.Speaker], folder: Path) -> list[Row]:
    """Measure false commands in texts that enrolled voices read."""
    rng = np.random.default_rng(12)
    engines = {speaker: _made(speaker, folder) for speaker in speakers}
    commands, stops, seconds, spent = 0, 0, 0.0, 0.0
    for speaker, said in voices.reading(_LONG, speakers):
        begun = time.process_time()
        heard = [one for _, one in listen(engines[speaker], voices.clip(said, rng, level=2000.0)) if one.text]
        spent += time.process_time() - begun
        seconds += len(said) / RATE
        commands += sum(one.final for one in heard)
        stops += sum(not one.final and one.text == voices.STOP[speaker.language] for one in heard)
    about = f"{seconds / 60:.0f} minutes of reading by enrolled voices"
    return [
        Row(f"{about}: commands", commands, "", "0"),
        Row(f"{about}: stops while it is being said", stops, ""),
        Row("the same: of a core", 100 * spent / seconds, "%"),
    ]
