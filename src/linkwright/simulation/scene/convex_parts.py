"""The split of a mesh into convex hulls that contain it and leave less space empty than the hull of the whole mesh.

A link with the shape of an L or a U fills a small part of its hull, so that the hull collides where the link does not.
The mesh is cut by the plane after which the two hulls have the smallest volume together, and so are its parts, as long
as that saves enough. Triangles are cut exactly, so that no point of the mesh is outside of the hulls. MuJoCo computes
the volumes and the hulls, which takes a few hundred microseconds for each.
"""

from __future__ import annotations

import heapq
from collections.abc import Sequence
from itertools import count
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import Array
from linkwright.geometry.polyhedron import Faces
from linkwright.simulation.library import load_mujoco

_MAX_PARTS = 8
_MIN_SAVING = 0.02
"""The volume that a cut saves at least, as a share of the hull of the whole mesh."""
_CUTS = (0.2, 0.35, 0.5, 0.65, 0.8)
"""The positions of planes that are tried, as shares of the extent along each axis."""
_CELLS = 24
"""The number of cells along the longest side in which one point is kept to estimate volumes."""
_MIN_POINTS = 4
_MIN_THICKNESS = 1e-5
"""The thickness of points without volume, as a share of their length."""

Triangles = NDArray[np.float64]
"""The corners of triangles in m, shape (triangles, 3, 3)."""


class _Cut(NamedTuple):
    """A plane across an axis, and the volume in m3 that it saves."""

    saving: float
    axis: int
    position: float


def split_into_hulls(vertices: Array, faces: Faces) -> list[Array]:
    """Return the corners of convex hulls that contain a surface; none for a surface that is nearly flat.

    Args:
        vertices: corners in m, shape (vertices, 3).
        faces: indices of corners, shape (faces, 3).
    """
    used = vertices[np.unique(faces)]
    size = float(np.ptp(used, axis=0).max()) if len(used) else 0.0
    if not (size > 0.0 and np.isfinite(size) and _has_volume(used)):
        return []
    triangles = vertices[faces] / size  # MuJoCo refuses hulls with a tiny volume.
    whole = _volumes([_thin(triangles.reshape(-1, 3))])[0]
    numbers = count()
    first = _find_cut(triangles, whole)
    parts = [(-first.saving, next(numbers), triangles, first)]
    while len(parts) < _MAX_PARTS and -parts[0][0] > _MIN_SAVING * whole:
        _, _, part, cut = heapq.heappop(parts)
        for side in (1.0, -1.0):
            half = _clip(part, cut.axis, cut.position, side)
            best = _find_cut(half, _volumes([_thin(half.reshape(-1, 3))])[0])
            heapq.heappush(parts, (-best.saving, next(numbers), half, best))
    return [size * corners for corners in _hulls([part[2].reshape(-1, 3) for part in parts])]


def _find_cut(triangles: Triangles, volume: float) -> _Cut:
    """Return the plane that saves most, by estimated volumes."""
    points = _thin(triangles.reshape(-1, 3))
    low, extent = points.min(axis=0), np.ptp(points, axis=0)
    planes = [(axis, float(low[axis] + share * extent[axis])) for axis in range(3) for share in _CUTS]
    halves = []
    for axis, position in planes:
        crossings = _thin(_crossings(triangles, axis, position))
        halves.append(np.concatenate((points[points[:, axis] <= position], crossings)))
        halves.append(np.concatenate((points[points[:, axis] >= position], crossings)))
    volumes = _volumes(halves).reshape(-1, 2)
    sums = np.where(volumes.all(axis=1), volumes.sum(axis=1), np.inf)  # A flat half would have no hull.
    best = int(sums.argmin())
    return _Cut(volume - float(sums[best]), *planes[best])


def _crossings(triangles: Triangles, axis: int, position: float) -> Array:
    """Return the points at which edges of triangles cross a plane, shape (points, 3)."""
    heights = triangles[:, :, axis] - position
    points = []
    for first, second in ((0, 1), (1, 2), (2, 0)):
        crossing = heights[:, first] * heights[:, second] < 0.0
        start, end = triangles[crossing, first], triangles[crossing, second]
        share = heights[crossing, first] / (heights[crossing, first] - heights[crossing, second])
        points.append(start + share[:, None] * (end - start))
    return np.concatenate(points)


def _clip(triangles: Triangles, axis: int, position: float, side: float) -> Triangles:
    """Return the parts of triangles below a plane (side 1) or above it (side -1), again as triangles."""
    heights = side * (triangles[:, :, axis] - position)
    outside = (heights > 0.0).sum(axis=1)
    pieces = [triangles[outside == 0]]
    for is_one_outside, chosen in ((True, outside == 1), (False, outside == 2)):
        corners, levels = triangles[chosen], heights[chosen]
        if not len(corners):
            continue
        single = ((levels > 0.0) == is_one_outside).argmax(axis=1)[:, None]
        order = (single + np.arange(3)) % 3  # The corner that is alone on its side comes first.
        corners = np.take_along_axis(corners, order[:, :, None], axis=1)
        levels = np.take_along_axis(levels, order, axis=1)
        alone, second, third = (corners[:, number] for number in range(3))
        shares = levels[:, :1] / (levels[:, :1] - levels[:, 1:])
        to_second = alone + shares[:, :1] * (second - alone)
        to_third = alone + shares[:, 1:] * (third - alone)
        if is_one_outside:
            pieces.append(np.stack((to_second, second, third), axis=1))
            pieces.append(np.stack((to_second, third, to_third), axis=1))
        else:
            pieces.append(np.stack((alone, to_second, to_third), axis=1))
    return np.concatenate(pieces)


def _thin(points: Array) -> Array:
    """Return one point of each cell of a grid."""
    if not len(points):
        return points
    low, extent = points.min(axis=0), float(np.ptp(points, axis=0).max())
    cells = ((points - low) * (_CELLS / extent if extent else 0.0)).astype(np.int64)
    _, kept = np.unique(cells @ np.array([1, 100, 10_000]), return_index=True)
    kept_points: Array = points[kept]
    return kept_points


def _has_volume(points: Array) -> bool:
    if len(points) < _MIN_POINTS:
        return False
    extents = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    return bool(extents[-1] > _MIN_THICKNESS * extents[0])


def _volumes(point_sets: Sequence[Array]) -> Array:
    """Return the volumes in m3 of the convex hulls of sets of points; 0 for points without volume."""
    volumes = np.zeros(len(point_sets))
    solid = [number for number, points in enumerate(point_sets) if _has_volume(points)]
    if solid:
        volumes[solid] = _compile([point_sets[number] for number in solid]).body_mass[1:]
    return volumes


def _hulls(point_sets: Sequence[Array]) -> list[Array]:
    """Return the corners of the convex hulls of sets of points."""
    model = _compile(point_sets)
    hulls = []
    for points, start in zip(point_sets, model.mesh_graphadr, strict=True):
        corners = int(model.mesh_graph[start])
        first = start + 2 + corners  # After two counts and the addresses of edges, the graph has the corners' indices.
        hulls.append(points[model.mesh_graph[first : first + corners]])
    return hulls


def _compile(point_sets: Sequence[Array]) -> Any:
    """Return a model of MuJoCo with a body for each set of points, whose mass is the volume of the hull."""
    mujoco = load_mujoco()
    spec = mujoco.MjSpec()
    for number, points in enumerate(point_sets):
        mesh = spec.add_mesh(name=str(number), uservert=points.ravel().tolist())
        mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_CONVEX
        body = spec.worldbody.add_body()
        body.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname=mesh.name, density=1.0)
    return spec.compile()
