"""An occupancy grid computed from the rays that pass through each cell or end in it.

Source: Karto's occupancy grid, with its parameters ``min_pass_through`` and ``occupancy_threshold``.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.grids.grid import FREE, OCCUPIED, UNKNOWN, Grid
from linkwright.navigation.slam.poses import FloatArray, transform_points
from linkwright.navigation.slam.scan import PlanarScan

_MARGIN_CELLS = 64
"""The margin in cells around the needed area when the arrays of counts grow."""

Cells = NDArray[np.int64]


@dataclass(slots=True, eq=False)
class _Trace:
    """The ray counts of one scan: distinct cells (row, column), with their passes and hits."""

    pose: FloatArray
    cells: Cells
    passes: NDArray[np.int32]
    hits: NDArray[np.int32]


class OccupancyMap:
    """The ray counts of many scans.

    A scan whose pose is corrected can be removed and added again.

    Args:
        resolution: the side of a cell, in meters.
        min_pass_through: a cell is known if more rays than this reached it.
        occupancy_threshold: a cell is occupied if more than this share of those rays ended in it.

    Attributes:
        resolution: the side of a cell, in meters.
    """

    def __init__(self, resolution: float, min_pass_through: int = 2, occupancy_threshold: float = 0.1) -> None:
        self.resolution = resolution
        self._min_pass_through = min_pass_through
        self._threshold = occupancy_threshold
        self._corner: Cells = np.zeros(2, dtype=np.int64)
        self._passes: NDArray[np.int32] = np.zeros((0, 0), dtype=np.int32)
        self._hits: NDArray[np.int32] = np.zeros((0, 0), dtype=np.int32)
        self._traces: dict[int, _Trace] = {}

    def draw(self, scan_index: int, scan: PlanarScan, pose: FloatArray) -> None:
        """Add a scan at a pose of the robot, in place of any scan with the same index.

        `pose` has shape (3,).
        """
        self.erase(scan_index)
        trace = self._trace_scan(scan, pose)
        if not len(trace.cells):
            return
        self._grow_to_contain(trace.cells)
        self._traces[scan_index] = trace
        self._add_counts(trace, 1)

    def erase(self, scan_index: int) -> None:
        """Remove a scan if it was added."""
        trace = self._traces.pop(scan_index, None)
        if trace is not None:
            self._add_counts(trace, -1)

    def get_drawn_pose(self, scan_index: int) -> FloatArray | None:
        """Return the pose at which a scan was added, or None if the scan is not in the map."""
        trace = self._traces.get(scan_index)
        return None if trace is None else trace.pose

    @property
    def is_empty(self) -> bool:
        """Whether no cell was reached by a ray, so that there is no grid."""
        return not self._passes.any()

    def grid(self) -> Grid | None:
        """Return the smallest grid that contains all cells reached by rays.

        The cells are int8: FREE, OCCUPIED or UNKNOWN. Returns None if no cell was reached.
        """
        is_reached = self._passes > 0
        rows, columns = np.flatnonzero(is_reached.any(axis=1)), np.flatnonzero(is_reached.any(axis=0))
        if not len(rows):
            return None
        area = np.s_[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
        passes, hits = self._passes[area], self._hits[area]
        cells = np.full(passes.shape, UNKNOWN, dtype=np.int8)
        is_known = passes > self._min_pass_through
        cells[is_known] = FREE
        cells[is_known & (hits > self._threshold * passes)] = OCCUPIED
        y, x = (int(self._corner[0] + rows[0]), int(self._corner[1] + columns[0]))
        return Grid(cells=cells, resolution=self.resolution, x=x * self.resolution, y=y * self.resolution)

    def _add_counts(self, trace: _Trace, sign: int) -> None:
        rows, columns = (trace.cells - self._corner).T
        self._passes[rows, columns] += sign * trace.passes
        self._hits[rows, columns] += sign * trace.hits

    def _grow_to_contain(self, cells: Cells) -> None:
        low, high = cells.min(axis=0), cells.max(axis=0) + 1
        size = np.array(self._passes.shape)
        if size.all() and (low >= self._corner).all() and (high <= self._corner + size).all():
            return
        if size.all():
            low, high = np.minimum(low, self._corner), np.maximum(high, self._corner + size)
        low, high = low - _MARGIN_CELLS, high + _MARGIN_CELLS
        offset = self._corner - low
        for name in ("_passes", "_hits"):
            enlarged = np.zeros(tuple(high - low), dtype=np.int32)
            enlarged[offset[0] : offset[0] + size[0], offset[1] : offset[1] + size[1]] = getattr(self, name)
            setattr(self, name, enlarged)
        self._corner = low

    def _trace_scan(self, scan: PlanarScan, pose: FloatArray) -> _Trace:
        """Return the counts of the cells along all rays of a scan."""
        ends = transform_points(pose, np.concatenate((scan.points, scan.free_ends)))
        origin = transform_points(pose, scan.origin[None])[0] / self.resolution
        offsets = ends / self.resolution - origin
        counts = np.maximum(np.ceil(np.abs(offsets).max(axis=1)).astype(np.int64), 1)
        first_steps = np.cumsum(counts) - counts
        ray_indices = np.repeat(np.arange(len(ends)), counts)
        fractions = (np.arange(len(ray_indices)) - first_steps[ray_indices]) / counts[ray_indices]
        crossed_cells = np.floor(origin + offsets[ray_indices] * fractions[:, None]).astype(np.int64)[:, ::-1]
        end_cells = np.floor(ends / self.resolution).astype(np.int64)[:, ::-1]
        # Count each cell once per ray, and the last cell only as the ray's end.
        is_repeated = np.zeros(len(crossed_cells), dtype=bool)
        is_repeated[1:] = (crossed_cells[1:] == crossed_cells[:-1]).all(axis=1) & (ray_indices[1:] == ray_indices[:-1])
        crossed_cells = crossed_cells[~is_repeated & (crossed_cells != end_cells[ray_indices]).any(axis=1)]
        hit_cells = end_cells[: len(scan.points)]
        all_cells = np.concatenate((crossed_cells, end_cells))
        if not len(all_cells):
            return _Trace(pose.copy(), np.zeros((0, 2), np.int64), np.zeros(0, np.int32), np.zeros(0, np.int32))
        low = all_cells.min(axis=0)
        height, width = all_cells.max(axis=0) - low + 1

        def counts_of(cells: Cells) -> NDArray[np.int64]:
            flat_indices = (cells[:, 0] - low[0]) * width + cells[:, 1] - low[1]
            result: NDArray[np.int64] = np.bincount(flat_indices, minlength=int(height * width))
            return result

        passes = counts_of(all_cells)
        reached = np.flatnonzero(passes)
        cells = np.column_stack((reached // width + low[0], reached % width + low[1]))
        hits = counts_of(hit_cells)[reached] if len(hit_cells) else np.zeros(len(reached), np.int64)
        return _Trace(pose.copy(), cells, passes[reached].astype(np.int32), hits.astype(np.int32))
