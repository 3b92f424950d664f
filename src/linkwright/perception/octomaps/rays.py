"""The cells that rays pass through.

Source: Amanatides and Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing", 1987.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Keys = NDArray[np.int64]


def find_passed_cells(origin: NDArray[np.float64], ends: NDArray[np.float64], resolution: float) -> Keys:
    """Return the cells on rays without their last cells, shape (n, 3); a cell may occur more than once.

    Args:
        origin: the start of all rays, shape (3,), in meters.
        ends: the ends of the rays, shape (rays, 3).
        resolution: the side of a cell.
    """
    start = np.floor(origin / resolution).astype(np.int64)
    targets = np.floor(ends / resolution).astype(np.int64)
    directions = ends - origin
    steps = np.sign(directions).astype(np.int64)
    with np.errstate(divide="ignore", invalid="ignore"):
        borders = (start + (steps > 0)) * resolution
        next_times = np.where(steps != 0, (borders - origin) / directions, np.inf)
        intervals = np.where(steps != 0, resolution / np.abs(directions), np.inf)
    remaining = np.abs(targets - start).sum(axis=1)
    cells = np.broadcast_to(start, targets.shape).copy()
    passed = []
    while True:
        is_active = remaining > 0
        if not is_active.any():
            break
        if not is_active.all():
            cells, next_times, intervals, steps, remaining = (
                array[is_active] for array in (cells, next_times, intervals, steps, remaining)
            )
        passed.append(cells.copy())
        axes, rows = np.argmin(next_times, axis=1), np.arange(len(cells))
        cells[rows, axes] += steps[rows, axes]
        next_times[rows, axes] += intervals[rows, axes]
        remaining = remaining - 1
    return np.concatenate(passed) if passed else np.zeros((0, 3), dtype=np.int64)
