"""Mass properties of the solid inside a closed surface, and the test for closedness."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import Array
from linkwright.geometry.mass import MassProperties
from linkwright.geometry.outlines import GRID_STEPS, MAX_POINT_SIZE

Faces = NDArray[np.int64]


def polyhedron_properties(vertices: Array, faces: Faces) -> MassProperties:
    """Return the mass properties of the solid of density 1 that a closed surface bounds.

    Each triangle spans a tetrahedron with a common point. With ``det = a . (b x c)`` and ``s = a + b + c``, its signed
    volume is ``det / 6``, its first moment ``det / 24 s`` and its second moment ``det / 120 (ss' + aa' + bb' + cc')``.
    The parts outside the solid cancel. Source: Blow, Binstock: *How to find the inertia tensor (or other mass
    properties) of a 3D solid body represented by a triangle mesh*, 2004.

    Args:
        vertices: corners in m, shape (vertices, 3).
        faces: indices of corners, shape (faces, 3), oriented either outwards or inwards.

    Returns:
        The mass properties in the frame of the vertices; without mass if the surface bounds no volume.
    """
    if not len(faces):
        return MassProperties(0.0)
    shift = (vertices.min(axis=0) + vertices.max(axis=0)) / 2.0  # An origin near the solid reduces cancellation.
    corners = (vertices - shift)[faces]
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    det = np.einsum("ij,ij->i", a, np.cross(b, c))
    volume = float(det.sum()) / 6.0
    size = float(np.abs(corners).max(initial=0.0))
    if abs(volume) <= 1e-12 * size**3:
        return MassProperties(0.0)
    total = a + b + c
    center = det @ total / 24.0 / volume
    second_moment = np.einsum("i,ij,ik->jk", det, total, total, optimize=True)
    for corner in (a, b, c):
        second_moment += np.einsum("i,ij,ik->jk", det, corner, corner, optimize=True)
    second_moment = second_moment / 120.0 - volume * np.outer(center, center)
    if volume < 0:
        volume, second_moment = -volume, -second_moment
    inertia = np.trace(second_moment) * np.eye(3) - second_moment
    return MassProperties(volume, center + shift, inertia)


def merge_corners(vertices: Array, faces: Faces) -> tuple[Array, Faces]:
    """Merge corners at the same position, and remove triangles that then have no area.

    STL has no shared corners at all, and other formats split corners where normals or textures differ.
    """
    if not len(faces):
        return vertices, faces
    low = vertices.min(axis=0)
    size = float((vertices.max(axis=0) - low).max(initial=0.0))
    if not size > MAX_POINT_SIZE:
        return vertices[:1], faces[:0]
    cells = np.rint((vertices - low) * (GRID_STEPS / size)).astype(np.int64)
    keys = (cells[:, 0] << 42) | (cells[:, 1] << 21) | cells[:, 2]
    _, first_indices, inverse = np.unique(keys, return_index=True, return_inverse=True)
    merged_faces = inverse.reshape(-1)[faces]
    is_degenerate = (
        (merged_faces[:, 0] == merged_faces[:, 1])
        | (merged_faces[:, 1] == merged_faces[:, 2])
        | (merged_faces[:, 2] == merged_faces[:, 0])
    )
    return vertices[first_indices], merged_faces[~is_degenerate]


def is_closed(faces: Faces) -> bool:
    """Return whether triangles with shared corners bound a volume.

    The condition is that every edge occurs equally often in both directions. This is exactly the condition of the
    divergence theorem. It holds for several bodies in one mesh, and where more than two triangles meet at an edge. It
    does not hold if there is a hole, or if neighbors have opposite orientations.
    """
    if not len(faces):
        return False
    start = faces.reshape(-1)
    end = np.roll(faces, -1, axis=1).reshape(-1)
    count = int(faces.max()) + 1
    return np.array_equal(np.sort(start * count + end), np.sort(end * count + start))
