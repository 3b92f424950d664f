"""Draws collision objects as markers: primitives, meshes and planes."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import phrase
from linkwright.geometry.single import Transform, compose
from linkwright.page.protocol.markers import MarkerKind, MarkerShape
from linkwright.rviz.markers.shapes import make_marker, pose_to_values

Color = tuple[float, float, float, float]
"""Red, green, blue, alpha, from 0 to 1."""

MarkerGeometry = tuple[MarkerKind, Sequence[float], NDArray[np.float32]]
"""The kind, the scale and the points of a marker."""

_NO_POINTS = np.empty((0, 3), dtype=np.float32)

_PLANE_EDGE = 10.0
"""The edge length in meters of the square that represents an infinite plane."""

_CONE_CORNERS = 24
"""The number of corners of the circle of a cone."""


class BadObjectError(ValueError):
    """Raised when a collision object cannot be drawn.

    The message gives the reason.
    """


def make_object_markers(
    message: Any, namespace: str, color: Color, *, frame: str, base: Transform
) -> list[MarkerShape]:
    """Return the markers of a moveit_msgs/msg/CollisionObject.

    Args:
        message: the object. A pose that is not set is the identity.
        namespace: the markers' namespace.
        color: the color of all shapes.
        frame: the frame that the markers follow.
        base: the pose of the frame in the message's header, relative to `frame`.

    Raises:
        BadObjectError: a number is not finite, the numbers of shapes and poses differ, or a primitive is not valid.
    """
    object_pose = compose(base, _to_transform(message.pose))
    groups: tuple[tuple[str, Sequence[Any], Sequence[Any], Callable[[Any], MarkerGeometry]], ...] = (
        ("primitive", message.primitives, message.primitive_poses, _primitive),
        ("mesh", message.meshes, message.mesh_poses, _mesh),
        ("plane", message.planes, message.plane_poses, _plane),
    )
    shape_markers: list[MarkerShape] = []
    for kind_name, shapes, poses, make_form in groups:
        if len(poses) not in (0, len(shapes)):
            raise BadObjectError(
                phrase(
                    "The object has {shapes} shapes of kind {kind}, but {poses} poses",
                    shapes=len(shapes),
                    kind=kind_name,
                    poses=len(poses),
                )
            )
        for index, shape in enumerate(shapes):
            pose = compose(object_pose, _to_transform(poses[index])) if poses else object_pose
            kind, scale, points = make_form(shape)
            if not all(map(math.isfinite, (*pose, *scale))) or not np.isfinite(points).all():
                raise BadObjectError(phrase("Contains invalid floating point values (nans or infs)"))
            name = f"{message.id} {kind_name} {index}" if shape_markers else message.id
            shape_markers.append(make_marker(namespace, name, kind, pose, scale, color, frame=frame, points=points))
    return shape_markers


def _to_transform(message: Any) -> Transform:
    x, y, z, qx, qy, qz, qw = pose_to_values(message)
    return (x, y, z, qx, qy, qz, qw)


def _primitive(shape: Any) -> MarkerGeometry:
    make_form, count = _PRIMITIVES.get(shape.type, (None, 0))
    if make_form is None:
        raise BadObjectError(phrase("Primitives of type {type} are not supported", type=shape.type))
    sizes = [float(size) for size in shape.dimensions]
    if len(sizes) < count:
        raise BadObjectError(
            phrase(
                "A primitive of type {type} needs {count} dimensions, but has {sizes}",
                type=shape.type,
                count=count,
                sizes=len(sizes),
            )
        )
    if any(size < 0.0 for size in sizes):
        raise BadObjectError(phrase("A dimension is negative"))
    return make_form(shape, sizes)


def _box(_: Any, sizes: list[float]) -> MarkerGeometry:
    return "cube", sizes[:3], _NO_POINTS


def _sphere(_: Any, sizes: list[float]) -> MarkerGeometry:
    return "sphere", [2.0 * sizes[0]] * 3, _NO_POINTS


def _cylinder(_: Any, sizes: list[float]) -> MarkerGeometry:
    height, radius = sizes[:2]
    return "cylinder", [2.0 * radius, 2.0 * radius, height], _NO_POINTS


def _cone(_: Any, sizes: list[float]) -> MarkerGeometry:
    height, radius = sizes[:2]
    angles = np.linspace(0.0, 2.0 * math.pi, _CONE_CORNERS + 1)
    rim = np.stack(
        [radius * np.cos(angles), radius * np.sin(angles), np.full(_CONE_CORNERS + 1, -height / 2.0)], axis=-1
    )
    apex, center = (0.0, 0.0, height / 2.0), (0.0, 0.0, -height / 2.0)
    corners = [corner for a, b in pairwise(rim) for corner in (a, b, apex, b, a, center)]
    return "triangle_list", _UNIT_SCALE, _points(corners)


def _prism(shape: Any, sizes: list[float]) -> MarkerGeometry:
    """Return a polygon extruded to a height, with its plane halfway between both faces.

    The corners of the polygon must be in order.
    """
    outline = [(point.x, point.y) for point in shape.polygon.points]
    if len(outline) < 3:
        raise BadObjectError(phrase("The polygon of a prism has only {corners} corners", corners=len(outline)))
    half_height = sizes[0] / 2.0
    lower, upper = [(x, y, -half_height) for x, y in outline], [(x, y, half_height) for x, y in outline]
    corners = []
    for index in range(1, len(outline) - 1):
        corners += [upper[0], upper[index], upper[index + 1], lower[0], lower[index + 1], lower[index]]
    for index in range(len(outline)):
        next_index = (index + 1) % len(outline)
        corners += [lower[index], lower[next_index], upper[next_index], lower[index], upper[next_index], upper[index]]
    return "triangle_list", _UNIT_SCALE, _points(corners)


_UNIT_SCALE = (1.0, 1.0, 1.0)

_PRIMITIVES: dict[int, tuple[Callable[[Any, list[float]], MarkerGeometry], int]] = {
    1: (_box, 3),
    2: (_sphere, 1),
    3: (_cylinder, 2),
    4: (_cone, 2),
    5: (_prism, 1),
}
"""The function for each primitive and its number of dimensions, by the type in shape_msgs."""


def _mesh(mesh: Any) -> MarkerGeometry:
    if not mesh.triangles:
        raise BadObjectError(phrase("A mesh has no triangles"))
    vertex_indices = np.array([triangle.vertex_indices for triangle in mesh.triangles], dtype=np.int64).reshape(-1)
    vertices = np.array([(vertex.x, vertex.y, vertex.z) for vertex in mesh.vertices], dtype=np.float32).reshape(-1, 3)
    if vertex_indices.max() >= len(vertices):
        raise BadObjectError(
            phrase(
                "A triangle of a mesh refers to vertex {vertex}, but the mesh has only {vertices} vertices",
                vertex=vertex_indices.max(),
                vertices=len(vertices),
            )
        )
    return "triangle_list", _UNIT_SCALE, _points(vertices[vertex_indices])


def _plane(plane: Any) -> MarkerGeometry:
    """Return a square in the plane a x + b y + c z + d = 0.

    The square is centered on the point of the plane that is nearest to the origin.
    """
    normal, distance = np.array(plane.coef[:3], dtype=np.float64), float(plane.coef[3])
    length = float(np.linalg.norm(normal))
    if not math.isfinite(length) or length == 0.0:
        raise BadObjectError(phrase("The normal of a plane is zero or not finite"))
    center = normal * (-distance / length**2)
    normal /= length
    first_edge = np.cross(normal, np.eye(3)[int(np.argmin(np.abs(normal)))])
    first_edge *= _PLANE_EDGE / 2.0 / np.linalg.norm(first_edge)
    second_edge = np.cross(normal, first_edge)
    a, b, c, d = (center + p * first_edge + q * second_edge for p, q in ((-1, -1), (1, -1), (1, 1), (-1, 1)))
    return "triangle_list", _UNIT_SCALE, _points([a, b, c, a, c, d])


def _points(corners: Any) -> NDArray[np.float32]:
    return np.asarray(corners, dtype=np.float32).reshape(-1, 3)
