"""Distance fields: grids of the distance from the nearest marked cell."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.grids.library import load_scipy


def distance_field(is_marked: NDArray[np.bool_], resolution: float) -> NDArray[np.float64]:
    """Return the distance of each cell from the nearest marked cell, between the cells' centers.

    Args:
        is_marked: the mask of marked cells, of shape (rows, columns).
        resolution: the side of a cell, in meters.

    Returns:
        Distances in meters, of the same shape; 0 in marked cells, infinite if no cell is marked.

    Raises:
        LinkwrightError: NAV101, SciPy is not installed.
    """
    if not is_marked.any():
        return np.full(is_marked.shape, np.inf)
    distances: NDArray[np.float64] = load_scipy("ndimage").distance_transform_edt(~is_marked)
    distances *= resolution
    return distances
