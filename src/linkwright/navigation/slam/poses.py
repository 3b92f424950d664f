"""Poses in the plane, as arrays (x, y, yaw) of shape (3,) or (..., 3).

Units are meters and radians.
"""

from __future__ import annotations

from math import pi

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


def wrap_angles(angles: FloatArray) -> FloatArray:
    """Return angles wrapped to -pi to pi."""
    result: FloatArray = (angles + pi) % (2 * pi) - pi
    return result


def compose(b_in_a: FloatArray, c_in_b: FloatArray) -> FloatArray:
    """Return the poses of c in a, of shape (..., 3), from the poses of b in a and of c in b."""
    cos, sin = np.cos(b_in_a[..., 2]), np.sin(b_in_a[..., 2])
    x, y = c_in_b[..., 0], c_in_b[..., 1]
    yaw = wrap_angles(b_in_a[..., 2] + c_in_b[..., 2])
    result: FloatArray = np.stack(
        (b_in_a[..., 0] + cos * x - sin * y, b_in_a[..., 1] + sin * x + cos * y, yaw), axis=-1
    )
    return result


def inverse(b_in_a: FloatArray) -> FloatArray:
    """Return the poses of a in b, of shape (..., 3), from the poses of b in a."""
    cos, sin = np.cos(b_in_a[..., 2]), np.sin(b_in_a[..., 2])
    x, y = b_in_a[..., 0], b_in_a[..., 1]
    result: FloatArray = np.stack((-cos * x - sin * y, sin * x - cos * y, -b_in_a[..., 2]), axis=-1)
    return result


def relative_pose(b_in_a: FloatArray, c_in_a: FloatArray) -> FloatArray:
    """Return the poses of c in b, of shape (..., 3), from the poses of b in a and of c in a."""
    return compose(inverse(b_in_a), c_in_a)


def transform_points(pose: FloatArray, points: FloatArray) -> FloatArray:
    """Transform points from the frame at `pose` to the parent frame of `pose`.

    Args:
        pose: the pose of the points' frame, shape (3,).
        points: shape (n, 2).
    """
    cos, sin = np.cos(pose[2]), np.sin(pose[2])
    result: FloatArray = points @ np.array(((cos, sin), (-sin, cos))) + pose[:2]
    return result
