"""The paths of robots in the runs of a scenario, compared in pairs: by seed and by time."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

_TOLERANCE = 1e-4
"""The maximum distance in m between equal paths."""
_MAX_POINTS = 200
"""The number of points of each path in a report."""
_MAX_PAIRS = 24
"""The number of pairs whose paths are in a report."""

Array = NDArray[np.float64]
Points = Sequence[tuple[float, float, float]]
"""The points of a path: time in s, x and y in m."""


@dataclass(frozen=True)
class PathPair:
    """The paths of two runs with the same parameters and seed.

    Attributes:
        seed: the seed.
        old: the path of the old version.
        new: the path of the new version.
        distance: the largest distance between both robots at the same time, in m.
        time: the time of this distance, in s.
        ends: the positions of both robots at this time, in m.
    """

    seed: str
    old: Points
    new: Points
    distance: float
    time: float
    ends: tuple[tuple[float, float], tuple[float, float]]


@dataclass(frozen=True)
class PathComparison:
    """The paths of the runs of a scenario that differ only in their seeds.

    Attributes:
        name: the name of the path.
        parameters: the parameters of the runs as ``name=value`` words; empty if there are none.
        pairs: the pairs of runs, in the order of their seeds.
    """

    name: str
    parameters: str
    pairs: Sequence[PathPair]

    @property
    def title(self) -> str:
        """The name of the path, and the parameters."""
        return f"{self.name}, {self.parameters}" if self.parameters else self.name

    @cached_property
    def farthest(self) -> PathPair:
        """The pair with the largest distance."""
        return max(self.pairs, key=lambda pair: pair.distance)

    @cached_property
    def typical(self) -> PathPair:
        """The pair with the median of the distances; with an even number of pairs, with the lower one of the two."""
        return sorted(self.pairs, key=lambda pair: pair.distance)[(len(self.pairs) - 1) // 2]

    @cached_property
    def shown(self) -> Sequence[PathPair]:
        """The pairs in reports: all, or of many the first ones, the typical and the farthest one."""
        marked = {id(self.typical), id(self.farthest)}
        first = {id(pair) for pair in self.pairs[:_MAX_PAIRS]}
        return [pair for pair in self.pairs if id(pair) in first | marked]


def read_paths(file: Path) -> dict[str, dict[str, Array]]:
    """Return the paths of the runs in a file of ``linkwright sweep --paths``.

    Returns:
        For each row of the table, the points by the name of the path: time in s, x and y in m, shape (points, 3).
    """
    runs = json.loads(file.read_text(encoding="utf-8"))["runs"]
    return {
        str(run["row"]): {name: np.asarray(points, dtype=np.float64) for name, points in run["paths"].items()}
        for run in runs
    }


def path_pair(seed: str, old: Array, new: Array) -> PathPair:
    """Compare two paths over the time that both cover.

    Args:
        seed: the seed of both runs.
        old: the old path, shape (points, 3).
        new: the new path, shape (points, 3).
    """
    start, end = max(old[0, 0], new[0, 0]), min(old[-1, 0], new[-1, 0])
    times = np.union1d(old[:, 0], new[:, 0])
    times = times[(times >= start) & (times <= end)]
    if not len(times):
        times = np.array([start])
    old_places, new_places = (_positions(path, times) for path in (old, new))
    distances = np.linalg.norm(old_places - new_places, axis=1)
    index = int(distances.argmax())
    ends = (_point(old_places[index]), _point(new_places[index]))
    return PathPair(seed, _thinned(old), _thinned(new), float(distances[index]), float(times[index]), ends)


def differing_paths(
    groups: Mapping[tuple[str, str], Sequence[tuple[str, Array, Array]]],
) -> list[PathComparison]:
    """Return the comparisons in which paths differ, those with the largest distances first.

    Args:
        groups: for each name of a path and each text of parameters, the seeds with the old and the new path.
    """
    comparisons = [
        PathComparison(name, parameters, [path_pair(*runs) for runs in group])
        for (name, parameters), group in groups.items()
    ]
    differing = [comparison for comparison in comparisons if comparison.farthest.distance > _TOLERANCE]
    return sorted(differing, key=lambda comparison: -comparison.farthest.distance)


def _positions(path: Array, times: Array) -> Array:
    """Return the positions at some times, shape (times, 2)."""
    return np.column_stack([np.interp(times, path[:, 0], path[:, axis]) for axis in (1, 2)])


def _thinned(path: Array) -> Points:
    indexes = np.unique(np.linspace(0, len(path) - 1, min(len(path), _MAX_POINTS)).round().astype(int))
    return [(float(row[0]), float(row[1]), float(row[2])) for row in path[indexes]]


def _point(place: Array) -> tuple[float, float]:
    return float(place[0]), float(place[1])
