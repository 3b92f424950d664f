"""Occupancy of cells in space as log-odds, updated by point clouds.

Source: Hornung et al., "OctoMap: an efficient probabilistic 3D mapping framework based on octrees", 2013.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import log

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.octrees import (
    FREE,
    OCCUPIED,
    Codes,
    Level,
    build_levels,
    codes_of_keys,
    encode_levels,
    encode_states,
    keys_of_codes,
)
from linkwright.perception.octomaps.rays import find_passed_cells

Points = NDArray[np.float64]


def log_odds(probability: float) -> float:
    """Return the log-odds of a probability between 0 and 1, both excluded."""
    return log(probability / (1.0 - probability))


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorModel:
    """The probabilities of a sensor.

    Attributes:
        hit: the probability that a cell in which a ray ends is occupied.
        miss: the probability that a cell through which a ray passes is occupied.
        minimum: the lowest probability of a cell.
        maximum: the highest probability of a cell.
        max_range: the range in meters beyond which a ray only frees cells; infinite for none.
    """

    hit: float = 0.7
    miss: float = 0.4
    minimum: float = 0.12
    maximum: float = 0.97
    max_range: float = float("inf")


class OccupancyOctree:
    """The known cells of a map.

    Args:
        resolution: the side of a cell, in meters.
        model: the probabilities of the sensor.

    Attributes:
        resolution: the side of a cell, in meters.
        codes: the known cells in ascending order, shape (n,).
        values: their log-odds, shape (n,).
    """

    def __init__(self, resolution: float, model: SensorModel) -> None:
        self.resolution, self._model = resolution, model
        self._limits = np.float32(log_odds(model.minimum)), np.float32(log_odds(model.maximum))
        self.clear()

    def clear(self) -> None:
        """Forget all cells."""
        self.codes: Codes = np.zeros(0, dtype=np.int64)
        self.values: NDArray[np.float32] = np.zeros(0, dtype=np.float32)

    def insert(self, origin: Points, points: Points, ground: Points) -> None:
        """Update the cells on the rays from a sensor to points.

        Args:
            origin: the position of the sensor, shape (3,), in meters.
            points: the points of obstacles, shape (n, 3).
            ground: the points of the ground, shape (m, 3), whose cells do not become occupied.
        """
        ranges = np.linalg.norm(points - origin, axis=1)
        is_far = ranges > self._model.max_range
        hits = _take_one_in_each_cell(points[~is_far], self.resolution)
        ends = np.concatenate([points[is_far], ground])
        lengths = np.linalg.norm(ends - origin, axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            shares = np.where(lengths > 0, np.minimum(1.0, self._model.max_range / lengths), 1.0)
        ends = _take_one_in_each_cell(origin + (ends - origin) * shares[:, None], self.resolution)
        passed = find_passed_cells(origin, np.concatenate([hits, ends]), self.resolution)
        occupied = np.unique(self._find_codes(hits))
        free = np.unique(np.concatenate([codes_of_keys(passed)[0], self._find_codes(ends)]))
        self._update(np.setdiff1d(free, occupied, assume_unique=True), log_odds(self._model.miss))
        self._update(occupied, log_odds(self._model.hit))

    def clear_box(self, low: Points, high: Points) -> None:
        """Set the known cells in a box to free, between two corners of shape (3,)."""
        centers = self.find_centers(self.codes)
        is_inside = ((centers >= low) & (centers <= high)).all(axis=1)
        self.values = np.where(is_inside, self._limits[0], self.values)

    def find_centers(self, codes: Codes) -> Points:
        """Return the centers of cells in meters, shape (n, 3)."""
        return (keys_of_codes(codes).astype(np.float64) + 0.5) * self.resolution

    def find_levels(self, *, merges: bool) -> list[Level]:
        """Return the nodes of the tree, from the root to the smallest cells."""
        return build_levels(self.codes, self.values, merges=merges)

    def encode_binary(self) -> bytes:
        """Return the tree in OctoMap's binary form, in which a cell is free or occupied."""
        return encode_states(self.codes, np.where(self.values >= 0, OCCUPIED, FREE).astype(np.int64))[0]

    def encode_full(self) -> bytes:
        """Return the tree in OctoMap's full form, with log-odds."""
        return encode_levels(self.find_levels(merges=True)) if len(self.codes) else b""

    def _find_codes(self, points: Points) -> Codes:
        return codes_of_keys(np.floor(points / self.resolution).astype(np.int64))[0]

    def _update(self, codes: Codes, change: float) -> None:
        """Add to the log-odds of cells, in ascending order without repetitions."""
        index = np.searchsorted(self.codes, codes)
        is_known = np.zeros(len(codes), dtype=bool)
        is_inside = index < len(self.codes)
        is_known[is_inside] = self.codes[index[is_inside]] == codes[is_inside]
        known = index[is_known]
        self.values[known] = np.clip(self.values[known] + np.float32(change), *self._limits)
        if is_known.all():
            return
        new = codes[~is_known]
        values = np.full(len(new), np.clip(np.float32(change), *self._limits), dtype=np.float32)
        place = np.searchsorted(self.codes, new)
        self.codes, self.values = np.insert(self.codes, place, new), np.insert(self.values, place, values)


def _take_one_in_each_cell(points: Points, resolution: float) -> Points:
    """Return the first point in each cell."""
    if not len(points):
        return points
    _, first = np.unique(np.floor(points / resolution).astype(np.int64), axis=0, return_index=True)
    taken: Points = points[first]
    return taken
