"""Markers for octree cells, and the properties for selecting and coloring the cells."""

from __future__ import annotations

import colorsys

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.single import Transform
from linkwright.page.protocol.markers import MarkerShape
from linkwright.rviz.config.schema import PropertySpec
from linkwright.rviz.displays.moveit.octree import Cells
from linkwright.rviz.markers.shapes import make_marker

_OCCUPIED, _FREE, _ALL = "Occupied Voxels", "Free Voxels", "All Voxels"
_BY_HEIGHT, BY_PROBABILITY = "Z-Axis", "Cell Probability"
_OCCUPIED_THRESHOLD = 0.5
"""Cells with a higher probability are occupied."""

VOXEL_RENDERING = PropertySpec(
    "Voxel Rendering", "enum", _OCCUPIED, "The cells of the octomap to draw.", options=(_OCCUPIED, _FREE, _ALL)
)
VOXEL_COLORING = PropertySpec(
    "Voxel Coloring",
    "enum",
    _BY_HEIGHT,
    "Whether the color of a cell shows its height or the probability that it is occupied.",
    options=(_BY_HEIGHT, BY_PROBABILITY),
)


def select_rendered(cells: Cells, rendering: str) -> Cells:
    """Return the cells that a value of `VOXEL_RENDERING` selects: all, occupied or free cells."""
    if rendering == _ALL:
        return cells
    return cells.select((cells.probabilities > _OCCUPIED_THRESHOLD) == (rendering == _OCCUPIED))


def make_octomap_markers(
    cells: Cells, namespace: str, *, frame: str, base: Transform, alpha: float, by_probability: bool
) -> list[MarkerShape]:
    """Return cube markers for the visible cells of an octree, one marker for each cell size.

    Args:
        cells: the cells, in the frame of the tree.
        namespace: the markers' namespace.
        frame: the frame that the markers follow.
        base: the pose of the tree in `frame`.
        alpha: the opacity of all cells.
        by_probability: whether the color of a cell shows the probability that the cell is occupied, instead of its
            height.
    """
    cells = cells.select(_find_visible_mask(cells))
    if not len(cells.sizes):
        return []
    colors = np.empty((len(cells.sizes), 4), dtype=np.float32)
    colors[:, 3] = alpha
    if by_probability:
        colors[:, 0] = 1.0 - cells.probabilities
        colors[:, 1] = cells.probabilities
        colors[:, 2] = 0.0
    else:
        height = cells.centers[:, 2]
        lowest, span = float(height.min()), float(np.ptp(height))
        fractions = np.zeros_like(height) if span == 0.0 else (height - lowest) / span
        colors[:, :3] = _RAINBOW[(fractions * (len(_RAINBOW) - 1)).astype(np.intp)]
    markers = []
    for size in np.unique(cells.sizes):
        mask = cells.sizes == size
        points = np.ascontiguousarray(cells.centers[mask], dtype=np.float32)
        edges = [float(size)] * 3
        name = f"octomap {size:g}"
        markers.append(
            make_marker(
                namespace,
                name,
                "cube_list",
                base,
                edges,
                (0.0, 0.0, 0.0, alpha),
                frame=frame,
                points=points,
                colors=np.ascontiguousarray(colors[mask]),
            )
        )
    return markers


_RAINBOW = np.array([colorsys.hsv_to_rgb(0.8 * (1.0 - step / 63.0), 1.0, 1.0) for step in range(64)], dtype=np.float32)


def _find_visible_mask(cells: Cells) -> NDArray[np.bool_]:
    """Return a mask of the cells with at least one side without a neighbor of the same size."""
    is_visible = np.ones(len(cells.sizes), dtype=np.bool_)
    for size in np.unique(cells.sizes):
        mask = cells.sizes == size
        codes = _encode_cells(np.floor(cells.centers[mask] / size).astype(np.int64))
        sorted_codes = np.sort(codes)
        is_enclosed = np.ones(len(codes), dtype=np.bool_)
        for step in _NEIGHBOR_OFFSETS:
            positions = np.searchsorted(sorted_codes, codes + step)
            is_enclosed &= sorted_codes[np.minimum(positions, len(sorted_codes) - 1)] == codes + step
        is_visible[mask] = ~is_enclosed
    return is_visible


_BITS_PER_AXIS = 20
_NEIGHBOR_OFFSETS = (
    1,
    -1,
    1 << _BITS_PER_AXIS,
    -(1 << _BITS_PER_AXIS),
    1 << 2 * _BITS_PER_AXIS,
    -(1 << 2 * _BITS_PER_AXIS),
)
"""The differences between the codes of a cell's six neighbors and the code of the cell."""


def _encode_cells(indices: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return an integer for each cell, unique among cells of the same size.

    The integer encodes the grid indices of the cell. There are at most 2^16 cells of one size along each axis.
    """
    shifted = indices + (1 << (_BITS_PER_AXIS - 1))
    codes: NDArray[np.int64] = shifted[:, 0] << 2 * _BITS_PER_AXIS | shifted[:, 1] << _BITS_PER_AXIS | shifted[:, 2]
    return codes
