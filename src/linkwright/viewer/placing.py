"""How poses that messages gave turn what is in their frames."""

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
