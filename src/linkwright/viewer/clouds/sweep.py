"""Points of a scanner that moves while it scans."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.viewer.clouds.points import Points

_PARALLEL = 0.9995
"""Quaternions whose dot product is larger than this are mixed in a straight line."""


def swept(points: Points, parts: NDArray[Any], first: NDArray[np.float64], last: NDArray[np.float64]) -> Points:
    """Points that were seen on the way from one pose to another, in the frame that the poses are in.

    Args:
        points: in the moving frame.
        parts: of the way, 0 to 1, on which each point was seen; shape (N,).
        first: pose at the beginning, x y z qx qy qz qw.
        last: pose at the end.
    """
    parts = parts[:, np.newaxis]
    turns = _between(first[3:], last[3:], parts)
    axis, angle = turns[:, :3], turns[:, 3:]
    seen = points.positions.astype(np.float64)
    turned = seen + 2.0 * np.cross(axis, np.cross(axis, seen) + angle * seen)
    moved = turned + first[:3] + parts * (last[:3] - first[:3])
    return Points(moved.astype(np.float32), points.channels)


def _between(first: NDArray[Any], last: NDArray[Any], parts: NDArray[Any]) -> NDArray[Any]:
    """Unit quaternions on the shorter way from one to another; shape (N, 4)."""
    dot = float(np.dot(first, last))
    if dot < 0.0:
        last, dot = -last, -dot
    if dot > _PARALLEL:
        mixed = first + parts * (last - first)
    else:
        angle = np.arccos(dot)
        mixed = (np.sin((1.0 - parts) * angle) * first + np.sin(parts * angle) * last) / np.sin(angle)
    unit: NDArray[Any] = mixed / np.linalg.norm(mixed, axis=1, keepdims=True)
    return unit
