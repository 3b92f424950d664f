"""The convex hull of points in space, computed by the quickhull algorithm.

Source: Barber, Dobkin, Huhdanpaa: *The Quickhull Algorithm for Convex Hulls*, ACM TOMS 22, 1996. The algorithm starts
from a tetrahedron. While a face has points outside it, the farthest of them replaces all faces that are visible from
it. Rounding can make the edge around these faces touch itself. The hull is then computed again from points that are
moved a little, as the option QJ of Qhull does.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import Array
from linkwright.geometry.polyhedron import Faces

_TOLERANCE = 1e-9
"""The distance within which points count as on a face, as a fraction of the extent of all points."""

_MAX_SHIFT = 1e-4
"""The maximum distance by which points are moved, as a fraction of their extent."""
_SHIFT_GROWTH = 10.0
_MULTIPLIERS = np.array([7919, 104729, 1299709])
_MODULUS = 15485863
"""Prime numbers whose products are as good as random for moving points, and the same on every machine."""

Indices = NDArray[np.int64]
Triangle = tuple[int, int, int]


def convex_hull(points: Array) -> Faces | None:
    """Return the triangles of the convex hull, facing outwards.

    Args:
        points: shape (points, 3).

    Returns:
        Indices into the points, shape (faces, 3); None if the points are coplanar, or so nearly that rounding hides the
        volume.
    """
    if len(points) < 4:
        return None
    size = float(np.ptp(points, axis=0).max())
    if not (size > 0 and np.isfinite(size)):
        return None
    start = _find_tetrahedron(points, _TOLERANCE * size)
    if start is None:
        return None
    faces, shift = None, 0.0
    while faces is None and shift <= _MAX_SHIFT:
        faces = _Hull(_move(points, shift * size), start, _TOLERANCE * size).grow()
        shift = max(shift, _TOLERANCE) * _SHIFT_GROWTH
    return faces


def _move(points: Array, distance: float) -> Array:
    """Return points that are moved by up to a distance along each axis."""
    if not distance:
        return points
    numbers = np.arange(1, len(points) + 1)[:, np.newaxis] * _MULTIPLIERS % _MODULUS
    shifts: Array = distance * (2.0 * numbers / _MODULUS - 1.0)
    return points + shifts


class _Hull:
    """A hull under construction, initially a tetrahedron.

    Attributes:
        edges: the face of each directed edge, by start and end. The edge in the opposite direction belongs to a
            neighbor.
        outside_points: the points outside each face; each point is assigned to only one face.
    """

    def __init__(self, points: Array, start: tuple[int, int, int, int], tolerance: float) -> None:
        self.points = points
        self.tolerance = tolerance
        self.faces: dict[int, Triangle] = {}
        self.planes: dict[int, tuple[Array, float]] = {}
        self.edges: dict[tuple[int, int], int] = {}
        self.outside_points: dict[int, Indices] = {}
        self._next_id = 0
        a, b, c, d = start
        self._add_faces([(a, b, c), (a, d, b), (b, d, c), (c, d, a)], np.arange(len(points), dtype=np.int64))

    def grow(self) -> Faces | None:
        """Add points until none is outside the hull, and return the faces.

        The result is None if rounding made the edge around the faces that a point sees touch itself.
        """
        while self.outside_points:
            face, candidates = self.outside_points.popitem()
            normal, offset = self.planes[face]
            apex = int(candidates[np.argmax(self.points[candidates] @ normal - offset)])
            self.outside_points[face] = candidates
            visible, horizon = self._find_visible(face, self.points[apex])
            if not _is_ring(horizon):
                return None
            self._add_point(apex, visible, horizon)
        return np.array(list(self.faces.values()), dtype=np.int64)

    def _add_point(self, apex: int, visible: set[int], horizon: list[tuple[int, int]]) -> None:
        freed_points = [self._remove_face(visible_face) for visible_face in visible]
        remaining = np.concatenate(freed_points)
        self._add_faces([(a, b, apex) for a, b in horizon], remaining[remaining != apex])

    def _find_visible(self, face: int, point: Array) -> tuple[set[int], list[tuple[int, int]]]:
        """Return the faces that are visible from a point, and the edges around them.

        `face` is one of the visible faces, from which the search starts.
        """
        visible, hidden = {face}, set()
        pending = [face]
        horizon = []
        while pending:
            for edge in _get_edges(self.faces[pending.pop()]):
                neighbor = self.edges[edge[1], edge[0]]
                if neighbor in visible:
                    continue
                if neighbor not in hidden:
                    normal, offset = self.planes[neighbor]
                    if float(point @ normal) - offset > self.tolerance:
                        visible.add(neighbor)
                        pending.append(neighbor)
                        continue
                    hidden.add(neighbor)
                horizon.append(edge)
        return visible, horizon

    def _remove_face(self, face: int) -> Indices:
        for edge in _get_edges(self.faces.pop(face)):
            del self.edges[edge]
        del self.planes[face]
        return self.outside_points.pop(face, _NO_INDICES)

    def _add_faces(self, triangles: list[Triangle], unassigned: Indices) -> None:
        """Add faces, and assign the points that have no face to them.

        A point is assigned to the face that it is farthest outside of, or dropped if it is inside all of them.
        """
        corners = self.points[np.array(triangles, dtype=np.int64)]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        lengths = np.linalg.norm(normals, axis=1, keepdims=True)
        normals = np.divide(normals, lengths, out=np.zeros_like(normals), where=lengths > 0)
        plane_offsets = np.einsum("ij,ij->i", normals, corners[:, 0])
        face_ids = range(self._next_id, self._next_id + len(triangles))
        self._next_id += len(triangles)
        for face_id, triangle, normal, offset in zip(face_ids, triangles, normals, plane_offsets, strict=True):
            self.faces[face_id] = triangle
            self.planes[face_id] = (normal, float(offset))
            for edge in _get_edges(triangle):
                self.edges[edge] = face_id
        if len(unassigned):
            heights = self.points[unassigned] @ normals.T - plane_offsets
            best = heights.argmax(axis=1)
            is_outside = heights[np.arange(len(unassigned)), best] > self.tolerance
            unassigned, best = unassigned[is_outside], best[is_outside]
            for index in np.unique(best):
                self.outside_points[face_ids[int(index)]] = unassigned[best == index]


_NO_INDICES: Indices = np.empty(0, dtype=np.int64)


def _get_edges(triangle: Triangle) -> Iterable[tuple[int, int]]:
    a, b, c = triangle
    return (a, b), (b, c), (c, a)


def _is_ring(edges: list[tuple[int, int]]) -> bool:
    """Return whether directed edges form one ring that visits each of its points once."""
    following = dict(edges)
    point, count = edges[0][0], 0
    while count < len(edges) and point in following:
        point, count = following[point], count + 1
        if point == edges[0][0]:
            break
    return count == len(following) == len(edges)


def _find_tetrahedron(points: Array, tolerance: float) -> tuple[int, int, int, int] | None:
    """Return the indices of four points that are far apart, or None if all points are coplanar.

    The fourth point is below the plane of the others.
    """
    axis = int(np.ptp(points, axis=0).argmax())
    a, b = int(points[:, axis].argmin()), int(points[:, axis].argmax())
    direction = (points[b] - points[a]) / np.linalg.norm(points[b] - points[a])
    offsets = points - points[a]
    distances = np.linalg.norm(offsets - np.outer(offsets @ direction, direction), axis=1)
    c = int(distances.argmax())
    if distances[c] <= tolerance:
        return None
    normal = np.cross(points[b] - points[a], points[c] - points[a])
    heights = offsets @ (normal / np.linalg.norm(normal))
    d = int(np.abs(heights).argmax())
    if abs(heights[d]) <= tolerance:
        return None
    return (a, b, c, d) if heights[d] < 0 else (a, c, b, d)
