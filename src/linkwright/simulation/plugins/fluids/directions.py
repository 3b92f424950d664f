"""Directions of vectors that may be zero."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from linkwright.geometry.arrays import Array


def normalize(vector: ArrayLike) -> Array:
    """Return a vector's direction, or zero for a zero vector."""
    components = np.asarray(vector, np.float64)
    length = float(np.linalg.norm(components))
    return components / length if length > 0.0 else components
