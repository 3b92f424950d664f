"""Rotations by textbook formulas, for comparison."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


def quaternion_about(axis: Sequence[float], angle: float) -> np.ndarray:
    """Return the rotation about an axis by an angle, or none for an axis of length zero.

    Shape (4,), x y z w.
    """
    length = np.linalg.norm(axis)
    if length == 0:
        return np.array((0.0, 0.0, 0.0, 1.0))
    return np.array((*(np.sin(angle / 2) * np.asarray(axis) / length), np.cos(angle / 2)))
