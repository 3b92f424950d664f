"""Convert SDF shapes to geoms of MuJoCo."""

from __future__ import annotations

from math import cos, pi, sin
from typing import Any

import numpy as np

from linkwright.geometry.shapes import Box, Capsule, Cylinder, Sphere
from linkwright.geometry.single import Transform, compose, rotation_from_z
from linkwright.sdf.shapes import Cone, Ellipsoid, Plane, Shape
from linkwright.simulation.library import load_mujoco

_INFINITE = 0.0
"""The half width of an infinite plane in MuJoCo."""
_HALF_THICKNESS = 0.005
"""Half the thickness in m of the box that replaces a plane on a movable body. MuJoCo's planes are static."""
_BASE_VERTICES = 32


def set_pose(element: Any, pose: Transform) -> None:
    """Set the pose of a body, geom, site or camera in the frame of its parent body."""
    x, y, z, qx, qy, qz, qw = pose
    element.pos = [x, y, z]
    element.quat = [qw, qx, qy, qz]


def add_shape(body: Any, shape: Shape, pose: Transform, *, fixed: bool) -> Any | None:
    """Add a simple shape to a body, and return the geom.

    Returns None if the shape is empty or is not a simple shape.

    Args:
        body: the body of the specification.
        shape: the shape; `linkwright.simulation.scene.meshes` adds other shapes, such as meshes and heightmaps.
        pose: the pose of the shape in the frame of the body.
        fixed: whether the body never moves; on a movable body, a plane becomes a thin box.
    """
    kinds = load_mujoco().mjtGeom
    match shape:
        case Box(size) if min(size) > 0:
            kind, sizes = kinds.mjGEOM_BOX, [value / 2 for value in size]
        case Sphere(radius) if radius > 0:
            kind, sizes = kinds.mjGEOM_SPHERE, [radius, 0, 0]
        case Cylinder(radius, length) if radius > 0 and length > 0:
            kind, sizes = kinds.mjGEOM_CYLINDER, [radius, length / 2, 0]
        case Capsule(radius, length) if radius > 0 and length > 0:
            kind, sizes = kinds.mjGEOM_CAPSULE, [radius, length / 2, 0]
        case Ellipsoid(radii) if min(radii) > 0:
            kind, sizes = kinds.mjGEOM_ELLIPSOID, list(radii)
        case Plane(normal, size):
            pose = compose(pose, (0.0, 0.0, 0.0, *rotation_from_z(normal)))
            if fixed:
                kind, sizes = kinds.mjGEOM_PLANE, [_INFINITE, _INFINITE, 1.0]
            else:
                kind, sizes = kinds.mjGEOM_BOX, [size[0] / 2, size[1] / 2, _HALF_THICKNESS]
        case _:
            return None
    geom = body.add_geom(type=kind, size=sizes)
    set_pose(geom, pose)
    return geom


def compute_cone_vertices(cone: Cone) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Return the vertices of a cone with a polygon as its base, in m, shape (n, 3)."""
    angles = [2 * pi * index / _BASE_VERTICES for index in range(_BASE_VERTICES)]
    ring = [(cone.radius * cos(angle), cone.radius * sin(angle), -cone.length / 2) for angle in angles]
    return np.array([*ring, (0.0, 0.0, cone.length / 2)])
