"""The bodies of a scene as one set of triangles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import Array
from linkwright.picture.bodies import Body, Color, Surface, Texture
from linkwright.picture.vectors import Indices

OPAQUE = 0.996
"""The minimum opacity of an opaque surface."""


@dataclass(frozen=True, eq=False, slots=True)
class Mesh:
    """All triangles of a scene.

    Attributes:
        points: the vertices in the scene in m, shape (n, 3).
        normals: the unit normals at the vertices, shape (n, 3).
        faces: the triangles as indices of vertices, shape (m, 3).
        parts: the surface of each triangle, as an index of `surfaces`, shape (m,).
        surfaces: the surfaces, in the scene.
        bodies: the body of each surface.
    """

    points: Array
    normals: Array
    faces: Indices
    parts: NDArray[np.int64]
    surfaces: tuple[Surface, ...]
    bodies: tuple[Body, ...]

    @classmethod
    def of(cls, bodies: Sequence[Body]) -> Mesh:
        """Combine the triangles of bodies."""
        surfaces, owners = [], []
        for body in bodies:
            for surface in body.surfaces:
                surfaces.append(surface.placed(body.frame))
                owners.append(body)
        if not surfaces:
            no_points = np.zeros((0, 3))
            no_indices = np.zeros((0, 3), np.int64)
            return cls(no_points, no_points, no_indices, np.zeros(0, np.int64), (), ())
        starts = np.cumsum([0, *(len(surface.points) for surface in surfaces)])
        return cls(
            np.concatenate([surface.points for surface in surfaces]),
            np.concatenate([surface.normals for surface in surfaces]),
            np.concatenate([surface.faces + start for surface, start in zip(surfaces, starts[:-1], strict=True)]),
            np.repeat(np.arange(len(surfaces)), [len(surface.faces) for surface in surfaces]),
            tuple(surfaces),
            tuple(owners),
        )

    def select(self, is_wanted: Sequence[bool]) -> Indices:
        """Return the indices of the triangles whose surfaces a mask selects."""
        return np.flatnonzero(np.array(is_wanted, dtype=bool)[self.parts]) if self.surfaces else np.zeros(0, np.int64)

    @property
    def opaque(self) -> Indices:
        """The indices of the opaque triangles without ghosts, shape (n,)."""
        return self.select([part.alpha >= OPAQUE and body.ghost is None for part, body in self._pairs])

    @property
    def transparent(self) -> Indices:
        """The indices of the triangles with transparent materials, without ghosts, shape (n,)."""
        return self.select([0.0 < part.alpha < OPAQUE and body.ghost is None for part, body in self._pairs])

    @property
    def ghosts(self) -> Indices:
        """The indices of the triangles of ghosts, shape (n,)."""
        return self.select([body.ghost is not None for body in self.bodies])

    @property
    def solid(self) -> Indices:
        """The indices of the triangles that cast a shadow, shape (n,)."""
        return self.select([part.alpha > 0.0 and body.ghost is None for part, body in self._pairs])

    def outlined_triangles(self) -> dict[Color, Indices]:
        """Return the indices of the triangles of outlined bodies, by the color of the outline."""
        colors = dict.fromkeys(body.outline for body in self.bodies if body.outline is not None)
        return {color: self.select([body.outline == color for body in self.bodies]) for color in colors}

    @property
    def colors(self) -> NDArray[np.float32]:
        """The color of each surface, as displayed, shape (surfaces, 3)."""
        pairs = self._pairs
        return np.array([body.ghost or part.color for part, body in pairs], np.float32).reshape(-1, 3)

    @property
    def alphas(self) -> NDArray[np.float32]:
        """The opacity of each surface."""
        return np.array([part.alpha for part in self.surfaces], np.float32)

    @property
    def textures(self) -> dict[int, Texture]:
        """The textures, by the indices of their surfaces."""
        pairs = enumerate(self._pairs)
        return {index: part.texture for index, (part, body) in pairs if part.texture is not None and body.ghost is None}

    @property
    def _pairs(self) -> list[tuple[Surface, Body]]:
        return list(zip(self.surfaces, self.bodies, strict=True))
