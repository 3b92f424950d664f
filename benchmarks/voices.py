"""Speech of the installed synthesizers: espeak-ng, flite and festival.

No speech is part of the project. Each clip is synthesized once and stored below ``.build/voices``. Speed and pitch are
relative to the speaker's own.
"""

from __future__ import annotations

import hashlib
import shutil
import subprocess
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.measure import ROOT
from linkwright.speech.sound.resampling import to_samples
from linkwright.speech.sound.samples import RATE, Samples
from linkwright.speech.sound.wav import read_wav

_CLIP_FOLDER = ROOT / ".build" / "voices"
_SPEED, _PITCH = 160, 50  # words per minute, and pitch from 0 to 99, of espeak-ng
_F0_HZ = {"slt": 180, "rms": 100, "awb": 120, "kal": 105}  # Hz, of flite's voices


def _split_words(words: str) -> tuple[str, ...]:
    return tuple(words.split(","))


COMMANDS = {
    "en": ("forward", "back", "left", "right", "stop", "faster", "slower", "go home"),
    "cmn": ("前进", "后退", "左转", "右转", "停止", "加速", "减速", "回家"),
    "yue": ("前進", "後退", "左轉", "右轉", "停止", "加速", "減速", "返屋企"),
}
STOP = {"en": "stop", "cmn": "停止", "yue": "停止"}
OTHER_WORDS = {
    "en": _split_words(
        "hello,good morning,thanks,yes,no,water,table,computer,banana,seven,music,window,light,shop,start,pack,night,"
        "photograph,yesterday,Peter,what time is it,the weather is nice today,open the door,where are you,"
        "my name is John,thank you"
    ),
    "cmn": _split_words(
        "你好,谢谢,再见,苹果,电脑,桌子,老师,红色,中国,学校,吃饭,明天,音乐,水,今天天气很好,现在几点,打开门,我叫小明"
    ),
    "yue": _split_words(
        "你好,多謝,再見,蘋果,電腦,枱,老師,紅色,香港,學校,食飯,聽日,音樂,水,今日天氣好好,而家幾點,開門,我叫小明"
    ),
}
"""Words and sentences that are not commands; some of one syllable resemble a command."""

READING_TEXTS = {
    "en": (
        "The harbour lay quiet in the early light. Two fishermen mended their nets and talked about the price of"
        " diesel, while a dog slept between the boxes. Later a ferry came in from the island, full of children on"
        " their way to school. Nobody was in a hurry. At noon the wind turned, and the first drops of rain fell on"
        " the tables in front of the cafe."
    ),
    "cmn": "清晨的港口很安静。两个渔民一边补网一边谈论柴油的价格，一只狗睡在箱子中间。"
    "后来一艘渡船从岛上开来，船上都是去上学的孩子。谁也不着急。",
}
"""Texts to read that contain no commands."""


@dataclass(frozen=True, slots=True)
class Speaker:
    """A voice of a synthesizer, and a language."""

    program: str
    voice: str
    language: str = "en"


SPEAKERS = (
    *(Speaker("espeak-ng", f"en-us+{name}") for name in ("f2", "f4", "m1", "m3", "m7", "Annie")),
    Speaker("espeak-ng", "en-gb-scotland"),
    *(Speaker("espeak-ng", f"cmn+{name}", "cmn") for name in ("f2", "m3", "m7")),
    *(Speaker("espeak-ng", f"yue+{name}", "yue") for name in ("f4", "m1")),
    *(Speaker("flite", name) for name in ("slt", "rms", "awb", "kal")),
    Speaker("festival", "kal_diphone"),
)


def list_installed() -> list[Speaker]:
    """Return the speakers whose program is installed."""
    return [speaker for speaker in SPEAKERS if shutil.which(_get_program(speaker))]


def list_missing() -> list[str]:
    """Return the programs that are not installed."""
    return sorted({speaker.program for speaker in SPEAKERS if not shutil.which(_get_program(speaker))})


def say(speaker: Speaker, text: str, *, speed: float = 1.0, pitch: float = 1.0) -> Samples:
    """Return a text as the speaker says it, without silence before and after."""
    key = hashlib.sha256(f"{speaker}{text}{speed:.3f}{pitch:.3f}".encode()).hexdigest()[:20]
    path = _CLIP_FOLDER / f"{key}.wav"
    if not path.exists():
        _CLIP_FOLDER.mkdir(parents=True, exist_ok=True)
        draft = path.with_suffix(".draft.wav")
        words, standard_input = _make_command(speaker, text, speed, pitch, draft)
        subprocess.run(words, input=standard_input, check=True, capture_output=True, text=True)
        draft.replace(path)
    samples = read_wav(path)
    loud = np.flatnonzero(np.abs(samples.astype(int)) > 40)
    return samples[loud[0] : loud[-1] + 1]


def make_noise(kind: str, count: int, rng: np.random.Generator) -> np.ndarray:
    """Return noise with an RMS of 1: white, pink, or mains hum with its harmonics."""
    if kind == "white":
        return rng.normal(size=count)
    if kind == "hum":
        times = np.arange(count) / RATE
        hum = sum(np.sin(2 * np.pi * 50 * k * times + k) / k for k in range(1, 12))
    else:
        spectrum = np.fft.rfft(rng.normal(size=count))
        hum = np.fft.irfft(spectrum / np.sqrt(np.maximum(np.arange(len(spectrum)), 20 * count / RATE)), count)
    return np.asarray(hum / np.sqrt(np.mean(np.square(hum))))


def make_clip(
    said: Samples,
    rng: np.random.Generator,
    *,
    kind: str = "white",
    decibels: float | None = None,
    level: float = 2000.0,
) -> Samples:
    """Return a recording at a level, with background noise below the speech.

    It has half a second of background before and after the speech.
    """
    speech = said.astype(np.float64)
    loud = np.sqrt(np.mean(speech**2))
    sound = np.concatenate((np.zeros(RATE // 2), speech * level / loud, np.zeros(RATE // 2)))
    background = 3.0 if decibels is None else level / 10 ** (decibels / 20)
    sound += background * make_noise("white" if decibels is None else kind, len(sound), rng)
    return to_samples(sound / 32_768.0)


def make_music(seconds: float, rng: np.random.Generator) -> Samples:
    """Return chords of plucked harmonic tones, half a second each, with a beat."""
    count = RATE // 2
    times = np.arange(count) / RATE
    parts = []
    for _ in range(int(seconds * 2)):
        root = 110 * 2 ** (rng.integers(0, 13) / 12)
        tones = [root * 2 ** (step / 12) for step in (0, 4 if rng.random() < 0.5 else 3, 7, 12)]
        chord = sum(np.sin(2 * np.pi * tone * k * times) / k**1.5 for tone in tones for k in range(1, 8)) * np.exp(
            -3 * times
        )
        beat = rng.normal(size=count) * np.exp(-40 * times)
        parts.append(600 * chord + 1500 * beat)
    return to_samples(np.concatenate(parts) / 32_768.0)


def iterate_reading(seconds: float, speakers: Sequence[Speaker]) -> Iterator[tuple[Speaker, Samples]]:
    """Let speakers read texts in turn, until a number of seconds is reached."""
    left = seconds * RATE
    turn = 0
    able = [speaker for speaker in speakers if speaker.language in READING_TEXTS]
    while able and left > 0:
        speaker = able[turn % len(able)]
        samples = say(speaker, READING_TEXTS[speaker.language], speed=0.85 + 0.05 * (turn // len(able) % 7))
        left -= len(samples)
        turn += 1
        yield speaker, samples


def _get_program(speaker: Speaker) -> str:
    return "text2wave" if speaker.program == "festival" else speaker.program


def _make_command(speaker: Speaker, text: str, speed: float, pitch: float, path: Path) -> tuple[list[str], str | None]:
    """Return the words of the command, and its input."""
    if speaker.program == "espeak-ng":
        numbers = ["-s", str(round(_SPEED * speed)), "-p", str(round(min(99, _PITCH * pitch)))]
        return ["espeak-ng", "-v", speaker.voice, *numbers, "-w", str(path), text], None
    if speaker.program == "flite":
        settings = ["--setf", f"duration_stretch={1 / speed:.3f}"]
        settings += ["--setf", f"int_f0_target_mean={_F0_HZ[speaker.voice] * pitch:.1f}"]
        return ["flite", "-voice", speaker.voice, *settings, "-t", text, "-o", str(path)], None
    stretch = f"(Parameter.set 'Duration_Stretch {1 / speed:.3f})"
    return ["text2wave", "-eval", f"(voice_{speaker.voice})", "-eval", stretch, "-o", str(path)], text
