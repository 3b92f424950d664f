"""Vectors of three plain floats."""

from __future__ import annotations

from math import sqrt

Vector3 = tuple[float, float, float]


def added(first: Vector3, second: Vector3) -> Vector3:
    """The sum."""
    return first[0] + second[0], first[1] + second[1], first[2] + second[2]


def subtracted(first: Vector3, second: Vector3) -> Vector3:
    """The first vector less the second."""
    return first[0] - second[0], first[1] - second[1], first[2] - second[2]


def scaled(vector: Vector3, factor: float) -> Vector3:
    """The vector times a factor."""
    return vector[0] * factor, vector[1] * factor, vector[2] * factor


def dot(first: Vector3, second: Vector3) -> float:
    """The scalar product."""
    return first[0] * second[0] + first[1] * second[1] + first[2] * second[2]


def cross(first: Vector3, second: Vector3) -> Vector3:
    """The vector product."""
    (a, b, c), (x, y, z) = first, second
    return b * z - c * y, c * x - a * z, a * y - b * x


def length(vector: Vector3) -> float:
    """The Euclidean length."""
    return sqrt(dot(vector, vector))
