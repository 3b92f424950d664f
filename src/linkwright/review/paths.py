"""Compare the paths of robots in the runs of a scenario in pairs, by seed and time."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

_MAX_EQUAL_DISTANCE_M = 1e-4
"""The maximum distance in m between equal paths."""
_MAX_POINTS = 200
"""The maximum number of points of each path in a report."""
_MAX_PAIRS = 24
"""The maximum number of pairs of paths in a report."""

Array = NDArray[np.float64]
Points = Sequence[tuple[float, float, float]]
"""The points of a path: time in s, x and y in m."""


@dataclass(frozen=True)
class PathPair:
    """The paths of two runs with the same parameters and seed.

    Attributes:
        seed: the seed of both runs.
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
        """The pair with the median distance.

        For an even number of pairs, it is the lower of the two middle pairs.
        """
        return sorted(self.pairs, key=lambda pair: pair.distance)[(len(self.pairs) - 1) // 2]

    @cached_property
    def shown(self) -> Sequence[PathPair]:
        """The pairs in reports: all, or of many the first pairs, the typical and the farthest pair."""
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


def compare_paths(seed: str, old: Array, new: Array) -> PathPair:
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
    old_positions, new_positions = (_interpolate_positions(path, times) for path in (old, new))
    distances = np.linalg.norm(old_positions - new_positions, axis=1)
    index = int(distances.argmax())
    ends = (_round_point(old_positions[index]), _round_point(new_positions[index]))
    return PathPair(seed, _thin_out(old), _thin_out(new), float(distances[index]), float(times[index]), ends)


def find_differing_paths(
    groups: Mapping[tuple[str, str], Sequence[tuple[str, Array, Array]]],
) -> list[PathComparison]:
    """Return the comparisons of paths that differ, the largest distances first.

    Args:
        groups: the seeds with the old and new paths, by the name of the path and the text of the parameters.
    """
    comparisons = [
        PathComparison(name, parameters, [compare_paths(*runs) for runs in group])
        for (name, parameters), group in groups.items()
    ]
    differing = [comparison for comparison in comparisons if comparison.farthest.distance > _MAX_EQUAL_DISTANCE_M]
    return sorted(differing, key=lambda comparison: -comparison.farthest.distance)


def _interpolate_positions(path: Array, times: Array) -> Array:
    """Return the positions at some times, shape (times, 2)."""
    return np.column_stack([np.interp(times, path[:, 0], path[:, axis]) for axis in (1, 2)])


def _thin_out(path: Array) -> Points:
    indexes = np.unique(np.linspace(0, len(path) - 1, min(len(path), _MAX_POINTS)).round().astype(int))
    return [(float(row[0]), float(row[1]), float(row[2])) for row in path[indexes]]


def _round_point(point: Array) -> tuple[float, float]:
    return float(point[0]), float(point[1])
