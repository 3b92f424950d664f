"""Voice activity detection: compares the energy of frames with an adaptive noise floor.

During silence, the floor of each band follows the power of the band. During speech it falls with the power, and rises
only to the minimum of the band in the last 0.8 s (minimum statistics, after R. Martin). A fan that is switched on thus
counts as speech for no longer than that.
"""

from __future__ import annotations

from collections import deque

import numpy as np
from numpy.typing import NDArray

from linkwright.speech.sound.spectra import BANDS, Powers

HANGOVER = 40
"""Frames without speech after which an utterance is over: 0.4 s, longer than the closure of a plosive."""

_LEAST_POWER = 1.0  # below the noise of any microphone at 16 bits
_BEGINS, _GOES_ON = 3.0, 2.0  # dB above the floor, mean over all bands in the last frames
_IN_A_TAKE = 4.0  # dB, for an example, which must be clear
_MOST_OF_A_BAND = 25.0  # dB: a single band, as in a whistle, is not speech
_BELOW_THE_LOUDEST = 45.0  # dB: softer sound does not belong to a take, regardless of the noise
_SMOOTHED = 3  # number of frames
_TO_BEGIN = 4  # number of consecutive frames
_WATCHED = 80  # number of frames in which the minimum is searched for
_OVER_THE_LEAST = 1.4  # ratio of the noise's mean to its minimum, for sums of three frames
_UP, _DOWN = 0.05, 0.08  # fractions by which the floor approaches the level with each frame

_LOUDEST = 12  # number of frames
_SOFTER = 7.0  # dB below the loudest: speech at the microphone is louder than other sounds by this amount
_SOFT_BEGINNING = 8  # frames by which a word may start before it reaches this level
_ENOUGH = 15  # the minimum number of frames for measuring the noise
_UNSTEADY = 1.2  # dB, deviation of the level: 1 for steady noise, 2 and more for babble
_OVER_STEADY = 5.0  # dB, median above that of steady noise: up to 4 for steady noise, 8 and more for babble
_DEVIATIONS = 1.5  # standard deviations by which swelling noise exceeds its mean


class VoiceActivity:
    """Detects speech in a stream, frame by frame.

    Attributes:
        speaking: whether the last frame belongs to an utterance, including its hangover.
        quiet_frames: the number of frames since the last frame with speech.
        floor: the power of the noise, shape ``(BANDS,)``.
    """

    def __init__(self) -> None:
        self.speaking = False
        self.quiet_frames = 0
        self.floor: NDArray[np.float64] = np.full(BANDS, _LEAST_POWER)
        self._last: deque[NDArray[np.float64]] = deque(maxlen=_SMOOTHED)
        self._watched: deque[NDArray[np.float64]] = deque(maxlen=_WATCHED)
        self._seen = 0
        self._loud = 0

    def step(self, frame: NDArray[np.float64]) -> bool:
        """Process the next frame, shape ``(BANDS,)``; return `speaking`."""
        self._last.append(frame)
        smooth = np.maximum(sum(self._last) / len(self._last), _LEAST_POWER)
        self._watched.append(smooth)
        self._seen += 1
        if self._seen == 1:
            self.floor = smooth
        # Runs a hundred times a second: minimum and maximum take half the time of clip and mean.
        bands = np.minimum(np.maximum(10.0 * np.log10(smooth / self.floor), 0.0), _MOST_OF_A_BAND)
        loud = float(bands.sum()) / BANDS > (_GOES_ON if self.speaking else _BEGINS)
        self._loud = self._loud + 1 if loud else 0
        self.quiet_frames = 0 if loud else self.quiet_frames + 1
        if self._loud >= _TO_BEGIN:
            self.speaking = True
        elif self.quiet_frames >= HANGOVER:
            self.speaking = False
        self._follow(smooth, loud=loud)
        return self.speaking

    def end(self) -> None:
        """End the utterance, even if speech follows."""
        self.speaking = False
        self._loud = 0

    def _follow(self, smooth: NDArray[np.float64], *, loud: bool) -> None:
        lower = smooth < self.floor
        rate = np.where(lower, _DOWN, 0.0 if loud else max(_UP, 1.0 / self._seen))
        self.floor = self.floor + rate * (smooth - self.floor)
        if self._seen % 10 == 0 and len(self._watched) == _WATCHED:
            self.floor = np.maximum(self.floor, _OVER_THE_LEAST * np.min(self._watched, axis=0))


def unsteady_noise(powers: Powers, floor: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """Return the level of noise that swells and fades, such as other people's talk around a word.

    The floor follows the minimum of such noise, and most of the noise is far above it. The level before the speech, and
    its deviation, distinguish this noise from steady noise and from a word that starts softly.

    Args:
        powers: the powers of an utterance and of the sound before it.
        floor: the assumed power of the noise, shape ``(BANDS,)``.

    Returns:
        The power of each band, never below the floor, shape ``(BANDS,)``; None if the floor describes the noise.
    """
    before = np.maximum(powers[: _first_loud(powers) - _SOFT_BEGINNING], _LEAST_POWER)
    if len(before) < _ENOUGH:
        return None
    smooth = (before[:-2] + before[1:-1] + before[2:]) / 3.0
    steady = np.minimum(floor, _OVER_THE_LEAST * smooth.min(axis=0))  # the floor may not have fallen to the noise yet
    above = np.mean(10.0 * np.log10(before / steady), axis=1)
    changes = np.convolve(above, np.full(_SMOOTHED, 1.0 / _SMOOTHED), "valid")
    if np.median(above) < _OVER_STEADY or changes.std() < _UNSTEADY:
        return None
    noise: NDArray[np.float64] = np.maximum(floor, before.mean(axis=0) + _DEVIATIONS * before.std(axis=0))
    return noise


def _first_loud(powers: Powers) -> int:
    """Return the index of the first frame within `_SOFTER` dB of the loudest, at least `_SOFT_BEGINNING`."""
    totals = np.convolve(powers.sum(axis=1), np.full(_SMOOTHED, 1.0 / _SMOOTHED), "same")
    loudest = np.sort(totals)[-_LOUDEST:].mean()
    return max(_SOFT_BEGINNING, int(np.argmax(totals > 10.0 ** (-_SOFTER / 10.0) * loudest)))


def speech_span(powers: Powers) -> tuple[int, int, NDArray[np.float64]]:
    """Return the longest section of speech in a complete sound.

    Returns:
        The first frame of the section, the frame after its last, and the noise floor, shape ``(BANDS,)``; the two
        frames are equal if there is no speech.
    """
    if len(powers) < _TO_BEGIN:
        return 0, 0, np.full(BANDS, _LEAST_POWER)
    smooth = np.maximum(powers, _LEAST_POWER)
    smooth[1:-1] = (smooth[:-2] + smooth[1:-1] + smooth[2:]) / 3.0
    floor = np.maximum(_LEAST_POWER, _OVER_THE_LEAST * np.quantile(smooth, 0.1, axis=0))
    above = np.mean(np.clip(10.0 * np.log10(smooth / floor), 0.0, _MOST_OF_A_BAND), axis=1)
    # A browser's noise suppression gradually reduces the noise, so at first the noise is far above the floor.
    totals = smooth.sum(axis=1)
    heard = totals > 10.0 ** (-_BELOW_THE_LOUDEST / 10.0) * totals.max()
    loud = np.flatnonzero((above > _IN_A_TAKE) & heard)
    if not len(loud):
        return 0, 0, floor
    cuts = np.flatnonzero(np.diff(loud) > HANGOVER) + 1
    longest = max(np.split(loud, cuts), key=len)
    if len(longest) < _TO_BEGIN:
        return 0, 0, floor
    return int(longest[0]), int(longest[-1]) + 1, floor
