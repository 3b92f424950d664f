"""Compute the reach of chains: the largest distance of the end from the origin within the joint limits."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

_COMPARED_POSITIONS = 64
"""The number of positions at which chains are compared before the search for their reach."""
_MAX_EQUAL_DISTANCE_M = 1e-9
"""The maximum difference in m of equal distances."""
_STARTS = 8
"""The number of sampled configurations that are the starting points of a search."""
_MAX_SWEEPS = 20
_MIN_GAIN = 1e-7
"""The increase of the distance in m, over all joints, below which a search ends."""
_THIRD = 2.0 * np.pi / 3.0

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Chain:
    """The joints that move the end of a chain, and its distance.

    Attributes:
        names: the joints, in the order of positions.
        moving: the indexes of the joints that move the end of the chain.
        turns: whether each joint is revolute; the others are prismatic.
        low: the lower limits, shape (joints,).
        high: the upper limits, shape (joints,).
        distances: a function that returns the distances of the end in m, shape (count,), for positions of shape
            (count, joints).
    """

    names: Sequence[str]
    moving: Sequence[int]
    turns: Sequence[bool]
    low: Array
    high: Array
    distances: Callable[[Array], Array]

    def farthest(self, samples: Array) -> tuple[float, Array]:
        """Return the largest distance of the end in m that a search finds, with its positions.

        One joint after the other is moved to its best position. For a revolute joint, the squared distance is a
        sine of its position; for a prismatic joint, the best position is one of its limits.

        Args:
            samples: the positions from which the search can start, shape (count, joints).
        """
        distances = self.distances(samples)
        best = np.argsort(distances, kind="stable")[-_STARTS:]
        positions, distances = samples[best].copy(), distances[best].copy()
        for _ in range(_MAX_SWEEPS):
            previous_distance = distances.max()
            for joint in self.moving:
                self._improve(positions, distances, joint)
            if distances.max() - previous_distance < _MIN_GAIN:
                break
        index = int(np.argmax(distances))
        return float(distances[index]), positions[index]

    def _improve(self, positions: Array, distances: Array, joint: int) -> None:
        """Move a joint of each configuration to its best position."""
        candidates: list[Array] = [np.full(len(positions), limit[joint]) for limit in (self.low, self.high)]
        if self.turns[joint]:
            candidates.append(self._find_peaks(positions, joint))
        for values in candidates:
            moved = positions.copy()
            moved[:, joint] = np.clip(values, self.low[joint], self.high[joint])
            moved_distances = self.distances(moved)
            is_better = moved_distances > distances
            positions[is_better], distances[is_better] = moved[is_better], moved_distances[is_better]

    def _find_peaks(self, positions: Array, joint: int) -> Array:
        """Return the positions of a revolute joint with the largest distance.

        They are computed from three samples per configuration.
        """
        squares = []
        for step in range(3):
            turned = positions.copy()
            turned[:, joint] = step * _THIRD
            squares.append(self.distances(turned) ** 2)
        cosine = (2.0 * squares[0] - squares[1] - squares[2]) / 3.0
        sine = (squares[1] - squares[2]) / np.sqrt(3.0)
        peaks: Array = np.arctan2(sine, cosine)
        middle = (self.low[joint] + self.high[joint]) / 2.0
        nearest: Array = peaks + 2.0 * np.pi * np.round((middle - peaks) / (2.0 * np.pi))
        return nearest

    def to_positions(self, values: Mapping[str, float], default: Array) -> Array:
        """Return positions by name as an array within the limits, shape (joints,)."""
        positions = np.array([values.get(name, other) for name, other in zip(self.names, default, strict=True)])
        clipped: Array = np.clip(positions, self.low, self.high)
        return clipped


def have_equal_distances(old: Chain, new: Chain, samples: Array) -> bool:
    """Return whether two chains have equal limits and distances at the first samples.

    Such chains have the same reach.
    """
    if list(old.names) != list(new.names) or old.moving != new.moving:
        return False
    if not (np.array_equal(old.low, new.low) and np.array_equal(old.high, new.high)):
        return False
    first = samples[:_COMPARED_POSITIONS]
    return np.allclose(old.distances(first), new.distances(first), rtol=0.0, atol=_MAX_EQUAL_DISTANCE_M)


def compare_reaches(old: Chain, new: Chain, old_samples: Array, new_samples: Array) -> tuple[float, float]:
    """Return the reach of a chain in two robots in m.

    The search in each robot also starts from the best positions of the other robot. Otherwise the reach could seem to
    grow with tighter limits, because the search ended elsewhere.
    """
    sides = (old, old_samples), (new, new_samples)
    farthest = [chain.farthest(samples) for chain, samples in sides]
    results = []
    for (chain, samples), (distance, _), (other, (_, other_best)) in zip(
        sides, farthest, ((new, farthest[1]), (old, farthest[0])), strict=True
    ):
        start = chain.to_positions(dict(zip(other.names, other_best, strict=True)), samples[0])
        results.append(max(distance, chain.farthest(start[np.newaxis])[0]))
    return results[0], results[1]
