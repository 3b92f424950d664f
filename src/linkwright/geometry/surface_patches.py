"""The split of a surface into patches whose hulls leave its hollows open.

The hull of a patch of a cave or a building fills the space between the surface and its chords. Patches are therefore
cut until they are nearly flat, small, or numerous. The patch that fills the most space is cut first, across the
principal axis after which its halves fill the least.
"""

from __future__ import annotations

import heapq
from collections.abc import Callable
from functools import partial
from itertools import count
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import Array

_MIN_SIZE, _MIN_SHARE = 0.2, 0.02
"""The length below which a patch is not cut: in m, and as a share of the size of the surface."""
_MIN_DEPTH = 0.02
"""The depth in m below which a patch counts as flat."""
_MIN_FILLED = 1e-3
"""The volume in m3 below which a patch is not cut."""
_ANGLES = np.linspace(0.0, 2.0 * np.pi, 16, endpoint=False)
_DIRECTIONS = np.stack([np.cos(_ANGLES), np.sin(_ANGLES)])
"""The directions of a plane in which the extreme points of a patch outline its hull, shape (2, 16)."""

Triangles = NDArray[np.float64]
"""The corners of triangles in m, shape (triangles, 3, 3)."""


class _Patch(NamedTuple):
    """Triangles, the estimated volume in m3 that their hull fills, and their principal axes."""

    filled: float
    triangles: Triangles
    axes: Array


def split_into_patches(triangles: Triangles, max_patches: int, *, is_solid: bool) -> list[Triangles]:
    """Return the triangles of a surface, distributed among patches.

    Args:
        triangles: corners in m, shape (triangles, 3, 3), counterclockwise from outside if the surface is solid.
        max_patches: the maximum number of patches.
        is_solid: whether the surface encloses a body, whose inside may be filled.
    """
    size = float(np.ptp(triangles.reshape(-1, 3), axis=0).max())
    make_patch = partial(_make_patch, min_size=max(_MIN_SIZE, _MIN_SHARE * size), is_solid=is_solid)
    numbers = count()
    first = make_patch(triangles)
    patches = [(-first.filled, next(numbers), first)]
    while len(patches) < max_patches and -patches[0][0] > _MIN_FILLED:
        _, _, patch = heapq.heappop(patches)
        for half in _cut(patch, make_patch) or [patch._replace(filled=0.0)]:
            heapq.heappush(patches, (-half.filled, next(numbers), half))
    return [patch.triangles for _, _, patch in patches]


def _cut(patch: _Patch, make_patch: Callable[[Triangles], _Patch]) -> list[_Patch]:
    """Return the two halves of a patch that fill the least space, or nothing if it cannot be cut."""
    centers = patch.triangles.mean(axis=1)
    best: list[_Patch] = []
    for axis in patch.axes:
        positions = centers @ axis
        is_first = positions < positions.mean()
        if is_first.all() or not is_first.any():
            continue
        halves = [make_patch(patch.triangles[is_first]), make_patch(patch.triangles[~is_first])]
        if not best or sum(half.filled for half in halves) < sum(half.filled for half in best):
            best = halves
    return best


def _make_patch(triangles: Triangles, min_size: float, *, is_solid: bool) -> _Patch:
    """Return a patch, with the volume that its hull fills.

    A patch fills the space between its chords and its surface, and the openings of its outline. An opening counts as
    deep as it is wide.
    """
    points = triangles.reshape(-1, 3)
    centered = points - points.mean(axis=0)
    _, axes = np.linalg.eigh(centered.T @ centered)
    axes = axes.T[::-1]  # The longest axis comes first.
    local = centered @ axes.T
    extents = np.ptp(local, axis=0)
    if len(triangles) == 1 or extents.max() < min_size:
        return _Patch(0.0, triangles, axes)
    outline = local[(local[:, :2] @ _DIRECTIONS).argmax(axis=0)]
    x, y = outline[:, 0], outline[:, 1]
    hull_area = abs(float(x @ np.roll(y, -1) - y @ np.roll(x, -1))) / 2.0
    corners = local.reshape(-1, 3, 3)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2.0
    facing = normals[:, 2] * np.linalg.det(axes)  # The axes may be a left-handed frame.
    covered = max(float(facing[facing > 0.0].sum()), float(-facing[facing < 0.0].sum()))
    depth = float(extents[2])
    if is_solid:
        extremes = np.concatenate((outline, local[[local[:, 2].argmin(), local[:, 2].argmax()]]))
        depth = min(depth, _find_height(corners, normals * np.linalg.det(axes), extremes))
    if depth < _MIN_DEPTH:
        depth = 0.0
    return _Patch(depth * hull_area + max(hull_area - covered, 0.0) ** 1.5, triangles, axes)


def _find_height(corners: Triangles, normals: Array, points: Array) -> float:
    """Return the largest height in m of points above the planes of triangles."""
    lengths = np.linalg.norm(normals, axis=1)
    is_usable = lengths > 0.0
    units = normals[is_usable] / lengths[is_usable, None]
    heights = units @ points.T - np.einsum("ij,ij->i", units, corners[is_usable, 0])[:, None]
    return float(heights.max(initial=0.0))
