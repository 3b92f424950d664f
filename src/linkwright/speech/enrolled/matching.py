"""Dynamic time warping of cepstra: the distance of a sound from each enrolled take, for all takes in parallel.

For each frame of the sound a path advances by zero, one or two frames of a take: a word may be spoken twice as fast,
and all paths have as many costs as the sound has frames. Before and after the word, paths stay in the background. There
is therefore no loop over takes: processing a frame takes a few operations on an array with the frames of all takes.

Noise is masked, after Klatt and after Holmes and Sedgwick: levels below the current noise, or far below the loudest
level, are raised to this floor, in takes and sound alike. The takes then compare equally, no matter how loud the noise
is now and was at enrolment.
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

_MASK = 2.0  # times the power of the noise
_RANGE = 40.0  # dB below the loudest frames
_LOUDEST = 12  # number of frames
_CEPSTRA = 12
_OF_LEVEL = 0.3  # weight of the zeroth coefficient
_OF_CHANGE = 1.5  # weight of the differences
_STAYING = np.float32(1.0)  # cost of staying in a frame of a take; a path can wait in the background instead
_FAR = np.float32(1e9)
_BESIDE = 2  # frames on each side from which differences are computed
_MOST_OF_ONE_THREAD = 200_000  # multiplications: OpenBLAS distributes more than 262,144 over several threads
_STRETCH = 8  # frames: roughly the length of a speech sound


@dataclass(frozen=True, slots=True)
class Match:
    """Distances from each take, in arrays of shape ``(takes,)``.

    Attributes:
        cost: the mean distance of a frame of the word to the frame of the take, including the sound around the word.
        first: the first frame of the word in the sound.
        last: the last frame of the word in the sound.
        background: the mean distance of the frames from first to last to the background.
        distances: the distance of each frame of the sound to each frame of all takes, shape ``(frames, frames of all
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
    """Takes that are prepared for comparison.

    Args:
        takes: at least one take.
    """

    def __init__(self, takes: tuple[Take, ...]) -> None:
        self.lengths = np.array([len(take.powers) for take in takes])
        clean = [np.maximum(take.powers - take.noise, 0.0) for take in takes]
        beside = ((_BESIDE, _BESIDE), (0, 0))
        self._clean = np.concatenate([np.pad(powers / loudness(powers), beside, "edge") for powers in clean])
        self._inner = np.concatenate([_inner(length) for length in self.lengths])
        starts = np.cumsum(self.lengths + 2) - self.lengths
        self._places = np.concatenate(
            [start + np.arange(length) for start, length in zip(starts, self.lengths, strict=True)]
        )
        self._firsts, self._lasts = starts, starts + self.lengths - 1

    def match(self, powers: Powers, noise: NDArray[np.float64]) -> Match:
        """Compare a sound with all takes.

        Args:
            powers: at least one frame, with the word and some background before and after it.
            noise: the power of the background, shape ``(BANDS,)``.
        """
        loud = loudness(np.maximum(powers - noise, 0.0))
        mask = np.maximum(_MASK * noise, loud / BANDS * 10.0 ** (-_RANGE / 10.0))
        sound = _features(powers, mask)
        background = _features(mask[None], mask)[0]
        states = _features(loud * self._clean, mask)[self._inner]
        distances = _distances(sound, states)
        silent = np.sqrt(np.sum((sound - background) ** 2, axis=1))
        cost, first, last, steps = self._paths(distances, silent)
        waited = np.concatenate(([0.0], np.cumsum(silent)))
        beside = (waited[last + 1] - waited[first]) / (last + 1 - first)
        return Match(cost, first, last, beside.astype(np.float32), distances, steps)

    def worst(self, match: Match, take: int) -> float:
        """Return the mean distance in the worst 80 ms of the best path through a take.

        This detects words that differ in a single speech sound.
        """
        place, own = int(self._lasts[take]), int(self.lengths[:take].sum()) - int(self._firsts[take])
        found = []
        for frame in range(int(match.last[take]), int(match.first[take]) - 1, -1):
            if place < self._firsts[take]:  # a path may skip the first frames
                break
            found.append(match.distances[frame, place + own])
            place -= int(match.steps[frame, place])
        size = min(_STRETCH, len(found))
        return float(np.convolve(found, np.full(size, 1.0 / size), "valid").max())

    def _paths(
        self, distances: _Array, silent: _Array
    ) -> tuple[_Array, NDArray[np.intp], NDArray[np.intp], NDArray[np.int8]]:
        """Return the costs, first and last frames, and steps of the best paths.

        Two places before each take serve as its entrances.
        """
        count, size = len(distances), int(self._lasts[-1]) + 1
        waited = np.concatenate((np.zeros(1, np.float32), np.cumsum(silent, dtype=np.float32)))
        entries = np.concatenate((self._firsts - 1, self._firsts - 2))
        here = np.zeros((count, size), np.float32)
        here[:, self._places] = distances
        past, found = np.full(size, _FAR, np.float32), np.empty(size, np.float32)
        by_one, by_two = np.zeros((2, count, size), np.bool_)
        ends = np.empty((count, len(self.lengths)), np.float32)
        for frame in range(count):
            past[entries] = waited[frame]
            np.add(past, _STAYING, out=found)
            for step, better in ((1, by_one), (2, by_two)):
                np.less(past[:-step], found[step:], out=better[frame, step:])
                np.minimum(past[:-step], found[step:], out=found[step:])
            found += here[frame]
            ends[frame] = found[self._lasts]
            past, found = found, past
        steps = np.maximum(by_one.view(np.int8), 2 * by_two.view(np.int8))
        total = ends + (waited[-1] - waited[1:])[:, None]
        last = total.argmin(axis=0)
        first = self._begins(steps, last)
        return total[last, np.arange(len(self.lengths))] / (last + 1 - first), first, last, steps

    def _begins(self, steps: NDArray[np.int8], last: NDArray[np.intp]) -> NDArray[np.intp]:
        """Return the frames at which the paths that end in given frames enter their takes."""
        place, first = self._lasts.copy(), last.copy()
        inside = np.arange(len(place))
        while len(inside):
            place[inside] -= steps[first[inside], place[inside]]
            inside = inside[(place[inside] >= self._firsts[inside]) & (first[inside] > 0)]
            first[inside] -= 1
        return first


def _inner(length: int) -> NDArray[np.bool_]:
    """Return which frames of a take with repeated edges are the take's own."""
    return np.pad(np.ones(length, dtype=np.bool_), _BESIDE)


def loudness(powers: Powers) -> float:
    """Return the power of the loudest frames, summed over all bands."""
    return float(np.sort(powers.sum(axis=1))[-_LOUDEST:].mean()) + 1e-6


def _features(powers: NDArray[np.float64], mask: NDArray[np.float64]) -> _Array:
    """Return cepstra of masked powers, and their derivatives, shape ``(frames, 2 * (_CEPSTRA + 1))``."""
    cepstra = _product(10.0 * np.log10(np.maximum(powers, mask)), _COSINES)
    padded = np.pad(cepstra, ((_BESIDE, _BESIDE), (0, 0)), "edge")
    changes = (2.0 * (padded[4:] - padded[:-4]) + (padded[3:-1] - padded[1:-3])) / 10.0
    features: _Array = np.concatenate((cepstra, _OF_CHANGE * changes), axis=1).astype(np.float32)
    return features


def _distances(sound: _Array, states: _Array) -> _Array:
    """Return Euclidean distances, shape ``(frames of the sound, frames of all takes)``."""
    squares = np.sum(sound**2, axis=1)[:, None] + np.sum(states**2, axis=1)[None] - 2.0 * _product(sound, states.T)
    return np.asarray(np.sqrt(np.maximum(squares, 0.0)), dtype=np.float32)


def _product(left: NDArray[_Float], right: NDArray[_Float]) -> NDArray[_Float]:
    """Return the product of two matrices, computed in parts for which OpenBLAS uses only one thread.

    Waiting threads would occupy cores.
    """
    rows = max(1, _MOST_OF_ONE_THREAD // right.size)
    return np.concatenate([left[at : at + rows] @ right for at in range(0, len(left), rows)])


def _cosines() -> NDArray[np.float64]:
    """Return the DCT-II matrix of the bands, with a weighted level, shape ``(BANDS, _CEPSTRA + 1)``."""
    bands, orders = np.arange(BANDS) + 0.5, np.arange(_CEPSTRA + 1)
    weights = np.where(orders == 0, _OF_LEVEL, 1.0) * np.sqrt(2.0 / BANDS)
    return np.asarray(np.cos(np.pi * np.outer(bands, orders) / BANDS) * weights)


_COSINES = _cosines()
