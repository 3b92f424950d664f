"""Voice activity detection with the energy of frames and an adaptive noise floor.

During silence, the floor of each band follows the power of the band. During speech it falls with the power, but rises
only to the minimum of the band in the last 0.8 s (minimum statistics, after R. Martin). So a fan that is switched on
counts as speech for no longer than that.
"""

from __future__ import annotations

from collections import deque

import numpy as np
from numpy.typing import NDArray

from linkwright.speech.sound.spectra import BANDS, Powers

HANGOVER_FRAMES = 40
"""The number of frames without speech that end an utterance: 0.4 s, longer than the closure of a plosive."""

_MIN_POWER = 1.0  # the minimum power of the noise floor, which is below the noise of any 16-bit microphone
_START_LEVEL_DB, _CONTINUE_LEVEL_DB = 3.0, 2.0  # in dB above the floor, as the mean over all bands in the last frames
_TAKE_LEVEL_DB = 4.0  # the minimum level of speech in a take in dB, because takes must be clear
_MAX_BAND_LEVEL_DB = (
    25.0  # the maximum level of a band in dB, because a single loud band, as in a whistle, is not speech
)
_MAX_BELOW_LOUDEST_DB = 45.0  # in dB; softer sound does not belong to a take, whatever the noise
_SMOOTHING_FRAMES = 3  # the number of frames over which levels are averaged
_START_FRAMES = 4  # the number of consecutive loud frames that start an utterance
_MINIMUM_FRAMES = 80  # the number of recent frames whose minimum is a lower bound of the noise floor
_MEAN_TO_MINIMUM = 1.4  # the ratio of the noise's mean to its minimum, for sums of three frames
_RISE_RATE, _FALL_RATE = 0.05, 0.08  # the fractions by which the floor approaches the level with each frame

_LOUDEST_FRAMES = 12  # the number of frames that determine the loudest level
_SPEECH_RANGE_DB = 7.0  # in dB below the loudest level; speech at the microphone is louder than other sounds by this
_SOFT_START_FRAMES = 8  # the number of frames by which a word may start before it reaches this level
_MIN_NOISE_FRAMES = 15  # the minimum number of frames for measuring the noise
_MIN_UNSTEADY_DEVIATION_DB = 1.2  # the deviation of the level in dB: 1 for steady noise, 2 and more for babble
_MIN_UNSTEADY_LEVEL_DB = 5.0  # the median level in dB above the floor: up to 4 for steady noise, 8 and more for babble
_NOISE_DEVIATIONS = 1.5  # the number of standard deviations by which unsteady noise exceeds its mean


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
        self.floor: NDArray[np.float64] = np.full(BANDS, _MIN_POWER)
        self._last_frames: deque[NDArray[np.float64]] = deque(maxlen=_SMOOTHING_FRAMES)
        self._smoothed_frames: deque[NDArray[np.float64]] = deque(maxlen=_MINIMUM_FRAMES)
        self._frame_count = 0
        self._loud_frames = 0

    def step(self, frame: NDArray[np.float64]) -> bool:
        """Process the next frame, shape ``(BANDS,)``, and return `speaking`."""
        self._last_frames.append(frame)
        smoothed = np.maximum(sum(self._last_frames) / len(self._last_frames), _MIN_POWER)
        self._smoothed_frames.append(smoothed)
        self._frame_count += 1
        if self._frame_count == 1:
            self.floor = smoothed
        # This runs a hundred times a second: minimum and maximum take half the time of clip and mean.
        band_levels = np.minimum(np.maximum(10.0 * np.log10(smoothed / self.floor), 0.0), _MAX_BAND_LEVEL_DB)
        is_loud = float(band_levels.sum()) / BANDS > (_CONTINUE_LEVEL_DB if self.speaking else _START_LEVEL_DB)
        self._loud_frames = self._loud_frames + 1 if is_loud else 0
        self.quiet_frames = 0 if is_loud else self.quiet_frames + 1
        if self._loud_frames >= _START_FRAMES:
            self.speaking = True
        elif self.quiet_frames >= HANGOVER_FRAMES:
            self.speaking = False
        self._update_floor(smoothed, is_loud=is_loud)
        return self.speaking

    def end(self) -> None:
        """End the utterance, even if more speech follows."""
        self.speaking = False
        self._loud_frames = 0

    def _update_floor(self, smoothed: NDArray[np.float64], *, is_loud: bool) -> None:
        is_lower = smoothed < self.floor
        rate = np.where(is_lower, _FALL_RATE, 0.0 if is_loud else max(_RISE_RATE, 1.0 / self._frame_count))
        self.floor = self.floor + rate * (smoothed - self.floor)
        if self._frame_count % 10 == 0 and len(self._smoothed_frames) == _MINIMUM_FRAMES:
            self.floor = np.maximum(self.floor, _MEAN_TO_MINIMUM * np.min(self._smoothed_frames, axis=0))


def estimate_unsteady_noise(powers: Powers, floor: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """Return the level of unsteady noise, such as other people's talk around a word.

    The floor follows the minimum of such noise, and most of the noise is far above it. The level before the speech, and
    its deviation, distinguish this noise from steady noise and from a word that starts softly.

    Args:
        powers: the powers of an utterance and of the sound before it.
        floor: the power of the noise, as assumed so far, shape ``(BANDS,)``.

    Returns:
        The power of each band, at least the floor, shape ``(BANDS,)``; None if the noise is steady.
    """
    lead_in = np.maximum(powers[: _find_first_loud_frame(powers) - _SOFT_START_FRAMES], _MIN_POWER)
    if len(lead_in) < _MIN_NOISE_FRAMES:
        return None
    smoothed = (lead_in[:-2] + lead_in[1:-1] + lead_in[2:]) / 3.0
    steady_noise = np.minimum(
        floor, _MEAN_TO_MINIMUM * smoothed.min(axis=0)
    )  # the floor may not have fallen to the noise yet
    level = np.mean(10.0 * np.log10(lead_in / steady_noise), axis=1)
    smoothed_level = np.convolve(level, np.full(_SMOOTHING_FRAMES, 1.0 / _SMOOTHING_FRAMES), "valid")
    if np.median(level) < _MIN_UNSTEADY_LEVEL_DB or smoothed_level.std() < _MIN_UNSTEADY_DEVIATION_DB:
        return None
    noise: NDArray[np.float64] = np.maximum(floor, lead_in.mean(axis=0) + _NOISE_DEVIATIONS * lead_in.std(axis=0))
    return noise


def _find_first_loud_frame(powers: Powers) -> int:
    """Return the index of the first frame within `_SPEECH_RANGE_DB` dB of the loudest frames.

    The result is at least `_SOFT_START_FRAMES`.
    """
    totals = np.convolve(powers.sum(axis=1), np.full(_SMOOTHING_FRAMES, 1.0 / _SMOOTHING_FRAMES), "same")
    loudest = np.sort(totals)[-_LOUDEST_FRAMES:].mean()
    return max(_SOFT_START_FRAMES, int(np.argmax(totals > 10.0 ** (-_SPEECH_RANGE_DB / 10.0) * loudest)))


def find_speech_span(powers: Powers) -> tuple[int, int, NDArray[np.float64]]:
    """Return the longest speech segment of a recording, and the noise floor.

    Returns:
        The first frame of the segment, the frame after its last, and the noise floor, shape ``(BANDS,)``; the two
        frames are equal if there is no speech.
    """
    if len(powers) < _START_FRAMES:
        return 0, 0, np.full(BANDS, _MIN_POWER)
    smoothed = np.maximum(powers, _MIN_POWER)
    smoothed[1:-1] = (smoothed[:-2] + smoothed[1:-1] + smoothed[2:]) / 3.0
    floor = np.maximum(_MIN_POWER, _MEAN_TO_MINIMUM * np.quantile(smoothed, 0.1, axis=0))
    level = np.mean(np.clip(10.0 * np.log10(smoothed / floor), 0.0, _MAX_BAND_LEVEL_DB), axis=1)
    # A browser's noise suppression reduces the noise only gradually, so at first the noise is far above the floor.
    totals = smoothed.sum(axis=1)
    is_audible = totals > 10.0 ** (-_MAX_BELOW_LOUDEST_DB / 10.0) * totals.max()
    loud_frames = np.flatnonzero((level > _TAKE_LEVEL_DB) & is_audible)
    if not len(loud_frames):
        return 0, 0, floor
    cuts = np.flatnonzero(np.diff(loud_frames) > HANGOVER_FRAMES) + 1
    longest = max(np.split(loud_frames, cuts), key=len)
    if len(longest) < _START_FRAMES:
        return 0, 0, floor
    return int(longest[0]), int(longest[-1]) + 1, floor
