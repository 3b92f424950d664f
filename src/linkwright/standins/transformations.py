"""Rotations and homogeneous matrices with the API of ``tf_transformations``.

Quaternions are in the order x y z w. A matrix is an array of shape (4, 4) that multiplies column vectors. Euler angles
are in radians. Their axes code is ``s`` for static or ``r`` for rotating axes, followed by the three axes in the order
of rotation. ``sxyz`` means ROS's roll, pitch and yaw.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from linkwright.geometry import arrays

Matrix = NDArray[np.float64]
Vector = NDArray[np.float64]

_EPSILON = 4.0 * float(np.finfo(float).eps)
_EVEN_PERMUTATIONS = ((0, 1, 2), (1, 2, 0), (2, 0, 1))
_AXES = {
    f"{frame}{''.join(letters)}"
    for frame in "sr"
    for letters in ((a, b, c) for a in "xyz" for b in "xyz" for c in "xyz" if a != b and b != c)
}


def identity_matrix() -> Matrix:
    """Return the identity matrix."""
    return np.eye(4)


def translation_matrix(direction: ArrayLike) -> Matrix:
    """Return the matrix of a translation by a vector."""
    matrix = np.eye(4)
    matrix[:3, 3] = np.asarray(direction, dtype=float)[:3]
    return matrix


def translation_from_matrix(matrix: ArrayLike) -> Vector:
    """Return the translation part of a matrix, of shape (3,)."""
    translation: Vector = np.array(matrix, dtype=float)[:3, 3].copy()
    return translation


def rotation_matrix(angle: float, direction: ArrayLike, point: ArrayLike | None = None) -> Matrix:
    """Return the matrix of a rotation about an axis.

    Args:
        angle: the angle in radians.
        direction: the direction of the axis.
        point: a point on the axis; None for the origin.
    """
    matrix = quaternion_matrix(quaternion_about_axis(angle, direction))
    if point is not None:
        fixed_point = np.asarray(point, dtype=float)[:3]
        matrix[:3, 3] = fixed_point - matrix[:3, :3] @ fixed_point
    return matrix


def rotation_from_matrix(matrix: ArrayLike) -> tuple[float, Vector, Vector]:
    """Return the angle in radians, the axis, and a point on the axis of a rotation matrix.

    The point has homogeneous coordinates x, y, z, 1.

    Raises:
        ValueError: the matrix is not a rotation.
    """
    m = np.array(matrix, dtype=float)
    direction = _find_fixed_vector(m[:3, :3].T)
    point = _find_fixed_vector(m)
    point = point / point[3]
    x, y, z, w = quaternion_from_matrix(m)
    axis = np.array([x, y, z])
    angle = 2.0 * math.atan2(float(axis @ direction), float(w))
    return math.remainder(angle, 2.0 * math.pi), direction, point


def scale_matrix(factor: float, origin: ArrayLike | None = None, direction: ArrayLike | None = None) -> Matrix:
    """Return the matrix of a scaling about a point.

    Args:
        factor: the scale factor.
        origin: the fixed point; None for the origin.
        direction: the direction along which to scale; None for all directions.
    """
    matrix = np.eye(4)
    if direction is None:
        matrix[:3, :3] *= factor
    else:
        unit_direction = unit_vector(np.asarray(direction, dtype=float)[:3])
        matrix[:3, :3] -= (1.0 - factor) * np.outer(unit_direction, unit_direction)
    if origin is not None:
        fixed_point = np.asarray(origin, dtype=float)[:3]
        matrix[:3, 3] = fixed_point - matrix[:3, :3] @ fixed_point
    return matrix


def reflection_matrix(point: ArrayLike, normal: ArrayLike) -> Matrix:
    """Return the matrix of the reflection in the plane through a point with a normal vector."""
    return scale_matrix(-1.0, point, normal)


def euler_matrix(ai: float, aj: float, ak: float, axes: str = "sxyz") -> Matrix:
    """Return the rotation matrix for Euler angles.

    Raises:
        ValueError: the axes code is invalid.
    """
    return quaternion_matrix(quaternion_from_euler(ai, aj, ak, axes))


def euler_from_matrix(matrix: ArrayLike, axes: str = "sxyz") -> tuple[float, float, float]:
    """Return the Euler angles of a rotation matrix.

    In gimbal lock, the last angle is 0 for static axes, and the first for rotating axes.

    Raises:
        ValueError: the axes code is invalid.
    """
    are_rotating, (a, b, c) = _parse_axes(axes)
    m = np.asarray(matrix, dtype=float)[:3, :3]
    first, second, third = _proper_angles(m, a, b) if a == c else _cardan_angles(m, a, b, c)
    return (third, second, first) if are_rotating else (first, second, third)


def euler_from_quaternion(quaternion: Sequence[float], axes: str = "sxyz") -> tuple[float, float, float]:
    """Return the Euler angles of a quaternion x y z w.

    Raises:
        ValueError: the axes code is invalid.
    """
    return euler_from_matrix(quaternion_matrix(quaternion), axes)


def quaternion_from_euler(ai: float, aj: float, ak: float, axes: str = "sxyz") -> Vector:
    """Return the quaternion x y z w for Euler angles.

    Raises:
        ValueError: the axes code is invalid.
    """
    are_rotating, (a, b, c) = _parse_axes(axes)
    first, third = (ak, ai) if are_rotating else (ai, ak)
    return quaternion_multiply(
        _rotation_about(third, c), quaternion_multiply(_rotation_about(aj, b), _rotation_about(first, a))
    )


def quaternion_about_axis(angle: float, axis: ArrayLike) -> Vector:
    """Return the quaternion x y z w of a rotation by an angle about an axis."""
    vector = np.asarray(axis, dtype=float)[:3]
    length = float(np.linalg.norm(vector))
    scale = math.sin(angle / 2.0) / length if length > _EPSILON else 0.0
    return np.array([*(vector * scale), math.cos(angle / 2.0)])


def quaternion_matrix(quaternion: ArrayLike) -> Matrix:
    """Return the rotation matrix of a quaternion x y z w.

    The quaternion need not have unit length.
    """
    x, y, z, w = (float(value) for value in np.asarray(quaternion, dtype=float)[:4])
    squared_length = x * x + y * y + z * z + w * w
    matrix = np.eye(4)
    if squared_length < _EPSILON:
        return matrix
    factor = 2.0 / squared_length
    matrix[:3, :3] = (
        (1.0 - factor * (y * y + z * z), factor * (x * y - z * w), factor * (x * z + y * w)),
        (factor * (x * y + z * w), 1.0 - factor * (x * x + z * z), factor * (y * z - x * w)),
        (factor * (x * z - y * w), factor * (y * z + x * w), 1.0 - factor * (x * x + y * y)),
    )
    return matrix


def quaternion_from_matrix(matrix: ArrayLike) -> Vector:
    """Return the unit quaternion x y z w of a rotation matrix, with non-negative w.

    For a matrix that is not exactly a rotation, return the quaternion of the nearest rotation.
    """
    m = np.asarray(matrix, dtype=float)[:3, :3]
    # The quaternion x y z w is the eigenvector of this matrix with the largest eigenvalue (Bar-Itzhack 2000).
    k = np.array(
        [
            [m[0, 0] - m[1, 1] - m[2, 2], m[0, 1] + m[1, 0], m[0, 2] + m[2, 0], m[2, 1] - m[1, 2]],
            [m[0, 1] + m[1, 0], m[1, 1] - m[0, 0] - m[2, 2], m[1, 2] + m[2, 1], m[0, 2] - m[2, 0]],
            [m[0, 2] + m[2, 0], m[1, 2] + m[2, 1], m[2, 2] - m[0, 0] - m[1, 1], m[1, 0] - m[0, 1]],
            [m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], m[0, 0] + m[1, 1] + m[2, 2]],
        ]
    )
    values, vectors = np.linalg.eigh(k)
    quaternion: Vector = vectors[:, np.argmax(values)]
    return -quaternion if quaternion[3] < 0.0 else quaternion


def quaternion_multiply(quaternion1: ArrayLike, quaternion0: ArrayLike) -> Vector:
    """Return the product of two quaternions x y z w.

    The product is a rotation by `quaternion0`, followed by a rotation by `quaternion1`, about static axes.
    """
    return arrays.quaternion_multiply(quaternion1, quaternion0)


def quaternion_conjugate(quaternion: ArrayLike) -> Vector:
    """Return the conjugate of a quaternion x y z w."""
    return arrays.quaternion_inverse(quaternion)


def quaternion_inverse(quaternion: ArrayLike) -> Vector:
    """Return the inverse of a quaternion x y z w."""
    q = np.asarray(quaternion, dtype=float)
    return quaternion_conjugate(q) / float(q @ q)


def quaternion_slerp(
    quat0: ArrayLike, quat1: ArrayLike, fraction: float, spin: int = 0, shortestpath: bool = True
) -> Vector:
    """Interpolate between two quaternions x y z w on the unit sphere (slerp).

    Args:
        quat0: the quaternion for fraction 0.
        quat1: the quaternion for fraction 1.
        fraction: the position between the two quaternions, from 0 to 1.
        spin: the number of additional full turns of the body. As in transformations.py, the result is a unit
            quaternion only if the number is even.
        shortestpath: whether to take the path with the smaller angle.
    """
    q0, q1 = unit_vector(np.asarray(quat0, dtype=float)[:4]), unit_vector(np.asarray(quat1, dtype=float)[:4])
    cosine = float(q0 @ q1)
    if shortestpath and cosine < 0.0:
        cosine, q1 = -cosine, -q1
    angle = math.acos(max(-1.0, min(1.0, cosine))) + spin * math.pi
    if abs(angle) < _EPSILON:
        return q0
    scale = 1.0 / math.sin(angle)
    result: Vector = q0 * (math.sin((1.0 - fraction) * angle) * scale) + q1 * (math.sin(fraction * angle) * scale)
    return result


def random_quaternion(rand: Sequence[float] | None = None) -> Vector:
    """Return a uniformly distributed random unit quaternion x y z w (Shoemake 1992).

    Args:
        rand: three random numbers between 0 and 1; None to draw them.
    """
    u, v, w = np.random.default_rng().random(3) if rand is None else rand
    outer_radius, inner_radius = math.sqrt(1.0 - u), math.sqrt(u)
    first_angle, second_angle = 2.0 * math.pi * v, 2.0 * math.pi * w
    return np.array(
        [
            math.sin(first_angle) * outer_radius,
            math.cos(first_angle) * outer_radius,
            math.sin(second_angle) * inner_radius,
            math.cos(second_angle) * inner_radius,
        ]
    )


def random_rotation_matrix(rand: Sequence[float] | None = None) -> Matrix:
    """Return a uniformly distributed random rotation matrix.

    Args:
        rand: three random numbers between 0 and 1; None to draw them.
    """
    return quaternion_matrix(random_quaternion(rand))


def random_vector(size: int) -> Vector:
    """Return a vector of `size` random numbers between 0 and 1."""
    return np.random.default_rng().random(size)


def inverse_matrix(matrix: ArrayLike) -> Matrix:
    """Return the inverse of a matrix."""
    inverse: Matrix = np.linalg.inv(np.asarray(matrix, dtype=float))
    return inverse


def concatenate_matrices(*matrices: ArrayLike) -> Matrix:
    """Return the product of matrices in the order of the arguments."""
    product = np.eye(4)
    for matrix in matrices:
        product = product @ np.asarray(matrix, dtype=float)
    return product


def is_same_transform(matrix0: ArrayLike, matrix1: ArrayLike) -> bool:
    """Return whether two matrices describe the same transform, up to a scale factor."""
    m0, m1 = np.array(matrix0, dtype=float), np.array(matrix1, dtype=float)
    return bool(np.allclose(m0 / m0[3, 3], m1 / m1[3, 3]))


def vector_norm(data: ArrayLike, axis: int | None = None) -> Any:
    """Return the Euclidean length of a vector, or of each vector along an axis."""
    return np.linalg.norm(np.asarray(data, dtype=float), axis=axis)


def unit_vector(data: ArrayLike, axis: int | None = None) -> Vector:
    """Return a vector scaled to unit length, or each vector along an axis."""
    vectors = np.array(data, dtype=float)
    lengths = np.linalg.norm(vectors, axis=axis, keepdims=axis is not None)
    unit: Vector = vectors / lengths
    return unit


def compose_matrix(
    scale: ArrayLike | None = None,
    shear: ArrayLike | None = None,
    angles: Sequence[float] | None = None,
    translate: ArrayLike | None = None,
    perspective: ArrayLike | None = None,
) -> Matrix:
    """Return a matrix that scales, shears, rotates, translates and projects, in this order.

    None for an argument omits this step.

    Args:
        scale: the factors for x, y and z.
        shear: the factors for x-y, x-z and y-z.
        angles: the Euler angles (``sxyz``) in radians.
        translate: the translation vector.
        perspective: the last row of the matrix of the projection.
    """
    matrix = np.eye(4)
    if perspective is not None:
        matrix[3, :] = np.asarray(perspective, dtype=float)[:4]
    if translate is not None:
        matrix = matrix @ translation_matrix(translate)
    if angles is not None:
        matrix = matrix @ euler_matrix(angles[0], angles[1], angles[2])
    if shear is not None:
        shear_matrix = np.eye(4)
        shear_matrix[0, 1], shear_matrix[0, 2], shear_matrix[1, 2] = np.asarray(shear, dtype=float)
        matrix = matrix @ shear_matrix
    if scale is not None:
        matrix = matrix @ np.diag([*np.asarray(scale, dtype=float)[:3], 1.0])
    normalized: Matrix = matrix / matrix[3, 3]
    return normalized


def decompose_matrix(matrix: ArrayLike) -> tuple[Vector, list[float], list[float], Vector, Vector]:
    """Return the scale, shear, Euler angles, translation and perspective of a matrix.

    The axes code of the angles is ``sxyz``. This is the inverse of `compose_matrix`.

    Raises:
        ValueError: the matrix is not invertible.
    """
    m = np.array(matrix, dtype=float)
    if abs(m[3, 3]) < _EPSILON:
        raise ValueError("M[3, 3] is zero")
    m /= m[3, 3]
    if abs(np.linalg.det(m[:3, :3])) < _EPSILON:
        raise ValueError("Matrix is singular")
    perspective = np.array([0.0, 0.0, 0.0, 1.0])
    if np.abs(m[3, :3]).max() > _EPSILON:
        affine = m.copy()
        affine[3] = (0.0, 0.0, 0.0, 1.0)
        perspective = m[3] @ np.linalg.inv(affine)
    # The rotation times an upper triangular matrix; the diagonal is positive unless the matrix contains a reflection.
    rotation, triangle = np.linalg.qr(m[:3, :3])
    signs = np.sign(np.diag(triangle))
    rotation, triangle = rotation * signs, triangle * signs[:, None]
    if np.linalg.det(rotation) < 0.0:
        rotation, triangle = -rotation, -triangle
    scale = np.diag(triangle).copy()
    shear = [float(triangle[0, 1] / scale[1]), float(triangle[0, 2] / scale[2]), float(triangle[1, 2] / scale[2])]
    return scale, shear, list(euler_from_matrix(rotation)), m[:3, 3].copy(), perspective


def _parse_axes(axes: str) -> tuple[bool, tuple[int, int, int]]:
    """Parse an axes code.

    Returns:
        Whether the axes rotate, and the indices of the three axes in the equivalent order for static axes.
    """
    if axes not in _AXES:
        raise ValueError(f"unknown axes '{axes}': write s or r and three axes, such as sxyz")
    a, b, c = ("xyz".index(letter) for letter in axes[1:])
    # A rotation about rotating axes equals the rotation about static axes in reverse order.
    return (True, (c, b, a)) if axes[0] == "r" else (False, (a, b, c))


def _rotation_about(angle: float, axis: int) -> Vector:
    quaternion = np.zeros(4)
    quaternion[axis], quaternion[3] = math.sin(angle / 2.0), math.cos(angle / 2.0)
    return quaternion


def _cardan_angles(m: Matrix, a: int, b: int, c: int) -> tuple[float, float, float]:
    sign = 1.0 if (a, b, c) in _EVEN_PERMUTATIONS else -1.0
    cosine = math.hypot(m[a, a], m[b, a])
    second = math.atan2(-sign * m[c, a], cosine)
    if cosine > _EPSILON:
        return math.atan2(sign * m[c, b], m[c, c]), second, math.atan2(sign * m[b, a], m[a, a])
    return math.atan2(-sign * m[b, c], m[b, b]), second, 0.0


def _proper_angles(m: Matrix, a: int, b: int) -> tuple[float, float, float]:
    c = 3 - a - b
    sign = 1.0 if (a, b, c) in _EVEN_PERMUTATIONS else -1.0
    sine = math.hypot(m[a, b], m[a, c])
    second = sign * math.atan2(sine, m[a, a])
    if sine > _EPSILON:
        return sign * math.atan2(m[a, b], m[a, c]), second, sign * math.atan2(m[b, a], -m[c, a])
    return sign * math.atan2(-m[b, c], m[b, b]), second, 0.0


def _find_fixed_vector(matrix: Matrix) -> Vector:
    """Return the real unit eigenvector of a matrix for the eigenvalue 1."""
    values, vectors = np.linalg.eig(matrix)
    fixed_indices = np.flatnonzero(np.abs(np.real(values) - 1.0) < 1e-8)
    if not fixed_indices.size:
        raise ValueError("no unit eigenvector corresponding to eigenvalue 1")
    vector: Vector = np.real(vectors[:, fixed_indices[-1]])
    return vector
