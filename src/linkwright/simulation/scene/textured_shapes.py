"""Simple shapes as triangle meshes with texture coordinates.

Source: gz-common's ``MeshManager``. Each side of a box shows the image, upright on the lateral sides. On cylinders and
spheres, the image runs clockwise around the axis as seen from above. It is upside down on a cylinder, and the poles of
a sphere are on the y axis.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import cos, pi, sin

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.geometry.mesh_parts import Triangles
from linkwright.geometry.shapes import Box, Cylinder, Sphere
from linkwright.sdf.shapes import Plane, Shape

_BOX_DIVISIONS, _PLANE_DIVISIONS = 4, 16
"""The divisions of a box side and of a plane in each direction, because light is computed at vertices."""
_SEGMENTS, _RINGS = 64, 32
"""The numbers of divisions of a round shape: around its axis, and along it."""
_SIDES = (
    ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    ((-1, 0, 0), (0, -1, 0), (0, 0, 1)),
    ((0, 1, 0), (-1, 0, 0), (0, 0, 1)),
    ((0, -1, 0), (1, 0, 0), (0, 0, 1)),
    ((0, 0, 1), (0, -1, 0), (1, 0, 0)),
    ((0, 0, -1), (0, -1, 0), (-1, 0, 0)),
)
"""The normal of each side of a box, and the directions from its center to the right and upper edges of the image."""


_MIN_AREA = 1e-15
"""The minimum area of a triangle in m2. Smaller triangles, at the poles, are omitted."""


def create_textured_mesh(shape: Shape) -> Triangles | None:
    """Return a shape as a mesh with texture coordinates.

    Returns None for an unsupported or empty shape.

    A plane has the size of its visual, and z as its normal.
    """
    match shape:
        case Box(size) if min(size) > 0:
            half_size = np.array(size) / 2
            return _join_meshes(
                [
                    _create_rectangle_mesh(np.array(side, dtype=np.float64) * half_size, _BOX_DIVISIONS)
                    for side in _SIDES
                ]
            )
        case Plane(_, (x, y)) if min(x, y) > 0:
            return _create_rectangle_mesh(
                np.array([[0.0, 0.0, 0.0], [x / 2, 0.0, 0.0], [0.0, y / 2, 0.0]]), _PLANE_DIVISIONS
            )
        case Cylinder(radius, length) if radius > 0 and length > 0:
            end = length / 2
            tube = _create_revolution_mesh([(radius, -end, 0.0), (radius, end, 1.0)])
            caps = (
                _create_revolution_mesh([(radius, end, 1.0), (0.0, end, 0.0)]),
                _create_revolution_mesh([(0.0, -end, 0.0), (radius, -end, 0.0)]),
            )
            return _join_meshes([tube, *caps])
        case Sphere(radius) if radius > 0:
            rows = [down / _RINGS for down in reversed(range(_RINGS + 1))]
            upright = _create_revolution_mesh(
                [(radius * sin(down * pi), radius * cos(down * pi), down) for down in rows]
            )
            faces = upright.indices.reshape(-1, 3)[:, ::-1]  # Exchanging two axes reverses the winding.
            return replace(upright, positions=upright.positions[:, [0, 2, 1]], indices=faces.ravel())
    return None


def _create_rectangle_mesh(side: Array, count: int) -> Triangles:
    """Return a rectangle as a mesh.

    Args:
        side: the position of the center, and the vectors from there to the right and upper edges, shape (3, 3).
        count: the number of squares into which the rectangle is divided in each direction.
    """
    fractions = np.linspace(0.0, 1.0, count + 1)
    down, right = (array.reshape(-1, 1) for array in np.meshgrid(fractions, fractions, indexing="ij"))
    center, to_right, upwards = side
    positions = center + (2 * right - 1) * to_right + (1 - 2 * down) * upwards
    return _create_grid_mesh(positions, np.hstack([right, down]), count)


def _create_revolution_mesh(rings: Sequence[tuple[float, float, float]]) -> Triangles:
    """Return a solid of revolution about z as a mesh.

    `rings` has the radius, height and texture row of each ring, from the top.
    """
    angles = np.linspace(0.0, 2 * pi, _SEGMENTS + 1)
    radius, height, row = (np.repeat(item, _SEGMENTS + 1) for item in np.array(rings).T)
    angle = np.tile(angles, len(rings))
    positions = np.stack([radius * np.sin(angle), radius * np.cos(angle), height], axis=1)
    return _create_grid_mesh(positions, np.stack([angle / (2 * pi), row], axis=1), _SEGMENTS)


def _create_grid_mesh(positions: Array, coordinates: Array, columns: int) -> Triangles:
    """Return the mesh of the triangles between rows of vertices, without degenerate triangles."""
    upper = np.arange(len(positions) - columns - 1).reshape(-1, columns + 1)[:, :-1].ravel()
    lower = upper + columns + 1
    faces = np.concatenate([np.stack([upper, lower, upper + 1], 1), np.stack([upper + 1, lower, lower + 1], 1)])
    first, second, third = (positions[faces[:, corner]] for corner in range(3))
    is_visible = np.linalg.norm(np.cross(second - first, third - first), axis=1) > _MIN_AREA
    return Triangles(positions, faces[is_visible].ravel(), None, coordinates)


def _join_meshes(meshes: Sequence[Triangles]) -> Triangles:
    counts = np.cumsum([0, *(len(part.positions) for part in meshes)])
    return Triangles(
        np.concatenate([part.positions for part in meshes]),
        np.concatenate([part.indices + count for part, count in zip(meshes, counts, strict=False)]),
        None,
        np.concatenate([part.coordinates for part in meshes if part.coordinates is not None]),
    )
