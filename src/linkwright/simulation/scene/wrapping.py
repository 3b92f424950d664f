"""Simple shapes as triangle meshes with texture coordinates.

Source: gz-common's ``MeshManager``. A box shows the image on each side, upright on the lateral sides. On cylinders and
spheres the image runs clockwise as seen from the end. It is upside down on a cylinder, and the poles of a sphere are
along y.
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

_SIDE, _FLOOR = 4, 16
"""Into how many squares a side of a box and a plane are cut each way: light is computed at corners."""
_AROUND, _DOWN = 64, 32
"""The numbers of parts of a round shape, round its axis and along it."""
_SIDES = (
    ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    ((-1, 0, 0), (0, -1, 0), (0, 0, 1)),
    ((0, 1, 0), (-1, 0, 0), (0, 0, 1)),
    ((0, -1, 0), (1, 0, 0), (0, 0, 1)),
    ((0, 0, 1), (0, -1, 0), (1, 0, 0)),
    ((0, 0, -1), (0, -1, 0), (-1, 0, 0)),
)
"""For each side of a box its normal, and the directions of the right and the upper edge of its image."""


_LEAST_AREA = 1e-15
"""The least area in m2: triangles at poles without area are left out."""


def textured_mesh(shape: Shape) -> Triangles | None:
    """Return a shape as a mesh with texture coordinates, or None for an unsupported or empty shape.

    A plane has the size of its visual, and z as its normal.
    """
    match shape:
        case Box(size) if min(size) > 0:
            half = np.array(size) / 2
            return _joined([_rectangle_mesh(np.array(side, dtype=np.float64) * half, _SIDE) for side in _SIDES])
        case Plane(_, (x, y)) if min(x, y) > 0:
            return _rectangle_mesh(np.array([[0.0, 0.0, 0.0], [x / 2, 0.0, 0.0], [0.0, y / 2, 0.0]]), _FLOOR)
        case Cylinder(radius, length) if radius > 0 and length > 0:
            end = length / 2
            tube = _revolution_mesh([(radius, -end, 0.0), (radius, end, 1.0)])
            caps = (
                _revolution_mesh([(radius, end, 1.0), (0.0, end, 0.0)]),
                _revolution_mesh([(0.0, -end, 0.0), (radius, -end, 0.0)]),
            )
            return _joined([tube, *caps])
        case Sphere(radius) if radius > 0:
            downs = [down / _DOWN for down in reversed(range(_DOWN + 1))]
            upright = _revolution_mesh([(radius * sin(down * pi), radius * cos(down * pi), down) for down in downs])
            faces = upright.indices.reshape(-1, 3)[:, ::-1]  # Exchanging two axes reverses the winding.
            return replace(upright, positions=upright.positions[:, [0, 2, 1]], indices=faces.ravel())
    return None


def _rectangle_mesh(side: Array, count: int) -> Triangles:
    """Return a rectangle as a mesh.

    Args:
        side: the position of the centre, and the vectors from there to the right and upper edges, shape (3, 3).
        count: the number of squares into which the rectangle is divided in each direction.
    """
    share = np.linspace(0.0, 1.0, count + 1)
    down, right = (array.reshape(-1, 1) for array in np.meshgrid(share, share, indexing="ij"))
    middle, to_right, upwards = side
    positions = middle + (2 * right - 1) * to_right + (1 - 2 * down) * upwards
    return _grid_mesh(positions, np.hstack([right, down]), count)


def _revolution_mesh(rings: Sequence[tuple[float, float, float]]) -> Triangles:
    """Return a solid of revolution about z as a mesh.

    `rings` has the radius, height and texture row of each ring, from the top.
    """
    turns = np.linspace(0.0, 2 * pi, _AROUND + 1)
    radius, height, down = (np.repeat(item, _AROUND + 1) for item in np.array(rings).T)
    turn = np.tile(turns, len(rings))
    positions = np.stack([radius * np.sin(turn), radius * np.cos(turn), height], axis=1)
    return _grid_mesh(positions, np.stack([turn / (2 * pi), down], axis=1), _AROUND)


def _grid_mesh(positions: Array, coordinates: Array, columns: int) -> Triangles:
    """Return the mesh of the triangles between rows of vertices, without degenerate triangles."""
    start = np.arange(len(positions) - columns - 1).reshape(-1, columns + 1)[:, :-1].ravel()
    below = start + columns + 1
    faces = np.concatenate([np.stack([start, below, start + 1], 1), np.stack([start + 1, below, below + 1], 1)])
    one, two, three = (positions[faces[:, corner]] for corner in range(3))
    seen = np.linalg.norm(np.cross(two - one, three - one), axis=1) > _LEAST_AREA
    return Triangles(positions, faces[seen].ravel(), None, coordinates)


def _joined(parts: Sequence[Triangles]) -> Triangles:
    counts = np.cumsum([0, *(len(part.positions) for part in parts)])
    return Triangles(
        np.concatenate([part.positions for part in parts]),
        np.concatenate([part.indices + count for part, count in zip(parts, counts, strict=False)]),
        None,
        np.concatenate([part.coordinates for part in parts if part.coordinates is not None]),
    )
