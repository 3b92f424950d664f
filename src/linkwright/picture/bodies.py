"""The contents of a scene: bodies, and their surfaces with materials."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import Array, transform_points
from linkwright.geometry.mesh_parts import Triangles
from linkwright.geometry.shapes import IDENTITY, MAX_COORDINATE, Placement
from linkwright.geometry.single import Vector3
from linkwright.picture.smoothing import smooth_mesh
from linkwright.picture.vectors import Indices, unit_vectors

Color: TypeAlias = tuple[float, float, float]
"""Red, green and blue as displayed, each from 0 to 1."""
Texture: TypeAlias = NDArray[np.uint8]
"""Pixels of shape (height, width, 3), with the top row first."""


_POSITION_GRID = float(1 << 30)
"""Positions in mesh files are rounded to about 1 nm, because the last bits of rotations differ between machines.
bits."""


@dataclass(frozen=True, eq=False, slots=True)
class Surface:
    """Triangles with one material.

    Attributes:
        points: the vertices in m, shape (n, 3).
        normals: the unit normals at the vertices, shape (n, 3).
        faces: the triangles as indices of vertices, shape (m, 3).
        color: the color, which multiplies the texture and the colors of vertices.
        alpha: the opacity, 0 to 1.
        vertex_colors: a color for each vertex, shape (n, 3), or None.
        texture: the texture, or None.
        coordinates: the texture coordinates of each vertex from the upper left corner, shape (n, 2), or None.
    """

    points: Array
    normals: Array
    faces: Indices
    color: Color = (1.0, 1.0, 1.0)
    alpha: float = 1.0
    vertex_colors: Array | None = None
    texture: Texture | None = None
    coordinates: Array | None = None

    @classmethod
    def of_triangles(cls, triangles: Triangles, texture: Texture | None = None) -> Surface:
        """Return triangles as a white surface, smooth except at creases.

        Normals in the file are ignored.
        """
        faces = triangles.indices.reshape(-1, 3)
        if not len(faces) or not (np.abs(triangles.positions) <= MAX_COORDINATE).all():
            return cls(triangles.positions, np.zeros_like(triangles.positions), faces)
        colors, coordinates = triangles.colors, triangles.coordinates
        has_texture = texture is not None and coordinates is not None
        positions = np.rint(triangles.positions * _POSITION_GRID) / _POSITION_GRID
        mesh = smooth_mesh(positions, faces, merged=colors is None and not has_texture)
        return cls(
            positions[mesh.sources],
            mesh.normals,
            mesh.faces,
            vertex_colors=None if colors is None else colors[mesh.sources, :3],
            texture=texture if has_texture else None,
            coordinates=coordinates[mesh.sources] if has_texture and coordinates is not None else None,
        )

    def colored(self, color: Color, alpha: float) -> Surface:
        """Return a copy of the surface with another color and opacity."""
        return replace(self, color=color, alpha=alpha)

    def scaled(self, scale: Vector3) -> Surface:
        """Return a copy of the surface, scaled along its axes.

        A negative factor mirrors the surface.
        """
        if scale == (1.0, 1.0, 1.0):
            return self
        factors = np.array(scale)
        inverse = np.array([1.0 / factor if factor else 0.0 for factor in scale])
        is_mirrored = scale[0] * scale[1] * scale[2] < 0
        with np.errstate(over="ignore", invalid="ignore"):  # `is_in_range` detects numbers that are too large.
            points, normals = self.points * factors, unit_vectors(self.normals * inverse)
        return replace(
            self,
            points=points,
            normals=normals,
            faces=self.faces[:, ::-1] if is_mirrored else self.faces,
        )

    def placed(self, frame: Placement) -> Surface:
        """Return a copy of the surface in the parent of its frame."""
        if frame.rotation == IDENTITY and frame.position == (0.0, 0.0, 0.0):
            return self
        matrix = np.eye(4)
        matrix[:3, :3] = frame.rotation
        turn = matrix.copy()
        matrix[:3, 3] = frame.position
        with np.errstate(over="ignore", invalid="ignore"):
            points, normals = transform_points(matrix, self.points), transform_points(turn, self.normals)
        return replace(self, points=points, normals=normals)

    @property
    def is_in_range(self) -> bool:
        """Whether all coordinates are numbers of a reasonable size."""
        return bool((np.abs(self.points) <= MAX_COORDINATE).all())


@dataclass(frozen=True, eq=False, slots=True)
class Body:
    """A link of a robot or world.

    Attributes:
        name: the name of the link.
        frame: the frame of the link in the scene.
        surfaces: what is drawn, in the link's frame.
        ghost: the color in which the body is drawn as transparent, without a shadow; None for its own colors.
        outline: the color of a line around the body, which is seen through other bodies; None for none.
        is_ground: whether the body is a floor or ground, which images need not show as a whole.
    """

    name: str
    frame: Placement
    surfaces: tuple[Surface, ...] = ()
    ghost: Color | None = None
    outline: Color | None = None
    is_ground: bool = False


@dataclass(frozen=True, slots=True)
class Axes:
    """The axes of a frame, which are drawn over all bodies.

    Attributes:
        frame: the frame in the scene.
        length: the length of each axis in m.
    """

    frame: Placement
    length: float


@dataclass(frozen=True, slots=True)
class Anchor:
    """A point of a scene that can be labeled.

    Attributes:
        text: the label.
        position: the point in m.
    """

    text: str
    position: Vector3


@dataclass(frozen=True, eq=False, slots=True)
class Labels:
    """The points that can be labeled: the origins of links and of joints."""

    links: tuple[Anchor, ...] = ()
    joints: tuple[Anchor, ...] = ()
