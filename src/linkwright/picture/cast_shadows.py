"""Shadows that bodies cast on other bodies."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import Array
from linkwright.geometry.single import Vector3, cross
from linkwright.picture.rasterizer import DepthBuffer, ScreenTriangles
from linkwright.picture.scene_mesh import Mesh
from linkwright.picture.vectors import Floats, along, unit_vector

_CELLS_PER_SIDE = 720
"""The number of cells along the longer side of the shadow map."""
_BLUR_REACH_CELLS = 2
"""The radius in cells of the blur at the borders of shadows."""
_OFFSET_CELLS = 2.0
"""The distance in cells by which a tested point is moved off its surface, so that no surface shades itself."""
_STRENGTH = 0.42
"""The fraction of the light that a shadow removes."""


class CastShadows:
    """The shadows of the bodies of a scene.

    Args:
        mesh: the triangles of the scene, of which one at least casts a shadow.
        key: the direction to the light.
    """

    def __init__(self, mesh: Mesh, key: Vector3) -> None:
        self._toward = key
        self._right = unit_vector(cross((0.0, 0.0, 1.0), key)) if abs(key[2]) < 0.999 else (1.0, 0.0, 0.0)
        self._up = cross(key, self._right)
        solid = mesh.solid
        is_used = np.zeros(len(mesh.points), dtype=bool)
        is_used[mesh.faces[solid].reshape(-1)] = True
        x, y, z = self._find_components(mesh.points)
        self._origin = float(x[is_used].min()), float(y[is_used].min())
        extents = float(x[is_used].max()) - self._origin[0], float(y[is_used].max()) - self._origin[1]
        self._cell = max(*extents, 1e-9) / (_CELLS_PER_SIDE - 2)
        self._columns, rows = (int(extent / self._cell) + 2 for extent in extents)
        self._high = float(z[is_used].max())
        self._depth = max(self._high - float(z[is_used].min()), 1e-9)
        cells = ((x - self._origin[0]) / self._cell, (y - self._origin[1]) / self._cell)
        buffer = DepthBuffer(self._columns, 0, rows, self._high, self._high - self._depth)
        buffer.add(ScreenTriangles.from_faces(*cells, z, mesh.faces), solid)
        self._distances = np.full((rows, self._columns), 2.0, np.float32)
        visible = buffer.visible_triangles(1)
        if visible is not None:
            self._distances[visible.window][visible.mask] = visible.distances

    def compute_light(self, points: Array, normals: Floats) -> Floats:
        """Return the fraction of the light that reaches points of surfaces, from 0 to 1.

        Args:
            points: the points in m, shape (n, 3).
            normals: the unit normals of the surfaces, shape (n, 3).
        """
        facing = np.clip(along(normals, self._toward) * 3.0, 0.0, 1.0)
        moved = points + normals * (self._cell * _OFFSET_CELLS)
        x, y, z = self._find_components(moved)
        distance = ((self._high - z) / self._depth).astype(np.float32)
        tolerance = np.float32(_OFFSET_CELLS * self._cell / self._depth)
        column = np.floor((x - self._origin[0]) / self._cell).astype(np.int64)
        row = np.floor((y - self._origin[1]) / self._cell).astype(np.int64)
        blocked = np.zeros(len(points), np.float32)
        count = 0
        for down in range(-_BLUR_REACH_CELLS, _BLUR_REACH_CELLS + 1):
            for across in range(-_BLUR_REACH_CELLS, _BLUR_REACH_CELLS + 1):
                if down * down + across * across <= _BLUR_REACH_CELLS * _BLUR_REACH_CELLS + 1:
                    blocked += self._get_buffer_values(row + down, column + across) + tolerance < distance
                    count += 1
        shadow = blocked * (1.0 / count) * facing
        light: Floats = (1.0 - shadow * _STRENGTH).astype(np.float32)
        return light

    def _get_buffer_values(self, rows: NDArray[np.int64], columns: NDArray[np.int64]) -> Floats:
        height, width = self._distances.shape
        return self._distances[np.clip(rows, 0, height - 1), np.clip(columns, 0, width - 1)]

    def _find_components(self, points: Array) -> tuple[Array, Array, Array]:
        return along(points, self._right), along(points, self._up), along(points, self._toward)
