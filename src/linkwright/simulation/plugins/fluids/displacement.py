"""The volume of a link's collisions below a level surface.

A closed surface of triangles is cut at the plane, and the part below it is the sum of tetrahedra whose common apex is
in the plane. The cut face contains the apex, so its tetrahedra are empty, and the face need not be built. Source:
B. Mirtich, "Fast and accurate computation of polyhedral mass properties", 1996 (the divergence theorem).
"""

from __future__ import annotations

from dataclasses import dataclass
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
        heights = self.corners @ rotation[2] + (position[2] - height)
        corners = _cut_triangles(self.corners @ rotation.T + position, heights)
        apex = np.array((*position[:2], height))
        return _compute_volume(corners, apex)


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


def _cut_triangles(corners: Array, heights: Array) -> Array:
    """Return triangles cut off at a plane.

    Args:
        corners: the corners of the triangles, shape (n, 3, 3).
        heights: the signed distance of each corner above the plane, shape (n, 3).
    """
    counts = (heights < 0.0).sum(axis=1)
    has_one_below, has_two_below = counts == 1, counts == 2
    lone, second, third = _rotate_corners(
        corners[has_one_below], heights[has_one_below], np.argmin(heights[has_one_below], axis=1)
    )
    tips = np.stack([lone[0], _intersect_edges(lone, second), _intersect_edges(lone, third)], axis=1)
    lone, second, third = _rotate_corners(
        corners[has_two_below], heights[has_two_below], np.argmax(heights[has_two_below], axis=1)
    )
    left, right = _intersect_edges(lone, second), _intersect_edges(lone, third)
    halves = np.stack([left, second[0], third[0]], axis=1), np.stack([left, third[0], right], axis=1)
    return np.concatenate([corners[counts == 3], tips, *halves])


_Corner = tuple[Array, Array]
"""One corner of each triangle: positions of shape (n, 3), and heights of shape (n,)."""


def _rotate_corners(corners: Array, heights: Array, first_index: NDArray[np.intp]) -> tuple[_Corner, _Corner, _Corner]:
    """Return the corners of triangles, starting with a given corner.

    The direction of rotation does not change.
    """
    triangle_indices = np.arange(len(corners))
    first_corner, second_corner, third_corner = (
        (corners[triangle_indices, (first_index + offset) % 3], heights[triangle_indices, (first_index + offset) % 3])
        for offset in range(3)
    )
    return first_corner, second_corner, third_corner


def _intersect_edges(start: _Corner, end: _Corner) -> Array:
    """Return the points in which edges intersect the plane."""
    (start_position, start_height), (end_position, end_height) = start, end
    fraction = start_height / (start_height - end_height)
    points: Array = start_position + fraction[:, np.newaxis] * (end_position - start_position)
    return points


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
