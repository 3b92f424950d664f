"""The collision shapes of a robot's links, with each mesh replaced by convex parts that contain it."""

from __future__ import annotations

from itertools import chain

import numpy as np

from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.arrays import Array, row_from_pose
from linkwright.geometry.hull import convex_hull
from linkwright.geometry.shapes import Box, Capsule, Cylinder, Sphere
from linkwright.inertia.mesh_library import MeshLibrary
from linkwright.planning.robot_model import PlacedShape
from linkwright.simulation.scene.convex_parts import split_into_hulls
from linkwright.urdf import Collision, Mesh, Robot

_MIN_CORNERS = 4
_MIN_THICKNESS = 1e-6
"""The maximum thickness of a mesh without volume, as a fraction of its length."""


def robot_shapes(robot: Robot, meshes: MeshLibrary) -> tuple[dict[str, list[PlacedShape]], list[LinkwrightError]]:
    """Return the collision shapes of each link, and the errors of meshes that cannot be read.

    Shapes without volume are left out.
    """
    shapes: dict[str, list[PlacedShape]] = {}
    errors: list[LinkwrightError] = []
    for name, link in robot.links.items():
        converted = [_try_to_convert(collision, meshes, errors) for collision in link.collisions]
        if placed_shapes := list(chain.from_iterable(converted)):
            shapes[name] = placed_shapes
    return shapes, errors


def _try_to_convert(collision: Collision, meshes: MeshLibrary, errors: list[LinkwrightError]) -> list[PlacedShape]:
    try:
        return _convert_to_parts(collision, meshes)
    except LinkwrightError as error:
        errors.append(error)
        return []


def _convert_to_parts(collision: Collision, meshes: MeshLibrary) -> list[PlacedShape]:
    """Return the shapes of a collision: several for a mesh that fills only a part of its hull.

    Raises:
        LinkwrightError: the mesh cannot be read.
    """
    if isinstance(collision.geometry, Mesh):
        mesh, pose = meshes.load(collision.geometry, collision.element), row_from_pose(collision.origin)
        if parts := split_into_hulls(mesh.vertices, mesh.faces):
            center = np.concatenate(parts).mean(axis=0)
            return [PlacedShape(corners, pose, center) for corners in parts]
        corners = hull_corners(mesh.used_vertices)
        return [] if corners is None else [PlacedShape(corners, pose)]
    shape = convert_collision(collision, meshes)
    return [] if shape is None else [shape]


def convert_collision(collision: Collision, meshes: MeshLibrary) -> PlacedShape | None:
    """Return the shape of a collision, or None if it has no volume.

    The shape of a mesh has all its vertices, because MuJoCo computes their hull much faster than `hull_corners`.

    Raises:
        LinkwrightError: the mesh cannot be read.
    """
    shape, pose = collision.geometry, row_from_pose(collision.origin)
    if isinstance(shape, Mesh):
        mesh = meshes.load(shape, collision.element)
        points = mesh.used_vertices
        return PlacedShape(points, pose) if _has_volume(points) else None
    sizes: tuple[float, ...]
    if isinstance(shape, Box):
        sizes = shape.size
    elif isinstance(shape, Sphere):
        sizes = (shape.radius,)
    else:
        assert isinstance(shape, (Cylinder, Capsule))
        sizes = (shape.radius, shape.length)
    return PlacedShape(shape, pose) if min(sizes) > 0.0 else None


def hull_corners(points: Array) -> Array | None:
    """Return the corners of the convex hull of points, or None if it has no volume.

    Args:
        points: in m, shape (points, 3).
    """
    faces = convex_hull(points) if _has_volume(points) else None
    return None if faces is None else points[np.unique(faces)]


def _has_volume(points: Array) -> bool:
    if len(points) < _MIN_CORNERS:
        return False
    extents = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    return bool(extents[-1] > _MIN_THICKNESS * extents[0])


def scale_shape(placed_shape: PlacedShape, factor: float) -> PlacedShape:
    """Return a shape that is larger by a factor; a hull grows around its center."""
    shape, pose, center = placed_shape
    if isinstance(shape, np.ndarray):
        center = shape.mean(axis=0) if center is None else center
        return PlacedShape(center + factor * (shape - center), pose, center)
    if isinstance(shape, Box):
        x, y, z = shape.size
        return PlacedShape(Box((factor * x, factor * y, factor * z)), pose)
    if isinstance(shape, Sphere):
        return PlacedShape(Sphere(factor * shape.radius), pose)
    return PlacedShape(type(shape)(factor * shape.radius, factor * shape.length), pose)
