"""The volume of a link's collisions below a level surface.

A closed surface of triangles is cut at the plane, and the part below it is the sum of tetrahedra whose common apex is
in the plane. The cut face contains the apex, so its tetrahedra are empty, and the face need not be built. The tip of a
triangle that the plane cuts off is similar to a part of the triangle, so its tetrahedron is a share of the whole one.
Source: B. Mirtich, "Fast and accurate computation of polyhedral mass properties", 1996 (the divergence theorem).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry import surfaces
from linkwright.geometry.arrays import Array, rotation_matrix
from linkwright.geometry.mesh_parts import Triangles
from linkwright.geometry.shapes import Box, Capsule, Cylinder, Sphere
from linkwright.sdf.shapes import Ellipsoid, Shape
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.scene.bodies import COLLISION_GROUP
from linkwright.simulation.simulation import Simulation

_SIDE_COUNT = 16
"""The number of sides of round shapes, which determines the time of a step."""


@dataclass(frozen=True, slots=True)
class Volume:
    """A volume and its center.

    Attributes:
        size: the volume in m3.
        center: the centroid in m, shape (3,); undefined for an empty volume.
    """

    size: float
    center: Array


@dataclass(frozen=True, slots=True)
class Solid:
    """The solid that the collisions of a link fill.

    Where collisions overlap, the space counts once for each collision.

    Attributes:
        corners: the corners of the surface's triangles in the frame of the link, in m, shape (n, 3, 3);
            counterclockwise if seen from outside.
        total: the total volume, with its center in the frame of the link.
        radius: the distance of the farthest corner from the center, in m.
    """

    corners: Array
    total: Volume
    radius: float
    _products: Array = field(init=False, repr=False, compare=False)
    _areas: Array = field(init=False, repr=False, compare=False)
    _sums: Array = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        first, second, third = np.moveaxis(self.corners, 1, 0)
        areas = np.cross(first, second) + np.cross(second, third) + np.cross(third, first)
        object.__setattr__(self, "_areas", areas)  # twice the areas, as vectors
        object.__setattr__(self, "_products", (first * np.cross(second, third)).sum(axis=1))
        object.__setattr__(self, "_sums", self.corners.sum(axis=1))

    @classmethod
    def from_link(cls, simulation: Simulation, link: str) -> Solid | None:
        """Return the solid of a link's collisions, or None if they have no volume.

        Planes and heightmaps have no volume.

        Raises:
            KeyError: there is no such link.
        """
        model, body = simulation.model, simulation.model.body(simulation.body(link))
        geoms = range(body.geomadr[0], body.geomadr[0] + body.geomnum[0])
        parts = [_create_geom_triangles(model, geom) for geom in geoms if model.geom_group[geom] == COLLISION_GROUP]
        corners = np.concatenate([np.empty((0, 3, 3)), *(part for part in parts if part is not None)])
        return cls.from_triangles(corners)

    @classmethod
    def from_triangles(cls, corners: Array) -> Solid | None:
        """Return the solid that triangles enclose, of shape (n, 3, 3), or None if they have no volume."""
        whole = _compute_volume(corners, np.zeros(3))
        if whole.size == 0.0:
            return None
        return cls(corners, whole, float(np.linalg.norm(corners - whole.center, axis=2).max()))

    def volume_below(self, height: float, rotation: Array, position: Array) -> Volume:
        """Return the volume below a height, with its center in the world.

        Args:
            height: the z coordinate of the surface in the world, in m; infinity for the whole volume.
            rotation: the orientation of the link in the world, shape (3, 3).
            position: the position of the link in the world, in m, shape (3,).
        """
        center = rotation @ self.total.center + position
        if center[2] + self.radius <= height:
            return Volume(self.total.size, center)
        if center[2] - self.radius >= height:
            return Volume(0.0, center)
        normal, offset = rotation[2], position[2] - height  # of the surface, in the frame of the link
        heights = self.corners @ normal + offset
        apex = -offset * normal
        volumes = (self._products - self._areas @ apex) / 6.0
        counts = (heights < 0.0).sum(axis=1)
        is_included, is_cut = counts >= 2, (counts == 1) | (counts == 2)
        tips, tip_sums = self._cut_tips(heights, counts, is_cut, volumes)
        size = float(volumes[is_included].sum() + tips.sum())
        if size <= 0.0:
            return Volume(0.0, center)
        moment = volumes[is_included] @ self._sums[is_included] + tips @ tip_sums
        return Volume(size, rotation @ ((moment / size + apex) / 4.0) + position)

    def _cut_tips(
        self, heights: Array, counts: NDArray[np.int_], is_cut: NDArray[np.bool_], volumes: Array
    ) -> tuple[Array, Array]:
        """Return the volumes of the tetrahedra of tips, shape (m,), and the sums of the tips' corners, shape (m, 3).

        A tip has one corner of its triangle. Volumes of tips above the plane are negative, because the whole triangle
        is counted for them.
        """
        has_one_below = counts[is_cut] == 1
        corners, heights = self.corners[is_cut], heights[is_cut]
        rows = np.arange(len(corners))
        lone = np.where(has_one_below, heights.argmin(axis=1), heights.argmax(axis=1))
        second, third = (lone + 1) % 3, (lone + 2) % 3
        lone_heights, lone_corners = heights[rows, lone], corners[rows, lone]
        to_second = lone_heights / (lone_heights - heights[rows, second])
        to_third = lone_heights / (lone_heights - heights[rows, third])
        tips = volumes[is_cut] * to_second * to_third
        sums: Array = (
            3.0 * lone_corners
            + to_second[:, np.newaxis] * (corners[rows, second] - lone_corners)
            + to_third[:, np.newaxis] * (corners[rows, third] - lone_corners)
        )
        return np.where(has_one_below, tips, -tips), sums


def _create_geom_triangles(model: Any, geom: int) -> Array | None:
    """Return the triangles of a geom in the frame of its body; None for a geom without volume."""
    kinds, kind = load_mujoco().mjtGeom, int(model.geom_type[geom])
    radius, half_length, _ = x, y, z = model.geom_size[geom].astype(float).tolist()
    corners: Array | None
    if kind == kinds.mjGEOM_MESH:
        corners = _read_mesh_triangles(model, int(model.geom_dataid[geom]))
    elif kind == kinds.mjGEOM_BOX:
        corners = create_shape_triangles(Box((2 * x, 2 * y, 2 * z)))
    elif kind == kinds.mjGEOM_SPHERE:
        corners = create_shape_triangles(Sphere(radius))
    elif kind == kinds.mjGEOM_ELLIPSOID:
        corners = create_shape_triangles(Ellipsoid((x, y, z)))
    elif kind == kinds.mjGEOM_CYLINDER:
        corners = create_shape_triangles(Cylinder(radius, 2 * half_length))
    elif kind == kinds.mjGEOM_CAPSULE:
        corners = create_shape_triangles(Capsule(radius, 2 * half_length))
    else:
        return None
    if corners is None:
        return None
    qw, qx, qy, qz = model.geom_quat[geom].tolist()
    moved: Array = corners @ rotation_matrix((qx, qy, qz, qw)).T + model.geom_pos[geom]
    return moved


def create_shape_triangles(shape: Shape) -> Array | None:
    """Return the triangles of a primitive shape in its frame, shape (n, 3, 3); None for any other shape.

    The triangles of round shapes enclose the volume of the exact shape.
    """
    if isinstance(shape, Box):
        return _to_corner_array(surfaces.box(shape.size))
    if isinstance(shape, Sphere):
        return _create_unit_ball() * shape.radius
    if isinstance(shape, Ellipsoid):
        return _create_unit_ball() * shape.radii
    if isinstance(shape, Cylinder):
        corners = _to_corner_array(surfaces.cylinder(shape.radius, shape.length, _SIDE_COUNT))
        exact_volume = pi * shape.radius**2 * shape.length
        widening = np.sqrt(exact_volume / _compute_volume(corners, np.zeros(3)).size)
        return corners * (widening, widening, 1.0)
    if isinstance(shape, Capsule):
        corners = _to_corner_array(surfaces.capsule(shape.radius, shape.length, _SIDE_COUNT))
        exact_volume = pi * shape.radius**2 * (shape.length + 4 / 3 * shape.radius)
        enlarged: Array = corners * np.cbrt(exact_volume / _compute_volume(corners, np.zeros(3)).size)
        return enlarged
    return None


def _to_corner_array(triangles: Triangles) -> Array:
    corners: Array = triangles.positions[triangles.indices].reshape(-1, 3, 3)
    return corners


def _create_unit_ball() -> Array:
    """Return triangles that enclose the volume of a sphere with the radius 1."""
    corners = _to_corner_array(surfaces.sphere(1.0, _SIDE_COUNT))
    enlarged: Array = corners * np.cbrt(4 / 3 * pi / _compute_volume(corners, np.zeros(3)).size)
    return enlarged


def _read_mesh_triangles(model: Any, mesh: int) -> Array:
    """Return the triangles of a mesh, turned so that its volume is positive."""
    first_vertex, first_face = int(model.mesh_vertadr[mesh]), int(model.mesh_faceadr[mesh])
    vertices = model.mesh_vert[first_vertex : first_vertex + int(model.mesh_vertnum[mesh])]
    faces = model.mesh_face[first_face : first_face + int(model.mesh_facenum[mesh])]
    corners: Array = vertices[faces].astype(float)
    is_inside_out = _compute_signed_volumes(corners, np.zeros(3)).sum() < 0.0
    return corners[:, ::-1] if is_inside_out else corners


def _compute_signed_volumes(corners: Array, apex: Array) -> Array:
    """Return the signed volumes in m3 of the tetrahedra between triangles and an apex.

    They are negative on the inner side of the triangles.
    """
    (ax, bx, cx), (ay, by, cy), (az, bz, cz) = np.moveaxis(corners - apex, (2, 1), (0, 1))
    volumes: Array = (ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)) / 6.0
    return volumes


def _compute_volume(corners: Array, apex: Array) -> Volume:
    volumes = _compute_signed_volumes(corners, apex)
    size = float(volumes.sum())
    if size <= 0.0:
        return Volume(0.0, np.zeros(3))
    centers = (corners.sum(axis=1) + apex) / 4.0
    return Volume(size, volumes @ centers / size)
