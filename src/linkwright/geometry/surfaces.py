"""The surfaces of primitive shapes, as triangles.

The coordinates have the same bits on every machine.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.geometry.exact_angles import regular_polygon
from linkwright.geometry.mesh_parts import Triangles

DEFAULT_SIDES = 32
"""The default number of sides of round shapes, a multiple of 4."""


def box(size: Sequence[float]) -> Triangles:
    """Return the triangles of a box that is centered at the origin."""
    positions, normals, coordinates = [], [], []
    for axis in range(3):
        for sign in (1.0, -1.0):
            u, v = np.eye(3)[(axis + 1) % 3], np.eye(3)[(axis + 2) % 3]
            normal = np.eye(3)[axis] * sign
            for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                positions.append(normal + (u * a * sign) + v * b)
                normals.append(normal)
                coordinates.append(((a + 1) / 2, (1 - b) / 2))
    quads = np.arange(6)[:, np.newaxis] * 4 + np.array([0, 1, 2, 0, 2, 3])
    scale = np.asarray(size, dtype=np.float64) / 2
    return Triangles(np.array(positions) * scale, quads.reshape(-1), np.array(normals), np.array(coordinates))


def cylinder(radius: float, length: float, sides: int = DEFAULT_SIDES) -> Triangles:
    """Return the triangles of a cylinder along z with caps, centered at the origin."""
    half_length = length / 2
    profile = [
        (0.0, half_length, 0, 1),
        (radius, half_length, 0, 1),
        (radius, half_length, 1, 0),
        (radius, -half_length, 1, 0),
    ]
    profile += [(radius, -half_length, 0, -1), (0.0, -half_length, 0, -1)]
    return _surface_of_revolution(np.array(profile, dtype=np.float64), sides)


def cone(radius: float, length: float, sides: int = DEFAULT_SIDES) -> Triangles:
    """Return the triangles of a cone along z with its tip at the top, centered at half its height."""
    half_length = length / 2
    profile = [(0.0, half_length, length, radius), (radius, -half_length, length, radius)]
    profile += [(radius, -half_length, 0.0, -1.0), (0.0, -half_length, 0.0, -1.0)]
    return _surface_of_revolution(np.array(profile, dtype=np.float64), sides)


def sphere(radius: float, sides: int = DEFAULT_SIDES) -> Triangles:
    """Return the triangles of a sphere that is centered at the origin."""
    r, z = _half_circle(sides)
    return _surface_of_revolution(np.stack([radius * r, radius * z, r, z], axis=1), sides)


def capsule(radius: float, length: float, sides: int = DEFAULT_SIDES) -> Triangles:
    """Return the triangles of a cylinder along z with hemispherical ends, centered at the origin."""
    r, z = (np.insert(values, sides // 4, values[sides // 4]) for values in _half_circle(sides))
    shift = np.where(np.arange(len(z)) <= sides // 4, length / 2, -length / 2)
    return _surface_of_revolution(np.stack([radius * r, radius * z + shift, r, z], axis=1), sides)


def _half_circle(sides: int) -> tuple[Array, Array]:
    """Return r and z of the corners of half a regular polygon with radius 1, from top to bottom."""
    points = regular_polygon(sides)
    quarter = [(abs(z), r) for r, z in points[: sides // 4 + 1]]
    lower = [(abs(z), r) for r, z in points[sides // 4 + 1 : sides // 2 + 1]]
    half = np.array([*quarter, *lower])
    return half[:, 0], half[:, 1]


def _surface_of_revolution(profile: Array, sides: int) -> Triangles:
    """Return the triangles of the surface that a profile generates when it rotates about z.

    The profile runs from top to bottom. Its columns are r and z of the points, and r and z of the normals.
    """
    cosines, sines = np.array(regular_polygon(sides)).T
    rows, columns = len(profile), sides + 1
    radius, height, normal_r, normal_z = (column[:, np.newaxis] for column in profile.T)
    unit_cosines = np.ones_like(cosines)
    positions = np.stack([radius * cosines, radius * sines, height * unit_cosines], axis=2).reshape(-1, 3)
    normals = np.stack([normal_r * cosines, normal_r * sines, normal_z * unit_cosines], axis=2).reshape(-1, 3)
    lengths = np.sqrt(normals[:, :1] ** 2 + normals[:, 1:2] ** 2 + normals[:, 2:] ** 2)
    u = np.broadcast_to(np.arange(columns) / sides, (rows, columns))
    v = np.broadcast_to(np.linspace(0.0, 1.0, rows)[:, np.newaxis], (rows, columns))
    row, column = np.meshgrid(np.arange(rows - 1), np.arange(sides), indexing="ij")
    upper_vertices = (row * columns + column).reshape(-1)
    lower_vertices = upper_vertices + columns
    triangles = np.stack(
        [upper_vertices, lower_vertices, lower_vertices + 1, upper_vertices, lower_vertices + 1, upper_vertices + 1],
        axis=1,
    )
    corners = positions[triangles.reshape(-1, 3)]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    valid_triangles = triangles.reshape(-1, 3)[areas > 1e-9 * max(areas.max(initial=0.0), 1e-300)]
    return Triangles(positions, valid_triangles.reshape(-1), normals / lengths, np.stack([u, v], axis=2).reshape(-1, 2))
