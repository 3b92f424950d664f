"""Properties of link shapes: how low they reach, and whether they are round about an axis."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import cos, hypot, pi, radians, sqrt
from typing import NamedTuple

import numpy as np

from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.arrays import Array
from linkwright.geometry.shapes import FARTHEST, Placement, bounds_of, placement, rotated
from linkwright.geometry.single import Vector3, cross, dot, length, scaled, subtracted
from linkwright.inertia import MeshLibrary
from linkwright.urdf import Box, Capsule, Collision, Cylinder, Link, Mesh, Sphere, Visual

Shape = Collision | Visual

_ALONG = cos(radians(5.0))
"""From this cosine on two axes count as parallel: people write 1.57 for a right angle."""

_OFF_AXIS = 0.1
"""The greatest distance of the middle of a round shape from its axis, as a part of its radius."""

_ROUND = 0.92
"""A mesh whose least reach in any direction across its axis is this part of the greatest is round: a dodecagon is, a
square is not."""

_DIRECTIONS = 36
_LONGEST = 4.0
"""A round shape longer than so many radii is a roller or a shaft."""


class Round(NamedTuple):
    """A shape that is round about an axis.

    Attributes:
        radius: the radius in m.
        width: the width along the axis in m; None for a ball.
        along: the position of the shape's middle along the axis, relative to the axis's given point, in m.
        shape: the shape.
    """

    radius: float
    width: float | None
    along: float
    shape: Shape


def shapes_of(link: Link) -> tuple[Shape, ...]:
    """Return a link's collisions, or its visuals if it has no collisions."""
    return link.collisions or link.visuals


def vertices(shape: Shape, meshes: MeshLibrary) -> Array | None:
    """Return the vertices of a mesh in its link's frame, shape (vertices, 3).

    Returns None if it cannot be read.
    """
    assert isinstance(shape.geometry, Mesh), "other shapes have no corners to ask for"
    try:
        mesh = meshes.load(shape.geometry, shape.element)
    except LinkwrightError:
        return None
    if not len(mesh.faces) or max(map(abs, shape.origin.xyz)) > FARTHEST:
        return None
    frame = placement(shape.origin)
    corners: Array = mesh.vertices[np.unique(mesh.faces)] @ np.array(frame.rotation).T + np.array(frame.position)
    return corners


def lowest(shape: Shape, link_frame: Placement, meshes: MeshLibrary) -> float | None:
    """Return the z of a shape's lowest point in the reference frame of `link_frame`.

    Returns None for an unreadable mesh.
    """
    geometry = shape.geometry
    if isinstance(geometry, Mesh):
        corners = vertices(shape, meshes)
        if corners is None:
            return None
        return float((corners @ np.array(link_frame.rotation[2])).min()) + link_frame.position[2]
    frame = placement(shape.origin).inside(link_frame)
    z = frame.position[2]
    if isinstance(geometry, Sphere):
        return z - geometry.radius
    if isinstance(geometry, Box):
        return z - sum(abs(part) * edge / 2.0 for part, edge in zip(frame.rotation[2], geometry.size, strict=True))
    upright = abs(frame.rotation[2][2])
    if isinstance(geometry, Capsule):
        return z - upright * geometry.length / 2.0 - geometry.radius
    return z - upright * geometry.length / 2.0 - sqrt(max(0.0, 1.0 - upright * upright)) * geometry.radius


def round_shape(
    members: Iterable[tuple[Link, Placement]], point: Vector3, axis: Vector3, meshes: MeshLibrary
) -> tuple[Round | None, list[str]]:
    """Return the shape of a body that rolls about an axis, and the names of unreadable meshes.

    It is the largest shape that is round about the axis, with collisions preferred to visuals. A body whose other
    shapes extend beyond it does not roll.

    Args:
        members: the links of the body, with their poses in a common frame.
        point: a point of the axis in that frame.
        axis: the direction of the axis in that frame, of length 1.
        meshes: the library of meshes.
    """
    links = list(members)
    unread: list[str] = []
    for of_kind in (_collisions, _visuals):
        found: list[Round] = []
        reach = 0.0
        for shape, frame in of_kind(links):
            farthest = _reach(shape, frame, point, axis, meshes)
            if farthest is None:
                unread.append(_name(shape))
                continue
            reach = max(reach, farthest)
            each = _as_round(shape, frame, point, axis, meshes)
            if each is not None:
                found.append(each)
        if found:
            best = max(found, key=lambda item: (item.radius, item.width or 0.0))
            return (best if reach <= best.radius * (1.0 + _OFF_AXIS) else None), unread
    return None, unread


def _collisions(links: list[tuple[Link, Placement]]) -> Iterator[tuple[Shape, Placement]]:
    return ((shape, frame) for link, frame in links for shape in link.collisions)


def _visuals(links: list[tuple[Link, Placement]]) -> Iterator[tuple[Shape, Placement]]:
    return ((shape, frame) for link, frame in links for shape in link.visuals)


def _as_round(shape: Shape, frame: Placement, point: Vector3, axis: Vector3, meshes: MeshLibrary) -> Round | None:
    """Return a shape as round about an axis; None if it is not round."""
    geometry = shape.geometry
    if isinstance(geometry, Mesh):
        return _round_mesh(shape, frame, point, axis, meshes)
    if not isinstance(geometry, Cylinder | Sphere):
        return None
    own = placement(shape.origin).inside(frame)
    along, off = _split(subtracted(own.position, point), axis)
    if not 0.0 < geometry.radius < FARTHEST or off > _OFF_AXIS * geometry.radius:
        return None
    if isinstance(geometry, Sphere):
        return Round(geometry.radius, None, along, shape)
    direction = rotated(own.rotation, (0.0, 0.0, 1.0))
    if abs(dot(direction, axis)) < _ALONG or not 0.0 < geometry.length <= _LONGEST * geometry.radius:
        return None
    return Round(geometry.radius, geometry.length, along, shape)


def _round_mesh(shape: Shape, frame: Placement, point: Vector3, axis: Vector3, meshes: MeshLibrary) -> Round | None:
    placed = _placed(shape, frame, point, meshes)
    if placed is None:
        return None
    first = _across(axis)
    second = cross(axis, first)
    flat = placed @ np.array((first, second)).T
    angles = np.arange(_DIRECTIONS) * (2.0 * pi / _DIRECTIONS)
    reaches = (flat @ np.array((np.cos(angles), np.sin(angles)))).max(axis=0)
    radius, least = float(reaches.max()), float(reaches.min())
    if not 0.0 < radius < FARTHEST or least < _ROUND * radius:
        return None
    heights = placed @ np.array(axis)
    low, high = float(heights.min()), float(heights.max())
    if not 0.0 < high - low <= _LONGEST * radius:
        return None
    return Round(radius, high - low, (low + high) / 2.0, shape)


def _reach(shape: Shape, frame: Placement, point: Vector3, axis: Vector3, meshes: MeshLibrary) -> float | None:
    """Return an upper bound of a shape's distance from an axis, in m.

    Returns None for an unreadable mesh.
    """
    geometry = shape.geometry
    if isinstance(geometry, Mesh):
        placed = _placed(shape, frame, point, meshes)
        if placed is None:
            return None
        across = placed - np.outer(placed @ np.array(axis), np.array(axis))
        return float(np.sqrt((across * across).sum(axis=1).max()))
    own = placement(shape.origin).inside(frame)
    if isinstance(geometry, Sphere):
        return _split(subtracted(own.position, point), axis)[1] + geometry.radius
    if isinstance(geometry, Cylinder) and abs(dot(rotated(own.rotation, (0.0, 0.0, 1.0)), axis)) >= _ALONG:
        return _split(subtracted(own.position, point), axis)[1] + geometry.radius
    box = bounds_of(geometry)
    corners = [
        (x, y, z)
        for x in (box.low[0], box.high[0])
        for y in (box.low[1], box.high[1])
        for z in (box.low[2], box.high[2])
    ]
    return max(_split(subtracted(own.point(corner), point), axis)[1] for corner in corners)


def _placed(shape: Shape, frame: Placement, point: Vector3, meshes: MeshLibrary) -> Array | None:
    corners = vertices(shape, meshes)
    return (
        None if corners is None else corners @ np.array(frame.rotation).T + np.array(subtracted(frame.position, point))
    )


def _split(vector: Vector3, axis: Vector3) -> tuple[float, float]:
    """Return the length of a vector along an axis, with its sign, and perpendicular to the axis."""
    along = dot(vector, axis)
    return along, length(subtracted(vector, scaled(axis, along)))


def _across(axis: Vector3) -> Vector3:
    """Return a unit vector perpendicular to another one."""
    x, y, z = axis
    if abs(z) < 0.9:
        size = hypot(x, y)
        return (-y / size, x / size, 0.0)
    size = hypot(y, z)
    return (0.0, -z / size, y / size)


def _name(shape: Shape) -> str:
    assert isinstance(shape.geometry, Mesh), "all other shapes can be measured"
    return shape.geometry.filename.rpartition("/")[2]
