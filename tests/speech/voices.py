"""Synthetic words: phones of a source-filter voice, with variable speed, pitch, and noise."""

from __future__ import annotations

import numpy as np

from linkwright.speech.sound.samples import RATE, Samples

_PHONES = {
    # the first three formants in Hz, the voiced fraction, the duration in seconds
    "a": ((750, 1250, 2500), 1.0, 0.14),
    "e": ((500, 1850, 2550), 1.0, 0.12),
    "i": ((290, 2250, 3000), 1.0, 0.12),
    "o": ((480, 900, 2450), 1.0, 0.14),
    "u": ((310, 750, 2300), 1.0, 0.12),
    "m": ((260, 1100, 2200), 0.5, 0.08),
    "r": ((400, 1250, 1600), 0.8, 0.07),
    "s": ((4800, 5600, 6600), 0.0, 0.11),
    "f": ((1500, 4200, 7000), 0.0, 0.09),
    "t": ((3600, 4500, 6000), 0.0, 0.03),
    "p": ((600, 1100, 2400), 0.0, 0.03),
    ".": ((500, 1500, 2500), -1.0, 0.06),  # a closure: silence
}
WORDS = {
    "forward": "forar.t",
    "back": ".pae.t",
    "turn left": ".true.fi.t",
    "turn right": ".trurai.t",
    "stop": "s.to.p",
}
"""The names of words, and their phones in approximate pronunciation."""


def say(
    phones: str,
    *,
    speed: float = 1.0,
    pitch: float = 120.0,
    size: float = 1.0,
    level: float = 3000.0,
    silence: float = 0.5,
    noise: float = 3.0,
    seed: int = 0,
) -> Samples:
    """Return a recording of a word.

    Args:
        phones: the letters of known phones; a full stop is a closure.
        speed: the factor of speed.
        pitch: the pitch in Hz.
        size: the size of the speaker, which divides the formants.
        level: the effective value of the word.
        silence: the seconds of silence before and after.
        noise: the effective value of the white noise.
        seed: the seed of noise and breath.
    """
    rng = np.random.default_rng(seed)
    targets, durations = zip(*((_PHONES[phone][:2], _PHONES[phone][2] / speed) for phone in phones), strict=True)
    ends = np.cumsum(durations)
    count = int(ends[-1] * RATE)
    times = np.arange(count) / RATE
    phone_centers = ends - np.array(durations) / 2
    voiced = np.interp(times, phone_centers, [share for _, share in targets])
    phase = 2 * np.pi * np.cumsum(pitch * (1.1 - 0.2 * times / ends[-1])) / RATE
    sound = np.zeros(count)
    breath = rng.normal(size=count)
    for formant in range(3):
        hertz = np.interp(times, phone_centers, [formants[formant] for formants, _ in targets]) / size
        carrier = np.cos(2 * np.pi * np.cumsum(hertz) / RATE)
        hum = np.exp(6.0 * (np.cos(phase) - 1.0))
        hiss = np.convolve(breath, np.ones(12) / 3.5, "same")
        sound += (
            (np.maximum(voiced, 0.0) * hum + 0.4 * np.clip(1.0 - np.abs(voiced), 0, 1) * hiss) * carrier / (1 + formant)
        )
    sound += 0.05 * breath * np.maximum(voiced, 0.0)
    sound *= np.clip((voiced + 1.0) * 3.0, 0.0, 1.0)
    sound *= level / np.sqrt(np.mean(sound**2))
    silence_samples = np.zeros(int(silence * RATE))
    recording = np.concatenate((silence_samples, sound, silence_samples))
    recording += noise * rng.normal(size=len(recording))
    return np.clip(np.rint(recording), -32_768, 32_767).astype(np.int16)


def babble(seconds: float, rng: np.random.Generator) -> np.ndarray:
    """Return three simultaneous speakers with pauses between their words.

    The effective value is 1.
    """
    count = int(seconds * RATE)
    total = np.zeros(count)
    sounds = [phone for phone in _PHONES if phone != "."]
    for _ in range(3):
        phones = "".join("".join(rng.choice(sounds, size=3)) + "....." for _ in range(round(2 * seconds)))
        speed, pitch, size = rng.uniform((0.85, 90.0, 0.85), (1.1, 220.0, 1.1))
        samples = say(phones, speed=speed, pitch=pitch, size=size, silence=0.0, noise=0.0, seed=int(rng.integers(1000)))
        total += np.roll(np.resize(samples.astype(np.float64), count), int(rng.integers(count)))
    return np.asarray(total / np.sqrt(np.mean(total**2)))


def add_noise(samples: Samples, noise: np.ndarray, decibels: float, level: float) -> Samples:
    """Add noise to a recording; its level is a number of decibels below the level of the word."""
    return np.rint(samples + level / 10 ** (decibels / 20) * noise[: len(samples)]).astype(np.int16)
