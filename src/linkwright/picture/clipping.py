"""Project triangles into an image, without those that reach behind the camera."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import Array
from linkwright.picture.camera import Camera
from linkwright.picture.vectors import Indices

_MAX_NEARNESS = 20.0
"""The nearness, 1 at the middle of the image, above which a point is too close to the camera."""


@dataclass(frozen=True, eq=False, slots=True)
class ProjectedMesh:
    """Vertices in an image.

    Attributes:
        x: the positions in pixels from the left, shape (n,).
        y: the positions in pixels from the top, shape (n,).
        nearness: the nearness (see `Camera.project`), shape (n,).
        is_clipped: whether a corner of each triangle is behind or too close to the camera, shape (m,).
    """

    x: Array
    y: Array
    nearness: Array
    is_clipped: NDArray[np.bool_]

    def select(self, triangles: Indices) -> Indices:
        """Return the indices of triangles in front of the camera."""
        return triangles[~self.is_clipped[triangles]] if self.is_clipped.any() else triangles


def project_mesh(camera: Camera, points: Array, faces: Indices) -> ProjectedMesh:
    """Return the vertices of triangles in an image.

    A vertex of a clipped triangle can have any position.

    Args:
        camera: the camera of the image.
        points: the vertices in m, shape (n, 3).
        faces: the triangles as indices of vertices, shape (m, 3).
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        x, y, nearness = camera.project(points)
    if not camera.distance:
        return ProjectedMesh(x, y, nearness, np.zeros(len(faces), dtype=bool))
    is_behind = ~((nearness > 0.0) & (nearness <= _MAX_NEARNESS))
    if not is_behind.any():
        return ProjectedMesh(x, y, nearness, np.zeros(len(faces), dtype=bool))
    x, y, nearness = (np.where(is_behind, other, values) for values, other in ((x, 0.0), (y, 0.0), (nearness, 1.0)))
    is_clipped: NDArray[np.bool_] = np.any(is_behind[faces], axis=1)
    return ProjectedMesh(x, y, nearness, is_clipped)
