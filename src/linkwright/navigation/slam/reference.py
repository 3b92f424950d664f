"""Earlier scans, prepared for matching: points, wall directions and a likelihood field."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.grids.library import load_scipy
from linkwright.navigation.slam.poses import FloatArray, transform_points
from linkwright.navigation.slam.scan import PlanarScan

_THINNING_CELL_M = 0.05
_NEIGHBOR_COUNT = 6
_MAX_NEIGHBOR_DISTANCE_M = 0.5
"""The maximum distance of a point's neighbors for its wall to have a direction, in meters."""
_MIN_LIKELIHOOD = 0.01
"""Smaller likelihoods count as 0."""


class Reference:
    """The points of earlier scans, and the directions of their walls.

    Points within 5 cm of each other are replaced by their mean, which is more accurate than one reading.

    Args:
        scans: the laser scans, each in the frame of the robot.
        poses: the poses of the scans, of shape (n, 3), in the frame of the reference.
    """

    def __init__(self, scans: Sequence[PlanarScan], poses: FloatArray) -> None:
        pairs = [(scan, pose) for scan, pose in zip(scans, poses, strict=True) if len(scan.points)]
        self.points: FloatArray = np.zeros((0, 2))
        self._sensor_positions: FloatArray = np.zeros((0, 2))
        if pairs:
            points = np.concatenate([transform_points(pose, scan.points) for scan, pose in pairs])
            sensors = np.concatenate(
                [np.broadcast_to(transform_points(pose, scan.origin[None]), scan.points.shape) for scan, pose in pairs]
            )
            self._average_by_cell(points, sensors)

    def _average_by_cell(self, points: FloatArray, sensors: FloatArray) -> None:
        cells = np.floor((points - points.min(axis=0)) / _THINNING_CELL_M).astype(np.int64)
        _, index = np.unique(cells[:, 0] * (cells[:, 1].max() + 1) + cells[:, 1], return_inverse=True)
        counts = np.bincount(index)

        def mean(values: FloatArray) -> FloatArray:
            sums = [np.bincount(index, weights=values[:, axis]) for axis in (0, 1)]
            result: FloatArray = np.stack(sums, axis=-1) / counts[:, None]
            return result

        self.points, self._sensor_positions = mean(points), mean(sensors)

    def __len__(self) -> int:
        return len(self.points)

    def find_lines(self) -> None:
        """Compute the direction of the wall at each point, as required by `find_nearest`."""
        self._tree = load_scipy("spatial").cKDTree(self.points)
        count = min(_NEIGHBOR_COUNT, len(self.points))
        distances, indices = self._tree.query(self.points, k=count)
        neighbors = self.points[indices.reshape(-1, count)]
        offsets = neighbors - neighbors.mean(axis=1, keepdims=True)
        x, y = offsets[..., 0], offsets[..., 1]
        xx, yy, xy = (x * x).sum(axis=1), (y * y).sum(axis=1), (x * y).sum(axis=1)
        directions = 0.5 * np.arctan2(2 * xy, xx - yy)
        normals = np.stack((-np.sin(directions), np.cos(directions)), axis=-1)
        faces_away = np.einsum("ni,ni->n", normals, self._sensor_positions - self.points) < 0
        normals[faces_away] *= -1
        eigenvalue_differences = np.sqrt((xx - yy) ** 2 + 4 * xy**2)
        total = np.maximum(xx + yy, 1e-12)
        flatness = eigenvalue_differences / total  # 1 for a line, 0 for points scattered in all directions.
        flatness[distances.reshape(-1, count)[:, -1] > _MAX_NEIGHBOR_DISTANCE_M] = 0.0
        self._normals: FloatArray = normals
        self._flatness: FloatArray = flatness if count >= 3 else np.zeros(len(self.points))

    def find_nearest(
        self, points: FloatArray
    ) -> tuple[FloatArray, NDArray[np.int64], FloatArray, FloatArray, FloatArray]:
        """Return the nearest reference point of each of the points, of shape (n, 2).

        Returns:
            Distances (n,), indices (n,), positions (n, 2), normals of the wall towards the sensor (n, 2), and the
            straightness of the wall (n,), 0 to 1.
        """
        distances, indices = self._tree.query(points)
        return distances, indices, self.points[indices], self._normals[indices], self._flatness[indices]


class LikelihoodField:
    """A grid of likelihoods, with the maxima over blocks of 2x2, 4x4, ... cells.

    Args:
        points: the observed points, of shape (n, 2), in meters.
        resolution: the side of a cell, in meters.
        smear_deviation: the standard deviation of the points' positions, in meters.
    """

    def __init__(self, points: FloatArray, resolution: float, smear_deviation: float) -> None:
        self.resolution = resolution
        deviation = max(smear_deviation, resolution / 2)
        margin = 3.1 * deviation + resolution  # Wide enough that the outermost cells are 0.
        self.corner: FloatArray = points.min(axis=0) - margin
        size = np.ceil((points.max(axis=0) + margin - self.corner) / resolution).astype(int) + 1
        is_empty = np.ones((size[1], size[0]), dtype=bool)
        cells = np.floor((points - self.corner) / resolution).astype(int)
        is_empty[cells[:, 1], cells[:, 0]] = False
        distance = load_scipy("ndimage").distance_transform_edt(is_empty, sampling=resolution)
        finest_level = np.exp(-0.5 * (distance / deviation) ** 2).astype(np.float32)
        finest_level[finest_level < _MIN_LIKELIHOOD] = 0.0
        self._levels: list[NDArray[np.float32]] = [finest_level]

    def get_level(self, exponent: int) -> tuple[NDArray[np.float32], int]:
        """Return the grid of maxima over blocks of 2^exponent x 2^exponent cells.

        Returns:
            The grid and an offset n: cell (row + n, column + n) is the maximum of the block that begins at (row,
                column).
        """
        while len(self._levels) <= exponent:
            finer_level, step = self._levels[-1], 1 << (len(self._levels) - 1)
            rows = np.maximum(np.pad(finer_level, ((step, 0), (0, 0))), np.pad(finer_level, ((0, step), (0, 0))))
            coarser_level = np.maximum(np.pad(rows, ((0, 0), (step, 0))), np.pad(rows, ((0, 0), (0, step))))
            self._levels.append(np.ascontiguousarray(coarser_level))
        return self._levels[exponent], (1 << exponent) - 1
