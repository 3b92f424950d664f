"""Rasterize triangles into samples with array operations.

The triangles become rows, and the rows become fragments: samples whose center is inside the triangle. The corners are
snapped to a grid finer than a sample, and an edge that two triangles share is computed in the same way for both, so
that each sample on it belongs to one of them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import Array
from linkwright.picture.vectors import Floats, Indices, repeat_indices

_SNAP = 256.0
"""Corners are rounded to multiples of 1 / _SNAP samples."""
_MAX_FRAGMENTS = 1 << 20
"""The approximate number of fragments to compute at once."""
_SLIVER = 1e-7
"""Twice the area, in samples, below which a triangle is treated as parallel to the image."""
_TRIANGLE_BITS = 27
MAX_TRIANGLES = 1 << _TRIANGLE_BITS
"""The maximum number of triangles in an image."""
_DEPTH_STEPS = float(1 << 20)
"""The number of distance steps in a scene. Surfaces in one plane must get the same step despite rounding."""
NOTHING = np.iinfo(np.int64).max
"""The key of a sample at which no triangle is visible."""


@dataclass(frozen=True, slots=True)
class ScreenTriangles:
    """Triangles on a grid of samples.

    Attributes:
        x: the corners, in samples from the left, shape (n, 3).
        y: the corners, in samples from the top, shape (n, 3).
        nearness: the nearness at the corners, shape (n, 3).
        gradients: how much the nearness changes per sample along x and y, shape (n, 2).
    """

    x: Array
    y: Array
    nearness: Array
    gradients: Array

    @classmethod
    def from_faces(cls, x: Array, y: Array, nearness: Array, faces: Indices) -> ScreenTriangles:
        """Return the triangles with the given corners.

        `faces` has the indices of the corners, shape (n, 3).
        """
        tx, ty, tn = x[faces], y[faces], nearness[faces]
        x1, y1, n1 = tx[:, 1] - tx[:, 0], ty[:, 1] - ty[:, 0], tn[:, 1] - tn[:, 0]
        x2, y2, n2 = tx[:, 2] - tx[:, 0], ty[:, 2] - ty[:, 0], tn[:, 2] - tn[:, 0]
        area = x1 * y2 - x2 * y1
        is_sliver = np.abs(area) < _SLIVER
        divisor = np.where(is_sliver, 1.0, area)
        gradients = np.stack([(n1 * y2 - n2 * y1) / divisor, (n2 * x1 - n1 * x2) / divisor], axis=1)
        gradients[is_sliver] = 0.0
        return cls(tx, ty, tn, gradients)


@dataclass(frozen=True, slots=True)
class Fragments:
    """Samples that are inside triangles.

    Attributes:
        triangles: the index of the triangle of each fragment.
        samples: the index of each fragment's sample on the grid, row by row.
        nearness: the nearness of each fragment.
    """

    triangles: Indices
    samples: Indices
    nearness: Array


def rasterize(
    triangles: ScreenTriangles, selected: Indices, width: int, first_row: int, last_row: int
) -> Iterator[Fragments]:
    """Yield the fragments of triangles in rows of the grid, in batches.

    Args:
        triangles: the triangles in samples of the grid.
        selected: the indices of the triangles to rasterize.
        width: the number of samples in a row.
        first_row: the first row.
        last_row: the row after the last one. Samples are counted from the first row.
    """
    x, y = triangles.x[selected], triangles.y[selected]
    top = np.ceil(np.clip(y.min(axis=1) - 0.5, first_row, last_row)).astype(np.int64)
    bottom = np.ceil(np.clip(y.max(axis=1) - 0.5, first_row, last_row)).astype(np.int64)
    is_on_grid = (bottom > top) & (x.max(axis=1) > 0.0) & (x.min(axis=1) < width)
    selected, top, counts = selected[is_on_grid], top[is_on_grid], (bottom - top)[is_on_grid]
    x, y = _sort_by_row(np.rint(x[is_on_grid] * _SNAP) / _SNAP, np.rint(y[is_on_grid] * _SNAP) / _SNAP)
    slopes = _compute_slopes(x, y)
    low, high = triangles.nearness[selected].min(axis=1), triangles.nearness[selected].max(axis=1)
    start = 0
    ends = np.cumsum(counts)
    while start < len(selected):
        previous_end = int(ends[start - 1]) if start else 0
        stop = max(start + 1, int(np.searchsorted(ends, previous_end + _MAX_FRAGMENTS // 4, side="right")))
        batch = slice(start, stop)
        owners, row_steps = repeat_indices(counts[batch])
        owners = owners + start
        rows = top[owners] + row_steps
        left, right = _find_spans(x, y, slopes, owners, rows + 0.5, width)
        is_filled = right > left
        owners, rows = owners[is_filled], rows[is_filled]
        left, right = left[is_filled], right[is_filled]
        yield from _rasterize_spans(triangles, selected, owners, rows, left, right, (low, high), width, first_row)
        start = stop


def _rasterize_spans(
    triangles: ScreenTriangles,
    selected: Indices,
    owners: Indices,
    rows: Indices,
    left: Indices,
    right: Indices,
    limits: tuple[Array, Array],
    width: int,
    first_row: int,
) -> Iterator[Fragments]:
    """Yield the fragments of the spans from `left` to `right`, in batches.

    `owners` has the index in `selected` of the triangle of each span.
    """
    triangle_ids = selected[owners]
    downward = triangles.gradients[triangle_ids, 1] * (rows + 0.5 - triangles.y[triangle_ids, 0])
    across, corner = triangles.gradients[triangle_ids, 0], triangles.x[triangle_ids, 0]
    base = triangles.nearness[triangle_ids, 0]
    counts = right - left
    # The nearness of a narrow triangle must not exceed that of its corners after rounding.
    low, high = limits[0][owners], limits[1][owners]
    at_left = np.clip(base + across * (left + 0.5 - corner) + downward, low, high)
    at_right = np.clip(base + across * (right - 0.5 - corner) + downward, low, high)
    across = (at_right - at_left) / np.maximum(counts - 1, 1)
    starts = (rows - first_row) * width + left
    ends = np.cumsum(counts)
    begin = 0
    while begin < len(owners):
        previous_end = int(ends[begin - 1]) if begin else 0
        stop = max(begin + 1, int(np.searchsorted(ends, previous_end + _MAX_FRAGMENTS, side="right")))
        batch = slice(begin, stop)
        repeats = counts[batch]
        steps = np.arange(int(ends[stop - 1]) - previous_end) - np.repeat(ends[batch] - repeats - previous_end, repeats)
        yield Fragments(
            np.repeat(triangle_ids[batch], repeats),
            np.repeat(starts[batch], repeats) + steps,
            np.repeat(at_left[batch], repeats) + np.repeat(across[batch], repeats) * steps,
        )
        begin = stop


def _sort_by_row(x: Array, y: Array) -> tuple[Array, Array]:
    """Return the corners of each triangle, sorted from top to bottom.

    Corners in the same row are sorted from left to right.
    """
    xs, ys = [x[:, corner] for corner in range(3)], [y[:, corner] for corner in range(3)]
    for first, second in ((0, 1), (1, 2), (0, 1)):
        swaps = (ys[second] < ys[first]) | ((ys[second] == ys[first]) & (xs[second] < xs[first]))
        for values in (xs, ys):
            values[first], values[second] = (
                np.where(swaps, values[second], values[first]),
                np.where(swaps, values[first], values[second]),
            )
    return np.stack(xs, axis=1), np.stack(ys, axis=1)


def _compute_slopes(x: Array, y: Array) -> tuple[Array, Array, Array]:
    """Return the change of x per row along the upper, lower and long edge of each triangle."""
    slopes = []
    for first, second in ((0, 1), (1, 2), (0, 2)):
        height = y[:, second] - y[:, first]
        slopes.append(np.where(height > 0, (x[:, second] - x[:, first]) / np.where(height > 0, height, 1.0), 0.0))
    return slopes[0], slopes[1], slopes[2]


def _find_spans(
    x: Array, y: Array, slopes: tuple[Array, Array, Array], owners: Indices, centers: Floats, width: int
) -> tuple[Indices, Indices]:
    """Return the first sample of each row inside its triangle, and the sample after the last."""
    is_upper = centers < y[owners, 1]
    corner = np.where(is_upper, 0, 1)
    short = x[owners, corner] + (centers - y[owners, corner]) * np.where(is_upper, slopes[0][owners], slopes[1][owners])
    long = x[owners, 0] + (centers - y[owners, 0]) * slopes[2][owners]
    left = np.ceil(np.clip(np.minimum(short, long) - 0.5, 0, width)).astype(np.int64)
    right = np.ceil(np.clip(np.maximum(short, long) - 0.5, 0, width)).astype(np.int64)
    return left, right


@dataclass(frozen=True, slots=True)
class VisibleTriangles:
    """The samples of a buffer at which a triangle is visible.

    Attributes:
        window: the rows and columns that contain them.
        mask: whether a triangle is seen at each sample of the window, shape (rows, columns).
        triangles: the triangle at each of these samples, row by row.
        distances: its distance, 0 to 1 within the scene.
        x: the centers of the samples, from the left.
        y: the centers of the samples, from the top.
    """

    window: tuple[slice, slice]
    mask: NDArray[np.bool_]
    triangles: Indices
    distances: Floats
    x: Floats
    y: Floats


class DepthBuffer:
    """A buffer with the nearest triangle at each sample.

    Each sample has a key: the distance in steps, then the index of the triangle. Of triangles at the same distance, the
    first one is seen, whatever the order in which they were added.

    Args:
        width: the number of samples in a row.
        first_row: the first row of the buffer.
        last_row: the row after the last one.
        nearest: the largest nearness of the scene.
        farthest: the smallest nearness of the scene.
    """

    def __init__(self, width: int, first_row: int, last_row: int, nearest: float, farthest: float) -> None:
        self.width = width
        self.first_row, self.last_row = first_row, last_row
        self.keys: NDArray[np.int64] = np.full((last_row - first_row) * width, NOTHING)
        self._nearest = nearest
        self._steps = _DEPTH_STEPS / max(nearest - farthest, 1e-12)

    def make_empty_copy(self) -> DepthBuffer:
        """Return an empty buffer of the same extent."""
        copy = DepthBuffer(self.width, self.first_row, self.last_row, self._nearest, self._nearest - 1.0)
        copy._steps = self._steps
        return copy

    @property
    def is_empty(self) -> bool:
        """Whether the buffer contains no triangle."""
        return bool((self.keys == NOTHING).all())

    def add(
        self,
        triangles: ScreenTriangles,
        selected: Indices,
        *,
        behind: DepthBuffer | None = None,
        in_front_of: DepthBuffer | None = None,
    ) -> None:
        """Add triangles.

        Args:
            triangles: the triangles in samples of the grid.
            selected: the indices of the triangles to add.
            behind: only samples behind this buffer's triangles are added.
            in_front_of: only samples in front of this buffer's triangles are added.
        """
        for batch in rasterize(triangles, selected, self.width, self.first_row, self.last_row):
            steps = np.maximum((self._nearest - batch.nearness) * self._steps, 0.0).astype(np.int64)
            keys = (steps << _TRIANGLE_BITS) | batch.triangles
            samples = batch.samples
            for other, is_behind in ((behind, True), (in_front_of, False)):
                if other is not None:
                    is_kept = (keys > other.keys[samples]) if is_behind else (keys < other.keys[samples])
                    samples, keys = samples[is_kept], keys[is_kept]
            np.minimum.at(self.keys, samples, keys)

    def visible_triangles(self, block_size: int) -> VisibleTriangles | None:
        """Return the visible triangles, or None if there are none.

        Args:
            block_size: the extent of the result is a multiple of this number of samples.
        """
        keys = self.keys.reshape(-1, self.width)
        is_seen = keys != NOTHING
        rows, columns = np.flatnonzero(is_seen.any(axis=1)), np.flatnonzero(is_seen.any(axis=0))
        if not len(rows):
            return None
        window = (_align_range(rows, len(keys), block_size), _align_range(columns, self.width, block_size))
        mask = is_seen[window]
        seen_keys = keys[window][mask]
        distances = (seen_keys >> _TRIANGLE_BITS).astype(np.float32)
        distances *= np.float32(1.0 / _DEPTH_STEPS)
        y, x = np.nonzero(mask)
        return VisibleTriangles(
            window,
            mask,
            seen_keys & (MAX_TRIANGLES - 1),
            distances,
            (x + (window[1].start + 0.5)).astype(np.float32),
            (y + (window[0].start + self.first_row + 0.5)).astype(np.float32),
        )


def _align_range(indices: Indices, count: int, step: int) -> slice:
    """Return a range of indices, extended by one step on both sides.

    The ends are rounded outward to multiples of the step.
    """
    first, last = int(indices[0]) // step - 1, int(indices[-1]) // step + 2
    return slice(max(first * step, 0), min(last * step, count))
