"""Search by branch and bound for the pose at which a scan fits a reference best.

The search combines Olson ("Real-Time Correlative Scan Matching", ICRA 2009) with the branch and bound of Hess et al.
("Real-Time Loop Closure in 2D LIDAR SLAM", ICRA 2016). A block of positions is rated by an upper bound of its
responses, so the whole window is searched with few evaluations. A response, as in Karto, is the mean likelihood at the
points.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, pi

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.slam.poses import FloatArray
from linkwright.navigation.slam.reference import LikelihoodField
from linkwright.navigation.slam.steps import Steps

_PENALTY_GAIN = 0.2
_MAX_POINTS = 180
_BATCH_SIZE = 1500
_BLOCKS_PER_SIDE = 3
"""The approximate number of top-level blocks along a side of the window."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Search:
    """A search window of poses, and the penalties for distance from its center.

    Names and meanings are the same as for Karto's parameters.

    Attributes:
        dimension: the side of the window, in meters.
        resolution: the resolution of positions, in meters.
        smear_deviation: the standard deviation of a reading's position, in meters.
        angle_offset: half the window of angles, in radians.
        angle_resolution: the resolution of angles, in radians; refined if it would skip cells at the farthest points.
        distance_variance_penalty: the variance of the penalty for distance, in square meters; a smaller value keeps the
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
        """The side of a cell of the search, in meters.

        The side is the resolution, but at least half of `smear_deviation`.
        """
        return max(self.resolution, self.smear_deviation / 2)


@dataclass(slots=True, eq=False)
class _Blocks:
    """Blocks of positions: angles, first rows and columns, and upper bounds of the responses."""

    angle: NDArray[np.int64]
    row: NDArray[np.int64]
    column: NDArray[np.int64]
    bound: FloatArray

    def select(self, selection: slice | NDArray[np.bool_]) -> _Blocks:
        return _Blocks(self.angle[selection], self.row[selection], self.column[selection], self.bound[selection])


class _Window:
    """The poses around a guess, rated in blocks."""

    def __init__(self, likelihood: LikelihoodField, points: FloatArray, guess: FloatArray, search: Search) -> None:
        self._likelihood, self._search = likelihood, search
        stride = -(-len(points) // _MAX_POINTS)
        points = points[::stride]
        radius = float(np.quantile(np.hypot(points[:, 0], points[:, 1]), 0.8))
        step: float = min(search.angle_resolution, 1.5 * likelihood.resolution / max(radius, likelihood.resolution))
        count = ceil(search.angle_offset / step - 1e-9)
        self.angles: FloatArray = np.arange(-count, count + 1, dtype=np.float64) * step
        self.half = ceil(search.dimension / 2 / likelihood.resolution - 1e-9)
        yaw = guess[2] + self.angles
        cos, sin = np.cos(yaw)[:, None], np.sin(yaw)[:, None]
        x = cos * points[:, 0] - sin * points[:, 1] + guess[0] - likelihood.corner[0]
        y = sin * points[:, 0] + cos * points[:, 1] + guess[1] - likelihood.corner[1]
        self._rows = np.floor(y / likelihood.resolution).astype(np.int32)
        self._columns = np.floor(x / likelihood.resolution).astype(np.int32)

    def create_largest_blocks(self) -> tuple[int, _Blocks]:
        """Return the level of the largest blocks, and these blocks with bounds of 0."""
        side_length = 2 * self.half + 1
        level = max(0, (side_length // _BLOCKS_PER_SIDE).bit_length() - 1)
        offsets = np.arange(-self.half, self.half + 1, 1 << level)
        angle, row, column = (
            array.ravel() for array in np.meshgrid(np.arange(len(self.angles)), offsets, offsets, indexing="ij")
        )
        return level, _Blocks(angle, row, column, np.zeros(len(angle)))

    def set_bounds(self, blocks: _Blocks, level: int) -> None:
        """Set the upper bounds of blocks of a level."""
        grid, offset = self._likelihood.get_level(level)
        height, width = grid.shape
        flat = grid.ravel()
        rows = np.clip(self._rows[blocks.angle] + (blocks.row + offset)[:, None].astype(np.int32), 0, height - 1)
        columns = np.clip(
            self._columns[blocks.angle] + (blocks.column + offset)[:, None].astype(np.int32), 0, width - 1
        )
        responses = flat.take(rows * np.int32(width) + columns).mean(axis=1, dtype=np.float64)
        bound: FloatArray = responses * self._compute_penalty(blocks, level)
        blocks.bound = bound

    def _compute_penalty(self, blocks: _Blocks, level: int) -> FloatArray:
        search, block_end = self._search, (1 << level) - 1

        def nearest(first: NDArray[np.int64]) -> NDArray[np.int64]:
            result: NDArray[np.int64] = np.clip(0, first, first + block_end)
            return result

        squared = (nearest(blocks.row) ** 2 + nearest(blocks.column) ** 2) * self._likelihood.resolution**2
        distance = 1 - _PENALTY_GAIN * squared / search.distance_variance_penalty
        angle = 1 - _PENALTY_GAIN * self.angles[blocks.angle] ** 2 / search.angle_variance_penalty
        result: FloatArray = np.maximum(distance, search.minimum_distance_penalty) * np.maximum(
            angle, search.minimum_angle_penalty
        )
        return result

    def divide(self, blocks: _Blocks, level: int) -> _Blocks:
        """Return the quarters of blocks that are within the window, with bounds of 0.

        `get_level` is the level of the quarters.
        """
        block_side = 1 << level
        angle, row, column = (np.repeat(array, 4) for array in (blocks.angle, blocks.row, blocks.column))
        row += np.tile((0, 0, block_side, block_side), len(blocks.angle))
        column += np.tile((0, block_side, 0, block_side), len(blocks.angle))
        is_inside = (row <= self.half) & (column <= self.half)
        return _Blocks(angle[is_inside], row[is_inside], column[is_inside], np.zeros(int(is_inside.sum())))


def find_best_pose(
    likelihood: LikelihoodField, points: FloatArray, guess: FloatArray, search: Search
) -> Steps[tuple[FloatArray, float]]:
    """Search a window for the pose with the highest response, in steps.

    Args:
        likelihood: the likelihood field of the earlier scans.
        points: the points of the scan, at least one, in the frame of the robot, of shape (n, 2), in meters.
        guess: the center of the window, of shape (3,).
        search: the window.

    Returns:
        The pose, of shape (3,), and its response, reduced by the penalties.
    """
    window = _Window(likelihood, points, guess, search)
    level, blocks = window.create_largest_blocks()
    yield from _rate_in_batches(window, blocks, level)
    best_response, best_block = -1.0, blocks.select(np.s_[:1])
    while level:
        leaf = _descend(window, blocks, level)
        if leaf.bound[0] > best_response:
            best_response, best_block = float(leaf.bound[0]), leaf
        level -= 1
        blocks = window.divide(blocks.select(blocks.bound > best_response), level)
        if not len(blocks.angle):
            break
        yield from _rate_in_batches(window, blocks, level)
    if len(blocks.angle):
        index = int(np.argmax(blocks.bound))
        if blocks.bound[index] > best_response:
            best_response, best_block = float(blocks.bound[index]), blocks.select(np.s_[index : index + 1])
    shift = np.array((best_block.column[0], best_block.row[0])) * likelihood.resolution
    pose: FloatArray = np.array(
        (guess[0] + shift[0], guess[1] + shift[1], guess[2] + window.angles[best_block.angle[0]])
    )
    pose[2] = (pose[2] + pi) % (2 * pi) - pi
    return pose, best_response


def _rate_in_batches(window: _Window, blocks: _Blocks, level: int) -> Steps[None]:
    for begin in range(0, len(blocks.angle), _BATCH_SIZE):
        batch = blocks.select(np.s_[begin : begin + _BATCH_SIZE])
        window.set_bounds(batch, level)
        blocks.bound[begin : begin + _BATCH_SIZE] = batch.bound
        yield


def _descend(window: _Window, blocks: _Blocks, level: int) -> _Blocks:
    """Return the pose found by descending greedily from the best block to its best quarter.

    The pose is a block of one cell.
    """
    index = int(np.argmax(blocks.bound))
    block = blocks.select(np.s_[index : index + 1])
    while level:
        level -= 1
        children = window.divide(block, level)
        window.set_bounds(children, level)
        index = int(np.argmax(children.bound))
        block = children.select(np.s_[index : index + 1])
    return block
