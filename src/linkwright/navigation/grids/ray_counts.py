"""Counts of the rays that end in each cell of a grid or pass through the cell."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.grids.rays import cells_on_lines

Counts = NDArray[np.int64]


def count_rays(
    shape: tuple[int, int],
    start: NDArray[np.integer[Any]],
    ends: NDArray[np.integer[Any]],
    hits: NDArray[np.bool_] | None = None,
) -> tuple[Counts, Counts]:
    """Count the rays that end in each cell, and the rays through each cell.

    Args:
        shape: the rows and columns of the grid; cells outside the grid are ignored.
        start: the row and column of the common start, of shape (2,), or of each ray's start, of shape (rays, 2).
        ends: the row and column of each ray's end, of shape (rays, 2).
        hits: whether each ray hit an obstacle, of shape (rays,); None if all rays did. A ray without a hit passes
            through its last cell, too.

    Returns:
        The counts of hits and of passes, both of the shape of the grid.
    """
    cells, ray_indices = cells_on_lines(start, ends)
    is_hit = np.ones(len(ends), np.bool_) if hits is None else hits
    is_hit_cell = np.zeros(len(cells), np.bool_)
    if len(cells):
        is_hit_cell[np.flatnonzero(np.diff(ray_indices, append=len(ends)))] = is_hit
    is_inside = (cells[:, 0] >= 0) & (cells[:, 0] < shape[0]) & (cells[:, 1] >= 0) & (cells[:, 1] < shape[1])
    flat_indices = cells[:, 0] * shape[1] + cells[:, 1]
    size = shape[0] * shape[1]
    hit_counts: Counts = np.bincount(flat_indices[is_inside & is_hit_cell], minlength=size).reshape(shape)
    pass_counts: Counts = np.bincount(flat_indices[is_inside & ~is_hit_cell], minlength=size).reshape(shape)
    return hit_counts, pass_counts
