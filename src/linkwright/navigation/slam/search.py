"""Search by branch and bound for the pose at which a scan fits a reference best.

The search is that of Olson ("Real-Time Correlative Scan Matching", ICRA 2009) with the branch and bound of Hess et al.
("Real-Time Loop Closure in 2D LIDAR SLAM", ICRA 2016): a block of positions is rated by an upper bound of the responses
in it, so the whole window is searched with few evaluations. A response, as in Karto, is the mean likelihood at the
points.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, pi

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.slam.poses import Floats
from linkwright.navigation.slam.reference import Likelihood
from linkwright.navigation.slam.steps import Steps

_PENALTY_GAIN = 0.2
_MOST_POINTS = 180
_BATCH = 1500
_BLOCKS = 3
"""The approximate number of the largest blocks along a side of the window."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Search:
    """A search window of poses, and the penalties for distance from its centre.

    Names and meanings are those of Karto's parameters.

    Attributes:
        dimension: the side of the window, in metres.
        resolution: the resolution of positions, in metres.
        smear_deviation: the standard deviation of a reading's position, in metres.
        angle_offset: half the window of angles, in radians.
        angle_resolution: the resolution of angles, in radians; refined if it would skip cells at the farthest points.
        distance_variance_penalty: the variance of the penalty for distance, in square metres; a smaller value keeps the
            pose nearer to the expected one.
        angle_variance_penalty: the variance of the penalty for angles, in square radians.
        minimum_distance_penalty: the minimum factor by which the distance reduces a response; 1 for no penalty.
        minimum_angle_penalty: the minimum factor by which the angle reduces a response.
    """

    dimension: float = 0.5
    resolution: float = 0.01
    smear_deviation: float = 0.1
    angle_offset: float = 0.349
    angle_resolution: float = 0.0349
    distance_variance_penalty: float = 0.5
    angle_variance_penalty: float = 1.0
    minimum_distance_penalty: float = 0.5
    minimum_angle_penalty: float = 0.9

    @property
    def cell(self) -> float:
        """The resolution of the search in metres, at least half the smear."""
        return max(self.resolution, self.smear_deviation / 2)


@dataclass(slots=True, eq=False)
class _Blocks:
    """Blocks of positions: angles, first rows and columns, and upper bounds of the responses."""

    angle: NDArray[np.int64]
    row: NDArray[np.int64]
    column: NDArray[np.int64]
    bound: Floats

    def part(self, chosen: slice | NDArray[np.bool_]) -> _Blocks:
        return _Blocks(self.angle[chosen], self.row[chosen], self.column[chosen], self.bound[chosen])


class _Window:
    """The poses around a guess, which are rated in blocks."""

    def __init__(self, likelihood: Likelihood, points: Floats, guess: Floats, search: Search) -> None:
        self._likelihood, self._search = likelihood, search
        stride = -(-len(points) // _MOST_POINTS)
        points = points[::stride]
        reach = float(np.quantile(np.hypot(points[:, 0], points[:, 1]), 0.8))
        step: float = min(search.angle_resolution, 1.5 * likelihood.resolution / max(reach, likelihood.resolution))
        count = ceil(search.angle_offset / step - 1e-9)
        self.angles: Floats = np.arange(-count, count + 1, dtype=np.float64) * step
        self.half = ceil(search.dimension / 2 / likelihood.resolution - 1e-9)
        yaw = guess[2] + self.angles
        cos, sin = np.cos(yaw)[:, None], np.sin(yaw)[:, None]
        x = cos * points[:, 0] - sin * points[:, 1] + guess[0] - likelihood.corner[0]
        y = sin * points[:, 0] + cos * points[:, 1] + guess[1] - likelihood.corner[1]
        self._rows = np.floor(y / likelihood.resolution).astype(np.int32)
        self._columns = np.floor(x / likelihood.resolution).astype(np.int32)

    def top(self) -> tuple[int, _Blocks]:
        """Return the level of the largest blocks, and these blocks with bounds of 0."""
        side = 2 * self.half + 1
        level = max(0, (side // _BLOCKS).bit_length() - 1)
        offsets = np.arange(-self.half, self.half + 1, 1 << level)
        angle, row, column = (
            array.ravel() for array in np.meshgrid(np.arange(len(self.angles)), offsets, offsets, indexing="ij")
        )
        return level, _Blocks(angle, row, column, np.zeros(len(angle)))

    def judge(self, blocks: _Blocks, level: int) -> None:
        """Set the upper bounds of blocks of a level."""
        grid, begin = self._likelihood.level(level)
        height, width = grid.shape
        flat = grid.ravel()
        rows = np.clip(self._rows[blocks.angle] + (blocks.row + begin)[:, None].astype(np.int32), 0, height - 1)
        columns = np.clip(self._columns[blocks.angle] + (blocks.column + begin)[:, None].astype(np.int32), 0, width - 1)
        responses = flat.take(rows * np.int32(width) + columns).mean(axis=1, dtype=np.float64)
        bound: Floats = responses * self._penalty(blocks, level)
        blocks.bound = bound

    def _penalty(self, blocks: _Blocks, level: int) -> Floats:
        search, last = self._search, (1 << level) - 1

        def nearest(first: NDArray[np.int64]) -> NDArray[np.int64]:
            result: NDArray[np.int64] = np.clip(0, first, first + last)
            return result

        squared = (nearest(blocks.row) ** 2 + nearest(blocks.column) ** 2) * self._likelihood.resolution**2
        distance = 1 - _PENALTY_GAIN * squared / search.distance_variance_penalty
        angle = 1 - _PENALTY_GAIN * self.angles[blocks.angle] ** 2 / search.angle_variance_penalty
        result: Floats = np.maximum(distance, search.minimum_distance_penalty) * np.maximum(
            angle, search.minimum_angle_penalty
        )
        return result

    def children(self, blocks: _Blocks, level: int) -> _Blocks:
        """Return the quarters of blocks that are within the window, with bounds of 0.

        `level` is the level of the quarters.
        """
        side = 1 << level
        angle, row, column = (np.repeat(array, 4) for array in (blocks.angle, blocks.row, blocks.column))
        row += np.tile((0, 0, side, side), len(blocks.angle))
        column += np.tile((0, side, 0, side), len(blocks.angle))
        inside = (row <= self.half) & (column <= self.half)
        return _Blocks(angle[inside], row[inside], column[inside], np.zeros(int(inside.sum())))


def best_pose(likelihood: Likelihood, points: Floats, guess: Floats, search: Search) -> Steps[tuple[Floats, float]]:
    """Search a window for the pose with the highest response, in steps.

    Args:
        likelihood: the likelihood field of the earlier scans.
        points: the points of the scan, at least one, in the frame of the robot, of shape (n, 2), in metres.
        guess: the centre of the window, of shape (3,).
        search: the window.

    Returns:
        The pose, of shape (3,), and its response, reduced by the penalties.
    """
    window = _Window(likelihood, points, guess, search)
    level, blocks = window.top()
    yield from _judged(window, blocks, level)
    best, found = -1.0, blocks.part(np.s_[:1])
    while level:
        leaf = _descend(window, blocks, level)
        if leaf.bound[0] > best:
            best, found = float(leaf.bound[0]), leaf
        level -= 1
        blocks = window.children(blocks.part(blocks.bound > best), level)
        if not len(blocks.angle):
            break
        yield from _judged(window, blocks, level)
    if len(blocks.angle):
        index = int(np.argmax(blocks.bound))
        if blocks.bound[index] > best:
            best, found = float(blocks.bound[index]), blocks.part(np.s_[index : index + 1])
    shift = np.array((found.column[0], found.row[0])) * likelihood.resolution
    pose: Floats = np.array((guess[0] + shift[0], guess[1] + shift[1], guess[2] + window.angles[found.angle[0]]))
    pose[2] = (pose[2] + pi) % (2 * pi) - pi
    return pose, best


def _judged(window: _Window, blocks: _Blocks, level: int) -> Steps[None]:
    for begin in range(0, len(blocks.angle), _BATCH):
        part = blocks.part(np.s_[begin : begin + _BATCH])
        window.judge(part, level)
        blocks.bound[begin : begin + _BATCH] = part.bound
        yield


def _descend(window: _Window, blocks: _Blocks, level: int) -> _Blocks:
    """Return the pose found by descending greedily from the best block to its best quarter.

    The pose is a block of one cell.
    """
    index = int(np.argmax(blocks.bound))
    block = blocks.part(np.s_[index : index + 1])
    while level:
        level -= 1
        quarters = window.children(block, level)
        window.judge(quarters, level)
        index = int(np.argmax(quarters.bound))
        block = quarters.part(np.s_[index : index + 1])
    return block
