"""The primitive shapes in descriptions, and frames as rotation matrix and position.

Rotations are matrices as three rows, from the child frame to the parent frame; lengths are meters. All numbers are
plain floats: for few frames, this is faster than arrays, and it needs no numpy.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import acos, hypot, pi, prod

from linkwright.geometry.single import (
    Pose,
    Vector3,
    add_vectors,
    dot,
    pose_quaternion,
    rotation_matrix,
    scaled,
    subtract_vectors,
)
from linkwright.loading.lean_dataclasses import NamedTuple, dataclass


@dataclass(frozen=True, slots=True)
class Box:
    """A box with edge lengths along x, y, z in meters, centered at the origin."""

    size: Vector3


@dataclass(frozen=True, slots=True)
class Cylinder:
    """A cylinder along z, centered at the origin, with lengths in meters."""

    radius: float
    length: float


@dataclass(frozen=True, slots=True)
class Capsule:
    """A capsule along z, centered at the origin (URDF 1.1).

    Lengths are in meters, and `length` is the length of the cylindrical part.
    """

    radius: float
    length: float


@dataclass(frozen=True, slots=True)
class Sphere:
    """A sphere centered at the origin, with its radius in meters."""

    radius: float


SimpleShape = Box | Cylinder | Capsule | Sphere


def shape_volume(shape: SimpleShape) -> float:
    """Return the volume of a shape in m3.

    The volume is 0 if a size is zero or less, and infinite on overflow.
    """
    if isinstance(shape, Box):
        return prod(shape.size) if min(shape.size) > 0 else 0.0
    r = max(shape.radius, 0.0)
    ball = 4 / 3 * pi * (r * r * r)  # r ** 3 would raise OverflowError for a large number.
    if isinstance(shape, Sphere):
        return ball
    if isinstance(shape, Capsule):
        return pi * r * r * shape.length + ball if r > 0 and shape.length >= 0 else 0.0
    return pi * r * r * shape.length if min(r, shape.length) > 0 else 0.0


Matrix = tuple[Vector3, Vector3, Vector3]

IDENTITY: Matrix = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


class Placement(NamedTuple):
    """The rotation and position of an inner frame in an outer frame."""

    rotation: Matrix
    position: Vector3

    def point(self, inner: Vector3) -> Vector3:
        """Transform a point from the inner frame to the outer frame."""
        x, y, z = rotated(self.rotation, inner)
        return x + self.position[0], y + self.position[1], z + self.position[2]

    def inside(self, outer: Placement) -> Placement:
        """Return this frame in the outer frame of another placement.

        The outer frame of this placement is the inner frame of `outer`.
        """
        return Placement(product(outer.rotation, self.rotation), outer.point(self.position))

    def seen_from(self, reference: Placement) -> Placement:
        """Return this frame in another frame.

        Both placements have the same outer frame.
        """
        inverse = transposed(reference.rotation)
        difference = subtract_vectors(self.position, reference.position)
        return Placement(product(inverse, self.rotation), rotated(inverse, difference))


def placement(pose: Pose) -> Placement:
    """Convert a pose to a rotation matrix and a position."""
    return Placement(rotation(pose), pose.xyz)


def rotation(pose: Pose) -> Matrix:
    """Return the rotation matrix of a pose."""
    return rotation_matrix(pose_quaternion(pose))


def product(first: Matrix, second: Matrix) -> Matrix:
    """Return the product of two matrices: the rotation that applies `second`, then `first`."""
    columns = transposed(second)
    rows = [tuple(dot(row, column) for column in columns) for row in first]
    return (_vector(rows[0]), _vector(rows[1]), _vector(rows[2]))


def transposed(matrix: Matrix) -> Matrix:
    """Return the transpose of a matrix.

    For a rotation matrix, this is the inverse.
    """
    return (
        (matrix[0][0], matrix[1][0], matrix[2][0]),
        (matrix[0][1], matrix[1][1], matrix[2][1]),
        (matrix[0][2], matrix[1][2], matrix[2][2]),
    )


def rotated(matrix: Matrix, vector: Vector3) -> Vector3:
    """Return a vector rotated by a matrix."""
    return dot(matrix[0], vector), dot(matrix[1], vector), dot(matrix[2], vector)


def angle_between(first: Matrix, second: Matrix) -> float:
    """Return the angle in radians of the rotation between two orientations."""
    trace = sum(dot(row, second_row) for row, second_row in zip(first, second, strict=True))
    return acos(max(-1.0, min(1.0, (trace - 1.0) / 2.0)))


def _vector(values: tuple[float, ...]) -> Vector3:
    return values[0], values[1], values[2]


MAX_COORDINATE = 1e9
"""Lengths beyond this, in m, are mistakes. They are not used in computations, so that nothing overflows."""


class Bounds(NamedTuple):
    """A box along the axes of a frame, given by its minimum and maximum corners in m."""

    low: Vector3
    high: Vector3

    @property
    def size(self) -> Vector3:
        """The edge lengths in m."""
        return subtract_vectors(self.high, self.low)

    @property
    def center(self) -> Vector3:
        """The center in m."""
        return scaled(add_vectors(self.low, self.high), 0.5)

    @property
    def diagonal(self) -> float:
        """The distance between opposite corners in m."""
        return hypot(*self.size)

    def gap(self, other: Bounds) -> float:
        """Return the distance between two boxes, in m, or 0 if they touch."""
        gaps = (subtract_vectors(self.low, other.high), subtract_vectors(other.low, self.high))
        return hypot(*(max(0.0, before, after) for before, after in zip(*gaps, strict=True)))

    def nearest(self, point: Vector3) -> Vector3:
        """Return the point of the box that is nearest to a point."""
        x, y, z = (
            min(max(coordinate, low), high) for coordinate, low, high in zip(point, self.low, self.high, strict=True)
        )
        return x, y, z

    def distance(self, point: Vector3) -> float:
        """Return the distance between a point and the box, in m, or 0 inside the box."""
        return self.gap(Bounds(point, point))

    def moved(self, frame: Placement) -> Bounds:
        """Return the bounding box of this box in a parent frame.

        `frame` is the placement of this box's frame in the parent frame.
        """
        low, high = [], []
        for row, start in zip(frame.rotation, frame.position, strict=True):
            products = [(a * factor, b * factor) for factor, a, b in zip(row, self.low, self.high, strict=True)]
            low.append(start + sum(map(min, products)))
            high.append(start + sum(map(max, products)))
        return Bounds((low[0], low[1], low[2]), (high[0], high[1], high[2]))


def shape_bounds(shape: SimpleShape) -> Bounds:
    """Return the bounding box of a shape along its own axes."""
    if isinstance(shape, Box):
        x, y, z = (abs(edge) / 2.0 for edge in shape.size)
    elif isinstance(shape, Sphere):
        x = y = z = abs(shape.radius)
    else:
        x = y = abs(shape.radius)
        z = abs(shape.length / 2.0 + (shape.radius if isinstance(shape, Capsule) else 0.0))
    return Bounds((-x, -y, -z), (x, y, z))


def union(boxes: Iterable[Bounds]) -> Bounds | None:
    """Return the bounding box of several boxes, or None if there are none."""
    box_list = list(boxes)
    if len(box_list) < 2:
        return box_list[0] if box_list else None
    low = tuple(map(min, *(box.low for box in box_list)))
    high = tuple(map(max, *(box.high for box in box_list)))
    return Bounds((low[0], low[1], low[2]), (high[0], high[1], high[2]))
