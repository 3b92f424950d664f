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
from linkwright.rviz.markers.shapes import make_marker, pose_of

Color = tuple[float, float, float, float]
"""Red, green, blue, alpha, from 0 to 1."""

Form = tuple[MarkerKind, Sequence[float], NDArray[np.float32]]
"""Kind, scale and points of a marker."""

_NO_POINTS = np.empty((0, 3), dtype=np.float32)

_PLANE_EDGE = 10.0
"""Edge of the square that represents a plane, which is infinite, in metres."""

_ROUND = 24
"""Corners of the circle of a cone."""


class BadObjectError(ValueError):
    """Raised when a collision object cannot be drawn; the message gives the reason."""


def object_markers(message: Any, namespace: str, color: Color, *, frame: str, base: Transform) -> list[MarkerShape]:
    """Return the markers of a moveit_msgs/msg/CollisionObject.

    Args:
        message: the object. A pose that is not set is the identity.
        namespace: the markers' namespace.
        color: the colour of all shapes.
        frame: the frame that the markers follow.
        base: the pose, in `frame`, of the frame in the message's header.

    Raises:
        BadObjectError: a number is not finite, the numbers of shapes and poses differ, or a primitive is not valid.
    """
    in_frame = compose(base, _pose(message.pose))
    groups: tuple[tuple[str, Sequence[Any], Sequence[Any], Callable[[Any], Form]], ...] = (
        ("primitive", message.primitives, message.primitive_poses, _primitive),
        ("mesh", message.meshes, message.mesh_poses, _mesh),
        ("plane", message.planes, message.plane_poses, _plane),
    )
    made: list[MarkerShape] = []
    for what, shapes, poses, form_of in groups:
        if len(poses) not in (0, len(shapes)):
            raise BadObjectError(
                phrase(
                    "{shapes} shapes of kind {what} have {poses} poses",
                    shapes=len(shapes),
                    what=what,
                    poses=len(poses),
                )
            )
        for number, shape in enumerate(shapes):
            pose = compose(in_frame, _pose(poses[number])) if poses else in_frame
            kind, scale, points = form_of(shape)
            if not all(map(math.isfinite, (*pose, *scale))) or not np.isfinite(points).all():
                raise BadObjectError(phrase("Contains invalid floating point values (nans or infs)"))
            name = f"{message.id} {what} {number}" if made else message.id
            made.append(make_marker(namespace, name, kind, pose, scale, color, frame=frame, points=points))
    return made


def _pose(message: Any) -> Transform:
    x, y, z, qx, qy, qz, qw = pose_of(message)
    return (x, y, z, qx, qy, qz, qw)


def _primitive(shape: Any) -> Form:
    make, count = _PRIMITIVES.get(shape.type, (None, 0))
    if make is None:
        raise BadObjectError(phrase("Unknown type of primitive: {type}", type=shape.type))
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
    return make(shape, sizes)


def _box(_: Any, sizes: list[float]) -> Form:
    return "cube", sizes[:3], _NO_POINTS


def _sphere(_: Any, sizes: list[float]) -> Form:
    return "sphere", [2.0 * sizes[0]] * 3, _NO_POINTS


def _cylinder(_: Any, sizes: list[float]) -> Form:
    height, radius = sizes[:2]
    return "cylinder", [2.0 * radius, 2.0 * radius, height], _NO_POINTS


def _cone(_: Any, sizes: list[float]) -> Form:
    height, radius = sizes[:2]
    angles = np.linspace(0.0, 2.0 * math.pi, _ROUND + 1)
    rim = np.stack([radius * np.cos(angles), radius * np.sin(angles), np.full(_ROUND + 1, -height / 2.0)], axis=-1)
    tip, middle = (0.0, 0.0, height / 2.0), (0.0, 0.0, -height / 2.0)
    corners = [corner for a, b in pairwise(rim) for corner in (a, b, tip, b, a, middle)]
    return "triangle_list", _ONE, _points(corners)


def _prism(shape: Any, sizes: list[float]) -> Form:
    """Return a polygon extruded to a height; the polygon's plane is halfway between both faces.

    The corners of the polygon are in order.
    """
    flat = [(point.x, point.y) for point in shape.polygon.points]
    if len(flat) < 3:
        raise BadObjectError(phrase("The polygon of a prism has {corners} corners", corners=len(flat)))
    half = sizes[0] / 2.0
    lower, upper = [(x, y, -half) for x, y in flat], [(x, y, half) for x, y in flat]
    corners = []
    for place in range(1, len(flat) - 1):
        corners += [upper[0], upper[place], upper[place + 1], lower[0], lower[place + 1], lower[place]]
    for place in range(len(flat)):
        after = (place + 1) % len(flat)
        corners += [lower[place], lower[after], upper[after], lower[place], upper[after], upper[place]]
    return "triangle_list", _ONE, _points(corners)


_ONE = (1.0, 1.0, 1.0)

_PRIMITIVES: dict[int, tuple[Callable[[Any, list[float]], Form], int]] = {
    1: (_box, 3),
    2: (_sphere, 1),
    3: (_cylinder, 2),
    4: (_cone, 2),
    5: (_prism, 1),
}
"""By shape_msgs' numbers, with the number of dimensions of each."""


def _mesh(mesh: Any) -> Form:
    if not mesh.triangles:
        raise BadObjectError(phrase("A mesh has no triangles"))
    places = np.array([triangle.vertex_indices for triangle in mesh.triangles], dtype=np.int64).reshape(-1)
    vertices = np.array([(vertex.x, vertex.y, vertex.z) for vertex in mesh.vertices], dtype=np.float32).reshape(-1, 3)
    if places.max() >= len(vertices):
        raise BadObjectError(
            phrase(
                "A triangle of a mesh refers to vertex {vertex}, but there are {vertices}",
                vertex=places.max(),
                vertices=len(vertices),
            )
        )
    return "triangle_list", _ONE, _points(vertices[places])


def _plane(plane: Any) -> Form:
    """Return a square in the plane a x + b y + c z + d = 0.

    The square is centred on the point of the plane that is nearest to the origin.
    """
    normal, distance = np.array(plane.coef[:3], dtype=np.float64), float(plane.coef[3])
    length = float(np.linalg.norm(normal))
    if not math.isfinite(length) or length == 0.0:
        raise BadObjectError(phrase("A plane has no normal"))
    middle = normal * (-distance / length**2)
    normal /= length
    along = np.cross(normal, np.eye(3)[int(np.argmin(np.abs(normal)))])
    along *= _PLANE_EDGE / 2.0 / np.linalg.norm(along)
    across = np.cross(normal, along)
    a, b, c, d = (middle + p * along + q * across for p, q in ((-1, -1), (1, -1), (1, 1), (-1, 1)))
    return "triangle_list", _ONE, _points([a, b, c, a, c, d])


def _points(corners: Any) -> NDArray[np.float32]:
    return np.asarray(corners, dtype=np.float32).reshape(-1, 3)
