"""Points of a scanner that moves while it scans."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import rotate, slerp
from linkwright.viewer.clouds.points import Points


def swept(points: Points, parts: NDArray[Any], first: NDArray[np.float64], last: NDArray[np.float64]) -> Points:
    """Points that were seen on the way from one pose to another, in the frame that the poses are in.

    Args:
        points: in the moving frame.
        parts: of the way, 0 to 1, on which each point was seen; shape (N,).
        first: pose at the beginning, x y z qx qy qz qw.
        last: pose at the end.
    """
    turned = rotate(slerp(first[3:], last[3:], parts), points.positions)
    moved = turned + first[:3] + parts[:, np.newaxis] * (last[:3] - first[:3])
    return Points(moved.astype(np.float32), points.channels)
