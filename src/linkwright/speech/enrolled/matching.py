"""Dynamic time warping of cepstra: distances of a recording from all enrolled takes.

The distances are computed in parallel. For each frame of the recording, a path advances by zero, one or two frames of a
take. So a word may be spoken up to twice as fast, and all paths have as many costs as the sound has frames. Before and
after the word, a path stays in the background. There is no loop over takes: each frame needs a few operations on an
array with the frames of all takes.

Noise is masked as by Klatt, and by Holmes and Sedgwick: levels below the current noise, or far below the loudest level,
are raised to this floor, both in the takes and in the sound. So they can be compared even if their noise differs.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from linkwright.speech.enrolled.words import Take
from linkwright.speech.sound.spectra import BANDS, Powers

_Array = NDArray[np.float32]
_Float = TypeVar("_Float", np.float32, np.float64)

_NOISE_FACTOR = 2.0  # the floor of powers, as a multiple of the noise
_DYNAMIC_RANGE_DB = 40.0  # another floor of powers, in dB below the loudest frames
_LOUDEST_FRAMES = 12  # the number of frames that determine the loudest level
_CEPSTRUM_COUNT = 12
_LEVEL_WEIGHT = 0.3  # the weight of the zeroth coefficient
_CHANGE_WEIGHT = 1.5  # the weight of the differences
_STAY_COST = np.float32(1.0)
"""The cost of assigning one more frame of the recording to the same frame of a take.

Frames before and after the word are assigned to the background instead, without this cost.
"""
_INFINITE_COST = np.float32(1e9)
_CONTEXT_FRAMES = 2  # the number of frames on each side from which differences are computed
_MAX_SINGLE_THREAD_PRODUCTS = (
    200_000  # the maximum number of multiplications in one thread; OpenBLAS uses several above 262,144
)
_SPEECH_SOUND_FRAMES = 8  # the approximate length of a speech sound, in frames


@dataclass(frozen=True, slots=True)
class Match:
    """The distances of a recording from each take.

    Arrays have the shape ``(takes,)`` unless stated otherwise.

    Attributes:
        cost: the mean distance between frames of the recording and of the take, including the background around the
            word.
        first: the index of the first frame of the word in the recording.
        last: the index of the last frame of the word in the recording.
        background: the mean distance between the word's frames and the background.
        distances: the distance of each frame of the sound from each frame of all takes, shape ``(frames, frames of all
            takes)``.
        steps: the number of frames of its take by which each path advanced, shape ``(frames, places)``.
    """

    cost: _Array
    first: NDArray[np.intp]
    last: NDArray[np.intp]
    background: _Array
    distances: _Array
    steps: NDArray[np.int8]


class Templates:
    """Takes in a form that is prepared for comparison.

    Args:
        takes: at least one take.
    """

    def __init__(self, takes: tuple[Take, ...]) -> None:
        self.lengths = np.array([len(take.powers) for take in takes])
        denoised = [np.maximum(take.powers - take.noise, 0.0) for take in takes]
        padding = ((_CONTEXT_FRAMES, _CONTEXT_FRAMES), (0, 0))
        self._denoised = np.concatenate(
            [np.pad(powers / compute_loudness(powers), padding, "edge") for powers in denoised]
        )
        self._is_own_frame = np.concatenate([_make_own_frame_mask(length) for length in self.lengths])
        starts = np.cumsum(self.lengths + 2) - self.lengths
        self._frame_columns = np.concatenate(
            [start + np.arange(length) for start, length in zip(starts, self.lengths, strict=True)]
        )
        self._first_columns, self._last_columns = starts, starts + self.lengths - 1

    def match(self, powers: Powers, noise: NDArray[np.float64]) -> Match:
        """Compare a recording with all takes.

        Args:
            powers: one or more frames, with the word and some background before and after it.
            noise: the power of the background, shape ``(BANDS,)``.
        """
        loudest_power = compute_loudness(np.maximum(powers - noise, 0.0))
        mask = np.maximum(_NOISE_FACTOR * noise, loudest_power / BANDS * 10.0 ** (-_DYNAMIC_RANGE_DB / 10.0))
        sound = _compute_features(powers, mask)
        background = _compute_features(mask[None], mask)[0]
        states = _compute_features(loudest_power * self._denoised, mask)[self._is_own_frame]
        distances = _compute_distances(sound, states)
        background_distances = np.sqrt(np.sum((sound - background) ** 2, axis=1))
        cost, first, last, steps = self._find_paths(distances, background_distances)
        cumulative = np.concatenate(([0.0], np.cumsum(background_distances)))
        mean_background = (cumulative[last + 1] - cumulative[first]) / (last + 1 - first)
        return Match(cost, first, last, mean_background.astype(np.float32), distances, steps)

    def compute_worst_distance(self, match: Match, take: int) -> float:
        """Return the mean distance in the worst 80 ms of the best path through a take.

        This distance separates words that differ in a single speech sound.
        """
        column, column_offset = (
            int(self._last_columns[take]),
            int(self.lengths[:take].sum()) - int(self._first_columns[take]),
        )
        path_distances = []
        for frame in range(int(match.last[take]), int(match.first[take]) - 1, -1):
            if column < self._first_columns[take]:  # The path has skipped the first frames.
                break
            path_distances.append(match.distances[frame, column + column_offset])
            column -= int(match.steps[frame, column])
        size = min(_SPEECH_SOUND_FRAMES, len(path_distances))
        return float(np.convolve(path_distances, np.full(size, 1.0 / size), "valid").max())

    def _find_paths(
        self, distances: _Array, background_distances: _Array
    ) -> tuple[_Array, NDArray[np.intp], NDArray[np.intp], NDArray[np.int8]]:
        """Return the costs, first and last frames, and steps of the best paths.

        Two columns before each take serve as its entrances.
        """
        count, size = len(distances), int(self._last_columns[-1]) + 1
        cumulative = np.concatenate((np.zeros(1, np.float32), np.cumsum(background_distances, dtype=np.float32)))
        entry_columns = np.concatenate((self._first_columns - 1, self._first_columns - 2))
        frame_costs = np.zeros((count, size), np.float32)
        frame_costs[:, self._frame_columns] = distances
        previous, current = np.full(size, _INFINITE_COST, np.float32), np.empty(size, np.float32)
        is_one_step, is_two_steps = np.zeros((2, count, size), np.bool_)
        end_costs = np.empty((count, len(self.lengths)), np.float32)
        for frame in range(count):
            previous[entry_columns] = cumulative[frame]
            np.add(previous, _STAY_COST, out=current)
            for step, is_better in ((1, is_one_step), (2, is_two_steps)):
                np.less(previous[:-step], current[step:], out=is_better[frame, step:])
                np.minimum(previous[:-step], current[step:], out=current[step:])
            current += frame_costs[frame]
            end_costs[frame] = current[self._last_columns]
            previous, current = current, previous
        steps = np.maximum(is_one_step.view(np.int8), 2 * is_two_steps.view(np.int8))
        total = end_costs + (cumulative[-1] - cumulative[1:])[:, None]
        last = total.argmin(axis=0)
        first = self._find_starts(steps, last)
        return total[last, np.arange(len(self.lengths))] / (last + 1 - first), first, last, steps

    def _find_starts(self, steps: NDArray[np.int8], last: NDArray[np.intp]) -> NDArray[np.intp]:
        """Return the frame at which each path enters its take, given the frame at which it ends."""
        column, first = self._last_columns.copy(), last.copy()
        active = np.arange(len(column))
        while len(active):
            column[active] -= steps[first[active], column[active]]
            active = active[(column[active] >= self._first_columns[active]) & (first[active] > 0)]
            first[active] -= 1
        return first


def _make_own_frame_mask(length: int) -> NDArray[np.bool_]:
    """Return the mask of a take's own frames among its frames with repeated edges."""
    return np.pad(np.ones(length, dtype=np.bool_), _CONTEXT_FRAMES)


def compute_loudness(powers: Powers) -> float:
    """Return the mean power of the loudest frames, summed over all bands."""
    return float(np.sort(powers.sum(axis=1))[-_LOUDEST_FRAMES:].mean()) + 1e-6


def _compute_features(powers: NDArray[np.float64], mask: NDArray[np.float64]) -> _Array:
    """Return the cepstra of masked powers and their derivatives.

    The shape is ``(frames, 2 * (_CEPSTRA + 1))``.
    """
    cepstra = _multiply(10.0 * np.log10(np.maximum(powers, mask)), _COSINES)
    padded = np.pad(cepstra, ((_CONTEXT_FRAMES, _CONTEXT_FRAMES), (0, 0)), "edge")
    differences = (2.0 * (padded[4:] - padded[:-4]) + (padded[3:-1] - padded[1:-3])) / 10.0
    features: _Array = np.concatenate((cepstra, _CHANGE_WEIGHT * differences), axis=1).astype(np.float32)
    return features


def _compute_distances(sound: _Array, states: _Array) -> _Array:
    """Return Euclidean distances, shape ``(frames of the recording, frames of all takes)``."""
    squares = np.sum(sound**2, axis=1)[:, None] + np.sum(states**2, axis=1)[None] - 2.0 * _multiply(sound, states.T)
    return np.asarray(np.sqrt(np.maximum(squares, 0.0)), dtype=np.float32)


def _multiply(left: NDArray[_Float], right: NDArray[_Float]) -> NDArray[_Float]:
    """Return the product of two matrices, computed with one thread.

    OpenBLAS uses only one thread for the small blocks. Its waiting threads would keep other cores busy.
    """
    rows = max(1, _MAX_SINGLE_THREAD_PRODUCTS // right.size)
    return np.concatenate([left[start : start + rows] @ right for start in range(0, len(left), rows)])


def _make_cosines() -> NDArray[np.float64]:
    """Return the DCT-II matrix of the bands, with a weighted level.

    The shape is ``(BANDS, _CEPSTRA + 1)``.
    """
    bands, orders = np.arange(BANDS) + 0.5, np.arange(_CEPSTRUM_COUNT + 1)
    weights = np.where(orders == 0, _LEVEL_WEIGHT, 1.0) * np.sqrt(2.0 / BANDS)
    return np.asarray(np.cos(np.pi * np.outer(bands, orders) / BANDS) * weights)


_COSINES = _make_cosines()
