"""Triangulates the shapes of URDF."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.geometry.mesh_parts import Triangles

_SIDES = 32
_RINGS = 16


def box(size: Sequence[float]) -> Triangles:
    """Return the triangles of a box that is centred at the origin."""
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


def cylinder(radius: float, length: float) -> Triangles:
    """Return the triangles of a cylinder along z with caps, centred at the origin."""
    half_length = length / 2
    profile = [
        (0.0, half_length, 0, 1),
        (radius, half_length, 0, 1),
        (radius, half_length, 1, 0),
        (radius, -half_length, 1, 0),
    ]
    profile += [(radius, -half_length, 0, -1), (0.0, -half_length, 0, -1)]
    return _surface_of_revolution(np.array(profile, dtype=np.float64))


def sphere(radius: float) -> Triangles:
    """Return the triangles of a sphere that is centred at the origin."""
    angles = np.linspace(np.pi / 2, -np.pi / 2, _RINGS + 1)
    cosines, sines = np.cos(angles), np.sin(angles)
    return _surface_of_revolution(np.stack([radius * cosines, radius * sines, cosines, sines], axis=1))


def capsule(radius: float, length: float) -> Triangles:
    """Return the triangles of a cylinder along z with hemispherical ends, centred at the origin."""
    angles = np.linspace(np.pi / 2, -np.pi / 2, _RINGS + 1)
    angles = np.insert(angles, _RINGS // 2, 0.0)
    shift = np.where(np.arange(_RINGS + 2) <= _RINGS // 2, length / 2, -length / 2)
    cosines, sines = np.cos(angles), np.sin(angles)
    return _surface_of_revolution(np.stack([radius * cosines, radius * sines + shift, cosines, sines], axis=1))


def _surface_of_revolution(profile: Array) -> Triangles:
    """Return the triangles of the surface that a profile generates when it rotates about z.

    The profile runs from top to bottom. Its columns are r and z of the points, and r and z of the normals.
    """
    angles = np.linspace(0.0, 2 * np.pi, _SIDES + 1)
    cosines, sines = np.cos(angles), np.sin(angles)
    rows, columns = len(profile), _SIDES + 1
    radius, height, normal_r, normal_z = (column[:, np.newaxis] for column in profile.T)
    ones = np.ones_like(cosines)
    positions = np.stack([radius * cosines, radius * sines, height * ones], axis=2).reshape(-1, 3)
    normals = np.stack([normal_r * cosines, normal_r * sines, normal_z * ones], axis=2).reshape(-1, 3)
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    u = np.broadcast_to(angles / (2 * np.pi), (rows, columns))
    v = np.broadcast_to(np.linspace(0.0, 1.0, rows)[:, np.newaxis], (rows, columns))
    row, column = np.meshgrid(np.arange(rows - 1), np.arange(_SIDES), indexing="ij")
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
