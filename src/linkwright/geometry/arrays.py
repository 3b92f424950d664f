"""Rotations and poses in arrays, with operations that broadcast over the leading axes.

A quaternion is x, y, z, w in the last axis, as in ROS messages, and has unit length unless stated otherwise. A rotation
is active: it rotates vectors of the child frame into the parent frame. Roll, pitch and yaw are angles in radians about
the fixed axes x, y, z in this order, R = Rz(yaw) Ry(pitch) Rx(roll) (REP 103). A pose is the pose of a child frame in
its parent frame, as a row x, y, z, qx, qy, qz, qw: meters and a unit quaternion.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from linkwright.geometry.single import Pose, pose_quaternion

Array = NDArray[np.float64]

IDENTITY: Array = np.array((0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0))
IDENTITY.flags.writeable = False
"""The pose of a frame in itself, shape (7,)."""

_PARALLEL_DOT_PRODUCT = 0.9995
"""Quaternions with a larger dot product than this are interpolated linearly."""


def as_array(values: ArrayLike, length: int, name: str) -> Array:
    """Convert values to a float64 array, after checking the length of the last axis.

    `name` names the values in the error.

    Raises:
        ValueError: the last axis has another length.
    """
    array = np.asarray(values, dtype=np.float64)
    if array.ndim == 0 or array.shape[-1] != length:
        raise ValueError(f"{name} must have the shape (..., {length}), not {array.shape}")
    return array


def quaternion_from_rpy(rpy: ArrayLike) -> Array:
    """Return the rotation by roll, pitch and yaw as a quaternion.

    Args:
        rpy: shape (..., 3), radians.

    Returns:
        Shape (..., 4).
    """
    half = as_array(rpy, 3, "roll, pitch and yaw") / 2
    sin_roll, sin_pitch, sin_yaw = np.moveaxis(np.sin(half), -1, 0)
    cos_roll, cos_pitch, cos_yaw = np.moveaxis(np.cos(half), -1, 0)
    return np.stack(
        (
            sin_roll * cos_pitch * cos_yaw - cos_roll * sin_pitch * sin_yaw,
            cos_roll * sin_pitch * cos_yaw + sin_roll * cos_pitch * sin_yaw,
            cos_roll * cos_pitch * sin_yaw - sin_roll * sin_pitch * cos_yaw,
            cos_roll * cos_pitch * cos_yaw + sin_roll * sin_pitch * sin_yaw,
        ),
        axis=-1,
    )


def quaternion_multiply(first: ArrayLike, second: ArrayLike) -> Array:
    """Return the rotation that applies `second`, then `first`: the product first * second.

    Args:
        first: shape (..., 4).
        second: shape (..., 4), broadcast against `first`.

    Returns:
        Shape (..., 4).
    """
    a, b = as_array(first, 4, "a quaternion"), as_array(second, 4, "a quaternion")
    ax, ay, az, aw = a[..., 0], a[..., 1], a[..., 2], a[..., 3]
    bx, by, bz, bw = b[..., 0], b[..., 1], b[..., 2], b[..., 3]
    product = np.empty(np.broadcast_shapes(a.shape, b.shape))
    product[..., 0] = aw * bx + ax * bw + ay * bz - az * by
    product[..., 1] = aw * by - ax * bz + ay * bw + az * bx
    product[..., 2] = aw * bz + ax * by - ay * bx + az * bw
    product[..., 3] = aw * bw - ax * bx - ay * by - az * bz
    return product


def quaternion_inverse(quaternion: ArrayLike) -> Array:
    """Return the inverse rotation, as quaternions of the same shape (..., 4)."""
    inverse: Array = as_array(quaternion, 4, "a quaternion") * np.array((-1.0, -1.0, -1.0, 1.0))
    return inverse


def rotate(quaternion: ArrayLike, vector: ArrayLike) -> Array:
    """Rotate vectors from the child frame into the parent frame.

    Args:
        quaternion: shape (..., 4).
        vector: shape (..., 3), broadcast against `quaternion`.

    Returns:
        Shape (..., 3).
    """
    q, v = as_array(quaternion, 4, "a quaternion"), as_array(vector, 3, "a vector")
    x, y, z, w = q[..., 0], q[..., 1], q[..., 2], q[..., 3]
    vx, vy, vz = v[..., 0], v[..., 1], v[..., 2]
    # v + 2 w (u x v) + 2 u x (u x v), where u is the vector part of the quaternion.
    tx, ty, tz = 2 * (y * vz - z * vy), 2 * (z * vx - x * vz), 2 * (x * vy - y * vx)
    rotated = np.empty((*np.broadcast_shapes(q.shape[:-1], v.shape[:-1]), 3))
    rotated[..., 0] = vx + w * tx + y * tz - z * ty
    rotated[..., 1] = vy + w * ty + z * tx - x * tz
    rotated[..., 2] = vz + w * tz + x * ty - y * tx
    return rotated


def transform_points(matrix: ArrayLike, points: ArrayLike) -> Array:
    """Return points, shape (n, 3), transformed by a homogeneous matrix, shape (4, 4).

    The sums are written out, so that the result has the same bits on every machine. A product of matrices adds in an
    order that depends on the processor.
    """
    m, p = np.asarray(matrix, dtype=np.float64), as_array(points, 3, "a point")
    x, y, z = p[:, 0], p[:, 1], p[:, 2]
    transformed = np.empty((len(p), 3))
    for axis in range(3):
        transformed[:, axis] = m[axis, 0] * x + m[axis, 1] * y + m[axis, 2] * z + m[axis, 3]
    return transformed


def slerp(first: ArrayLike, last: ArrayLike, ratios: ArrayLike) -> Array:
    """Interpolate rotations at constant speed along the shorter arc between two rotations.

    Args:
        first: the rotation at the start, shape (4,).
        last: the rotation at the end, shape (4,).
        ratios: fractions of the arc, 0 to 1, shape (n,).

    Returns:
        Shape (n, 4).
    """
    begin, end = as_array(first, 4, "a quaternion"), as_array(last, 4, "a quaternion")
    fractions = np.asarray(ratios)[:, np.newaxis]
    dot = float(np.dot(begin, end))
    if dot < 0.0:
        end, dot = -end, -dot
    if dot > _PARALLEL_DOT_PRODUCT:
        interpolated = begin + fractions * (end - begin)
    else:
        angle = np.arccos(dot)
        interpolated = (np.sin((1.0 - fractions) * angle) * begin + np.sin(fractions * angle) * end) / np.sin(angle)
    unit: Array = interpolated / np.linalg.norm(interpolated, axis=1, keepdims=True)
    return unit


def rotation_matrix(quaternion: ArrayLike) -> Array:
    """Convert rotations, of shape (..., 4), to matrices, of shape (..., 3, 3)."""
    x, y, z, w = np.moveaxis(as_array(quaternion, 4, "a quaternion"), -1, 0)
    matrix = np.empty((*x.shape, 3, 3))
    matrix[..., 0, 0] = 1 - 2 * (y * y + z * z)
    matrix[..., 0, 1] = 2 * (x * y - w * z)
    matrix[..., 0, 2] = 2 * (x * z + w * y)
    matrix[..., 1, 0] = 2 * (x * y + w * z)
    matrix[..., 1, 1] = 1 - 2 * (x * x + z * z)
    matrix[..., 1, 2] = 2 * (y * z - w * x)
    matrix[..., 2, 0] = 2 * (x * z - w * y)
    matrix[..., 2, 1] = 2 * (y * z + w * x)
    matrix[..., 2, 2] = 1 - 2 * (x * x + y * y)
    return matrix


def quaternion_from_matrix(matrix: ArrayLike) -> Array:
    """Convert rotation matrices, shape (..., 3, 3), to quaternions, shape (..., 4).

    The quaternions have w >= 0.

    Raises:
        ValueError: the shape is not (..., 3, 3).
    """
    m = np.asarray(matrix, dtype=np.float64)
    if m.shape[-2:] != (3, 3):
        raise ValueError(f"a rotation matrix must have the shape (..., 3, 3), not {m.shape}")
    xx, yy, zz = m[..., 0, 0], m[..., 1, 1], m[..., 2, 2]
    # The matrix gives four times the products of every two components. The row with the largest square is the best
    # conditioned.
    products = np.empty((*xx.shape, 4, 4))
    products[..., 0, 0] = 1 + xx - yy - zz
    products[..., 1, 1] = 1 - xx + yy - zz
    products[..., 2, 2] = 1 - xx - yy + zz
    products[..., 3, 3] = 1 + xx + yy + zz
    products[..., 0, 1] = products[..., 1, 0] = m[..., 0, 1] + m[..., 1, 0]
    products[..., 0, 2] = products[..., 2, 0] = m[..., 0, 2] + m[..., 2, 0]
    products[..., 1, 2] = products[..., 2, 1] = m[..., 1, 2] + m[..., 2, 1]
    products[..., 0, 3] = products[..., 3, 0] = m[..., 2, 1] - m[..., 1, 2]
    products[..., 1, 3] = products[..., 3, 1] = m[..., 0, 2] - m[..., 2, 0]
    products[..., 2, 3] = products[..., 3, 2] = m[..., 1, 0] - m[..., 0, 1]
    best = np.argmax(np.diagonal(products, axis1=-2, axis2=-1), axis=-1)
    row = np.take_along_axis(products, best[..., None, None], axis=-2)[..., 0, :]
    row = row / np.linalg.norm(row, axis=-1, keepdims=True)
    quaternion: Array = np.where(row[..., 3:] < 0, -row, row)
    return quaternion


def compose(b_in_a: ArrayLike, c_in_b: ArrayLike) -> Array:
    """Return the poses of frame C in frame A.

    Args:
        b_in_a: poses of frame B in frame A, shape (..., 7).
        c_in_b: poses of frame C in frame B, shape (..., 7), broadcast against `b_in_a`.

    Returns:
        Shape (..., 7).
    """
    a, b = as_array(b_in_a, 7, "a pose"), as_array(c_in_b, 7, "a pose")
    pose = np.empty(np.broadcast_shapes(a.shape, b.shape))
    pose[..., :3] = a[..., :3] + rotate(a[..., 3:], b[..., :3])
    pose[..., 3:] = quaternion_multiply(a[..., 3:], b[..., 3:])
    return pose


def invert(b_in_a: ArrayLike) -> Array:
    """Return the poses of frame A in frame B, given B in A, both of shape (..., 7)."""
    poses = as_array(b_in_a, 7, "a pose")
    inverse = quaternion_inverse(poses[..., 3:])
    return np.concatenate((-rotate(inverse, poses[..., :3]), inverse), axis=-1)


def row_from_pose(pose: Pose) -> Array:
    """Convert a description's pose to a row x, y, z, qx, qy, qz, qw, of shape (7,)."""
    return np.array((*pose.xyz, *pose_quaternion(pose)))


def matrix_from_pose(pose: ArrayLike) -> Array:
    """Convert poses, of shape (..., 7), to homogeneous matrices, of shape (..., 4, 4)."""
    poses = as_array(pose, 7, "a pose")
    matrix = np.zeros((*poses.shape[:-1], 4, 4))
    matrix[..., :3, :3] = rotation_matrix(poses[..., 3:])
    matrix[..., :3, 3] = poses[..., :3]
    matrix[..., 3, 3] = 1.0
    return matrix
