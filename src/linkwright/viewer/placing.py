"""Points and poses taken from a frame to the Fixed Frame, many at once."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray


def rotation_matrix(pose: NDArray[Any]) -> NDArray[np.float64]:
    """The rotation of a pose x, y, z, qx, qy, qz, qw; shape (3, 3). The quaternion need not be of length one."""
    x, y, z, w = (float(each) for each in pose[3:7])
    norm = x * x + y * y + z * z + w * w
    s = 2.0 / norm if norm > 0.0 else 0.0
    return np.array(
        [
            [1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)],
            [s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w)],
            [s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y)],
        ]
    )


def placed(pose: NDArray[Any], points: NDArray[Any]) -> NDArray[Any]:
    """Points given in the frame of a pose, in the frame that the pose is in.

    Args:
        pose: shape (7,).
        points: shape (3,) or (N, 3), metres.

    Returns:
        An array like `points`.
    """
    moved: NDArray[Any] = points @ rotation_matrix(pose).T + np.asarray(pose[:3], dtype=np.float64)
    return moved
