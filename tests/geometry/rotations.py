"""Rotations as the textbook has them, to compare with."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


def quaternion_about(axis: Sequence[float], angle: float) -> np.ndarray:
    """The rotation about an axis of any length by an angle; none about an axis of length zero. Shape (4,), x y z w."""
    length = np.linalg.norm(axis)
    if length == 0:
        return np.array((0.0, 0.0, 0.0, 1.0))
    return np.array((*(np.sin(angle / 2) * np.asarray(axis) / length), np.cos(angle / 2)))
