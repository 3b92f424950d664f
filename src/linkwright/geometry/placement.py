"""A frame in another one as a rotation matrix and a position, in plain floats.

Rotations are matrices as three rows, from the child frame to the parent frame; lengths are metres. For few frames this
is quicker than arrays, and it needs no numpy.
"""

from __future__ import annotations

from math import acos

from linkwright.geometry.single import Pose, Vector3, dot, quaternion_of, rotation_matrix, subtracted
from linkwright.loading.lean_dataclasses import NamedTuple

Matrix = tuple[Vector3, Vector3, Vector3]

IDENTITY: Matrix = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


class Placement(NamedTuple):
    """A frame in another one."""

    rotation: Matrix
    position: Vector3

    def point(self, inner: Vector3) -> Vector3:
        """A point of the inner frame, in the outer one."""
        x, y, z = turned(self.rotation, inner)
        return x + self.position[0], y + self.position[1], z + self.position[2]

    def inside(self, outer: Placement) -> Placement:
        """This frame in the outer frame of `outer`, given this one in its inner frame."""
        return Placement(product(outer.rotation, self.rotation), outer.point(self.position))

    def seen_from(self, other: Placement) -> Placement:
        """This frame in the other one, both given in the same frame."""
        back = transposed(other.rotation)
        difference = subtracted(self.position, other.position)
        return Placement(product(back, self.rotation), turned(back, difference))


def placement(pose: Pose) -> Placement:
    """Convert a pose."""
    return Placement(rotation(pose), pose.xyz)


def rotation(pose: Pose) -> Matrix:
    """The rotation of a pose."""
    return rotation_matrix(quaternion_of(pose))


def product(first: Matrix, second: Matrix) -> Matrix:
    """The second rotation followed by the first."""
    columns = transposed(second)
    rows = [tuple(dot(row, column) for column in columns) for row in first]
    return (_vector(rows[0]), _vector(rows[1]), _vector(rows[2]))


def transposed(matrix: Matrix) -> Matrix:
    """The inverse of a rotation."""
    return (
        (matrix[0][0], matrix[1][0], matrix[2][0]),
        (matrix[0][1], matrix[1][1], matrix[2][1]),
        (matrix[0][2], matrix[1][2], matrix[2][2]),
    )


def turned(matrix: Matrix, vector: Vector3) -> Vector3:
    """A rotated vector."""
    return dot(matrix[0], vector), dot(matrix[1], vector), dot(matrix[2], vector)


def angle_between(first: Matrix, second: Matrix) -> float:
    """The angle in radians by which two rotations differ."""
    trace = sum(dot(row, other) for row, other in zip(first, second, strict=True))
    return acos(max(-1.0, min(1.0, (trace - 1.0) / 2.0)))


def _vector(values: tuple[float, ...]) -> Vector3:
    return values[0], values[1], values[2]
