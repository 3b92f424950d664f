"""Measure enrolled words on synthetic speech: errors, false commands, latency and cost.

Run it with ``python -m benchmarks voice``. The voices are the installed ones of espeak-ng, flite and festival. Each
speaker enrolls eight commands, three times each at speeds and pitches some percent apart. Then it says them faster,
slower, higher and lower, and says words that are not commands. **No person was recorded**: a synthesizer repeats a word
more precisely than people do, so the figures are an upper bound.
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
from linkwright.speech.sound.samples import BLOCK_LENGTH, RATE, Samples

ENROLLED_VARIANTS = ((0.95, 0.95), (1.0, 1.0), (1.06, 1.05))
SPOKEN_VARIANTS = ((0.85, 1.1), (0.93, 0.85), (1.1, 1.15), (1.18, 0.92))
"""Speeds and pitches relative to those of the speaker."""

NOISE_CONDITIONS = {"clean": None, "15 dB": 15.0, "5 dB": 5.0}
"""The level of noise below the speech, alternately white and pink."""

_PROMISED_CONDITIONS = ("clean", "15 dB")
_OTHER_VOICE = "clean, another voice than enrolled"
_SOUND_S = 600.0  # seconds
_SOUND_KINDS = ("silence", "white", "pink", "hum", "music")
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
            "95" if about in _PROMISED_CONDITIONS else "",
        )
        yield Row(f"{about}: another command", 100 * self.wrong / max(1, self.commands), "%", "2")
        if self.others:
            target = "2" if about in _PROMISED_CONDITIONS else ""
            yield Row(f"{about}: a command from other words", 100 * self.false / self.others, "%", target)


def enroll_speaker(speaker: voices.Speaker, folder: Path) -> EnrolledEngine:
    """Return an engine with the commands that a speaker enrolled."""
    words, rng = Words(), np.random.default_rng(1)
    for name in voices.COMMANDS[speaker.language]:
        for speed, pitch in ENROLLED_VARIANTS:
            samples = voices.make_clip(voices.say(speaker, name, speed=speed, pitch=pitch), rng, level=3000.0)
            for finding in enroll(words, name, samples):
                print(f"{speaker.voice}, '{name}': {finding.message}")
    words.write(_get_words_file(speaker, folder))
    return _make_engine(speaker, folder)


def _get_words_file(speaker: voices.Speaker, folder: Path) -> Path:
    return folder / f"{speaker.program}-{speaker.voice}.json"


def _make_engine(speaker: voices.Speaker, folder: Path) -> EnrolledEngine:
    return EnrolledEngine(EngineOptions(voices.COMMANDS[speaker.language], model=_get_words_file(speaker, folder)))


def recognize(engine: EnrolledEngine, samples: Samples) -> Iterator[tuple[float, Heard]]:
    """Yield the recognized words of a sound, each with the seconds of sound processed so far."""
    for start in range(0, len(samples), BLOCK_LENGTH):
        for heard in engine.hear(samples[start : start + BLOCK_LENGTH]):
            yield (start + BLOCK_LENGTH) / RATE, heard
    for heard in engine.finish():
        yield len(samples) / RATE, heard


def iterate_clips(speaker: voices.Speaker, decibels: float | None, seed: int) -> Iterator[tuple[str | None, Samples]]:
    """Yield clips of a speaker, each with its command, or None for other words."""
    rng = np.random.default_rng(seed)
    commands: Iterable[str] = voices.COMMANDS[speaker.language]
    for name in commands:
        for turn, (speed, pitch) in enumerate(SPOKEN_VARIANTS):
            speech = voices.say(speaker, name, speed=speed, pitch=pitch)
            kind, level = ("pink", "white")[turn // 2], (800.0, 3000.0)[turn % 2]
            yield name, voices.make_clip(speech, rng, kind=kind, decibels=decibels, level=level)
    for turn, text in enumerate(voices.OTHER_WORDS[speaker.language]):
        speed, pitch = SPOKEN_VARIANTS[turn % len(SPOKEN_VARIANTS)]
        kind = ("pink", "white")[turn % 2]
        yield (
            None,
            voices.make_clip(voices.say(speaker, text, speed=speed, pitch=pitch), rng, kind=kind, decibels=decibels),
        )


def judge_clips(
    engine: EnrolledEngine,
    speaker: voices.Speaker,
    decibels: float | None,
    tally: _Tally,
    *,
    others: bool = True,
) -> None:
    """Pass all clips of a speaker to an engine, and count its results.

    A partial result counts as a command if it is the stop command.
    """
    stop = voices.STOP[speaker.language]
    for name, samples in iterate_clips(speaker, decibels, _SEED):
        if name is None and not others:
            continue
        heard = list(recognize(engine, samples))
        acted = [result.text for _, result in heard if result.text and (result.final or result.text == stop)]
        if name is None:
            tally.others += 1
            tally.false += bool(acted)
            continue
        tally.commands += 1
        tally.right += bool(acted) and set(acted) == {name}
        tally.wrong += any(text != name for text in acted)
        if name == stop and name in acted:
            end = len(samples) / RATE - 0.5
            tally.delays.append(next(end_time for end_time, result in heard if result.text == name) - end)


def rows() -> list[Row]:
    """Measure, and return the rows of the table."""
    if voices.list_missing():
        print(f"not installed here, so without their voices: {', '.join(voices.list_missing())}")
    speakers = voices.list_installed()
    with tempfile.TemporaryDirectory() as folder, ProcessPoolExecutor() as pool:
        tallies = list(pool.map(_tally_conditions, speakers, [Path(folder)] * len(speakers)))
        table: list[Row] = []
        for about in NOISE_CONDITIONS:
            tally = sum((tally[about] for tally in tallies), _Tally())
            table += tally.rows(about)
            if tally.delays:
                table.append(Row(f"{about}: stop known after its end, median", 1e3 * median(tally.delays), "ms"))
                table.append(Row(f"{about}: stop known after its end, latest", 1e3 * max(tally.delays), "ms", "300"))
        other = sum((tally[_OTHER_VOICE] for tally in tallies), _Tally())
        table += list(other.rows(_OTHER_VOICE))
        if speakers:
            reading = pool.submit(_measure_reading, speakers, Path(folder))
            for sound_rows in pool.map(
                _measure_sound, _SOUND_KINDS, speakers[:1] * len(_SOUND_KINDS), [Path(folder)] * len(_SOUND_KINDS)
            ):
                table += sound_rows
            table += reading.result()
    return table


def _tally_conditions(speaker: voices.Speaker, folder: Path) -> dict[str, _Tally]:
    """Return the results of the clips of a speaker in each condition, and of another voice."""
    recognizer = enroll_speaker(speaker, folder)
    results = {}
    for about, decibels in NOISE_CONDITIONS.items():
        results[about] = _Tally()
        judge_clips(recognizer, speaker, decibels, results[about])
    results[_OTHER_VOICE] = _Tally()
    similar_speakers = [
        candidate
        for candidate in voices.list_installed()
        if (candidate.program, candidate.language) == (speaker.program, speaker.language)
    ]
    other = similar_speakers[(similar_speakers.index(speaker) + 1) % len(similar_speakers)]
    if other != speaker:
        judge_clips(recognizer, other, None, results[_OTHER_VOICE], others=False)
    return results


def _measure_sound(kind: str, speaker: voices.Speaker, folder: Path) -> list[Row]:
    """Measure false commands in ten minutes of sound without speech, and the processing time."""
    rng = np.random.default_rng(11)
    count = int(_SOUND_S * RATE)
    if kind == "music":
        samples = voices.make_music(_SOUND_S, rng)
    elif kind == "silence":
        samples = np.zeros(count, np.int16)
    else:
        samples = (600 * voices.make_noise(kind, count, rng)).astype(np.int16)
    begun = time.process_time()
    commands = sum(bool(heard.text) for _, heard in recognize(_make_engine(speaker, folder), samples))
    took = time.process_time() - begun
    table = [Row(f"{_SOUND_S / 60:.0f} minutes of {kind}: commands", commands, "", "0")]
    if kind in ("silence", "pink"):
        table.append(Row("the same: of a core", 100 * took / _SOUND_S, "%", "2"))
    return table


def _measure_reading(speakers: list[voices.Speaker], folder: Path) -> list[Row]:
    """Measure false commands in texts that enrolled voices read."""
    rng = np.random.default_rng(12)
    engines = {speaker: _make_engine(speaker, folder) for speaker in speakers}
    commands, stops, seconds, processor_s = 0, 0, 0.0, 0.0
    for speaker, speech in voices.iterate_reading(_SOUND_S, speakers):
        begun = time.process_time()
        heard = [
            result
            for _, result in recognize(engines[speaker], voices.make_clip(speech, rng, level=2000.0))
            if result.text
        ]
        processor_s += time.process_time() - begun
        seconds += len(speech) / RATE
        commands += sum(result.final for result in heard)
        stops += sum(not result.final and result.text == voices.STOP[speaker.language] for result in heard)
    about = f"{seconds / 60:.0f} minutes of reading by enrolled voices"
    return [
        Row(f"{about}: commands", commands, "", "0"),
        Row(f"{about}: stops while it is being said", stops, ""),
        Row("the same: of a core", 100 * processor_s / seconds, "%"),
    ]
