"""The measurement of links' shapes: lowest points, and roundness about an axis."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import cos, hypot, pi, radians, sqrt
from typing import NamedTuple

import numpy as np

from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.arrays import Array
from linkwright.geometry.shapes import MAX_COORDINATE, Placement, placement, rotated, shape_bounds
from linkwright.geometry.single import Vector3, cross, dot, length, scaled, subtract_vectors
from linkwright.inertia import MeshLibrary
from linkwright.urdf import Box, Capsule, Collision, Cylinder, Link, Mesh, Sphere, Visual

Shape = Collision | Visual

_PARALLEL_COSINE = cos(radians(5.0))
"""The cosine from which two axes count as parallel: 5 degrees, because many files contain 1.57 for a right angle."""

_MAX_OFF_AXIS = 0.1
"""The maximum distance of the middle of a round shape from its axis, as a fraction of its radius."""

_MIN_ROUNDNESS = 0.92
"""The minimum reach of a round mesh in any direction across its axis, as a fraction of its maximum reach.

A regular dodecagon is round, a square is not.
"""

_DIRECTION_COUNT = 36
_MAX_WIDTH = 4.0
"""The maximum length of a wheel in radii. A longer round shape is a roller or a shaft."""


class RoundShape(NamedTuple):
    """A shape that is round about an axis.

    Attributes:
        radius: the radius in m.
        width: the width along the axis in m; None for a ball.
        along: the position of the shape's middle along the axis, relative to the given point of the axis, in m.
        shape: the collision or visual.
    """

    radius: float
    width: float | None
    along: float
    shape: Shape


def get_shapes(link: Link) -> tuple[Shape, ...]:
    """Return a link's collisions, or its visuals if it has none."""
    return link.collisions or link.visuals


def load_vertices(shape: Shape, meshes: MeshLibrary) -> Array | None:
    """Return the vertices of a mesh in its link's frame, in m, shape (vertices, 3).

    Return None if the mesh is empty, too far away, or cannot be read.
    """
    assert isinstance(shape.geometry, Mesh), "other shapes have no corners to ask for"
    try:
        mesh = meshes.load(shape.geometry, shape.element)
    except LinkwrightError:
        return None
    if not len(mesh.faces) or max(map(abs, shape.origin.xyz)) > MAX_COORDINATE:
        return None
    frame = placement(shape.origin)
    corners: Array = mesh.vertices[np.unique(mesh.faces)] @ np.array(frame.rotation).T + np.array(frame.position)
    return corners


def find_lowest_z(shape: Shape, link_frame: Placement, meshes: MeshLibrary) -> float | None:
    """Return the z in m of a shape's lowest point, in the reference frame of `link_frame`.

    Return None for a mesh that cannot be read.
    """
    geometry = shape.geometry
    if isinstance(geometry, Mesh):
        corners = load_vertices(shape, meshes)
        if corners is None:
            return None
        return float((corners @ np.array(link_frame.rotation[2])).min()) + link_frame.position[2]
    frame = placement(shape.origin).inside(link_frame)
    z = frame.position[2]
    if isinstance(geometry, Sphere):
        return z - geometry.radius
    if isinstance(geometry, Box):
        return z - sum(
            abs(component) * edge / 2.0 for component, edge in zip(frame.rotation[2], geometry.size, strict=True)
        )
    vertical = abs(frame.rotation[2][2])
    if isinstance(geometry, Capsule):
        return z - vertical * geometry.length / 2.0 - geometry.radius
    return z - vertical * geometry.length / 2.0 - sqrt(max(0.0, 1.0 - vertical * vertical)) * geometry.radius


def find_round_shape(
    members: Iterable[tuple[Link, Placement]], point: Vector3, axis: Vector3, meshes: MeshLibrary
) -> tuple[RoundShape | None, list[str]]:
    """Return the shape with which a body rolls about an axis, and unreadable meshes.

    The meshes are listed by name. The shape is the largest one that is round about the axis; collisions take precedence
    over visuals. It is None if no shape is round, or if another shape extends beyond it, so that the body cannot roll.

    Args:
        members: the links of the body, with their poses in a common frame.
        point: a point of the axis in that frame.
        axis: the direction of the axis in that frame, of length 1.
        meshes: the library of meshes.
    """
    links = list(members)
    unreadable: list[str] = []
    for list_shapes in (_list_collisions, _list_visuals):
        round_shapes: list[RoundShape] = []
        max_reach = 0.0
        for shape, frame in list_shapes(links):
            farthest = _compute_distance_bound(shape, frame, point, axis, meshes)
            if farthest is None:
                unreadable.append(_get_mesh_name(shape))
                continue
            max_reach = max(max_reach, farthest)
            candidate = _measure_round(shape, frame, point, axis, meshes)
            if candidate is not None:
                round_shapes.append(candidate)
        if round_shapes:
            best = max(round_shapes, key=lambda item: (item.radius, item.width or 0.0))
            return (best if max_reach <= best.radius * (1.0 + _MAX_OFF_AXIS) else None), unreadable
    return None, unreadable


def _list_collisions(links: list[tuple[Link, Placement]]) -> Iterator[tuple[Shape, Placement]]:
    return ((shape, frame) for link, frame in links for shape in link.collisions)


def _list_visuals(links: list[tuple[Link, Placement]]) -> Iterator[tuple[Shape, Placement]]:
    return ((shape, frame) for link, frame in links for shape in link.visuals)


def _measure_round(
    shape: Shape, frame: Placement, point: Vector3, axis: Vector3, meshes: MeshLibrary
) -> RoundShape | None:
    """Return a shape with its size about an axis, or None if it is not round about the axis."""
    geometry = shape.geometry
    if isinstance(geometry, Mesh):
        return _measure_round_mesh(shape, frame, point, axis, meshes)
    if not isinstance(geometry, Cylinder | Sphere):
        return None
    shape_frame = placement(shape.origin).inside(frame)
    along, off_axis = _split_along(subtract_vectors(shape_frame.position, point), axis)
    if not 0.0 < geometry.radius < MAX_COORDINATE or off_axis > _MAX_OFF_AXIS * geometry.radius:
        return None
    if isinstance(geometry, Sphere):
        return RoundShape(geometry.radius, None, along, shape)
    direction = rotated(shape_frame.rotation, (0.0, 0.0, 1.0))
    if abs(dot(direction, axis)) < _PARALLEL_COSINE or not 0.0 < geometry.length <= _MAX_WIDTH * geometry.radius:
        return None
    return RoundShape(geometry.radius, geometry.length, along, shape)


def _measure_round_mesh(
    shape: Shape, frame: Placement, point: Vector3, axis: Vector3, meshes: MeshLibrary
) -> RoundShape | None:
    points = _load_points(shape, frame, point, meshes)
    if points is None:
        return None
    first = _find_perpendicular(axis)
    second = cross(axis, first)
    projected = points @ np.array((first, second)).T
    angles = np.arange(_DIRECTION_COUNT) * (2.0 * pi / _DIRECTION_COUNT)
    reaches = (projected @ np.array((np.cos(angles), np.sin(angles)))).max(axis=0)
    radius, min_reach = float(reaches.max()), float(reaches.min())
    if not 0.0 < radius < MAX_COORDINATE or min_reach < _MIN_ROUNDNESS * radius:
        return None
    positions = points @ np.array(axis)
    start, end = float(positions.min()), float(positions.max())
    if not 0.0 < end - start <= _MAX_WIDTH * radius:
        return None
    return RoundShape(radius, end - start, (start + end) / 2.0, shape)


def _compute_distance_bound(
    shape: Shape, frame: Placement, point: Vector3, axis: Vector3, meshes: MeshLibrary
) -> float | None:
    """Return an upper bound of a shape's distance from an axis, in m.

    Return None for a mesh that cannot be read.
    """
    geometry = shape.geometry
    if isinstance(geometry, Mesh):
        points = _load_points(shape, frame, point, meshes)
        if points is None:
            return None
        perpendicular = points - np.outer(points @ np.array(axis), np.array(axis))
        return float(np.sqrt((perpendicular * perpendicular).sum(axis=1).max()))
    shape_frame = placement(shape.origin).inside(frame)
    if isinstance(geometry, Sphere):
        return _split_along(subtract_vectors(shape_frame.position, point), axis)[1] + geometry.radius
    if (
        isinstance(geometry, Cylinder)
        and abs(dot(rotated(shape_frame.rotation, (0.0, 0.0, 1.0)), axis)) >= _PARALLEL_COSINE
    ):
        return _split_along(subtract_vectors(shape_frame.position, point), axis)[1] + geometry.radius
    box = shape_bounds(geometry)
    corners = [
        (x, y, z)
        for x in (box.low[0], box.high[0])
        for y in (box.low[1], box.high[1])
        for z in (box.low[2], box.high[2])
    ]
    return max(_split_along(subtract_vectors(shape_frame.point(corner), point), axis)[1] for corner in corners)


def _load_points(shape: Shape, frame: Placement, point: Vector3, meshes: MeshLibrary) -> Array | None:
    corners = load_vertices(shape, meshes)
    return (
        None
        if corners is None
        else corners @ np.array(frame.rotation).T + np.array(subtract_vectors(frame.position, point))
    )


def _split_along(vector: Vector3, axis: Vector3) -> tuple[float, float]:
    """Return a vector's signed component along an axis, and its perpendicular length."""
    along = dot(vector, axis)
    return along, length(subtract_vectors(vector, scaled(axis, along)))


def _find_perpendicular(axis: Vector3) -> Vector3:
    """Return a unit vector that is perpendicular to a unit vector."""
    x, y, z = axis
    if abs(z) < 0.9:
        size = hypot(x, y)
        return (-y / size, x / size, 0.0)
    size = hypot(y, z)
    return (0.0, -z / size, y / size)


def _get_mesh_name(shape: Shape) -> str:
    assert isinstance(shape.geometry, Mesh), "all other shapes can be measured"
    return shape.geometry.filename.rpartition("/")[2]
