"""Poses as rows x y z qx qy qz qw: a child frame in its parent frame, metres and a unit quaternion.

All functions are vectorised over leading axes and broadcast.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from linkwright.kinematics.quaternions import (
    Array,
    last_axis,
    quaternion_inverse,
    quaternion_multiply,
    rotate,
    rotation_matrix,
)

IDENTITY: Array = np.array((0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0))
IDENTITY.flags.writeable = False


def compose(parent: ArrayLike, child: ArrayLike) -> Array:
    """The pose of C in A, from those of B in A and of C in B.

    Args:
        parent: B in A, shape (..., 7).
        child: C in B, shape (..., 7), broadcast against it.

    Returns:
        Shape (..., 7).
    """
    a, b = last_axis(parent, 7, "a pose"), last_axis(child, 7, "a pose")
    pose = np.empty(np.broadcast_shapes(a.shape, b.shape))
    pose[..., :3] = a[..., :3] + rotate(a[..., 3:], b[..., :3])
    pose[..., 3:] = quaternion_multiply(a[..., 3:], b[..., 3:])
    return pose


def invert(pose: ArrayLike) -> Array:
    """The pose of A in B, from that of B in A; shape (..., 7) to (..., 7)."""
    given = last_axis(pose, 7, "a pose")
    back = quaternion_inverse(given[..., 3:])
    return np.concatenate((-rotate(back, given[..., :3]), back), axis=-1)


def matrix_from_pose(pose: ArrayLike) -> Array:
    """Homogeneous matrices; shape (..., 7) to (..., 4, 4)."""
    given = last_axis(pose, 7, "a pose")
    matrix = np.zeros((*given.shape[:-1], 4, 4))
    matrix[..., :3, :3] = rotation_matrix(given[..., 3:])
    matrix[..., :3, 3] = given[..., :3]
    matrix[..., 3, 3] = 1.0
    return matrix
