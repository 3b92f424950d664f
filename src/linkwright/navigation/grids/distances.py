"""Distance fields: the distance of each cell from the nearest marked one."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.grids.library import load_scipy


def distance_field(marked: NDArray[np.bool_], resolution: float, limit: float = np.inf) -> NDArray[np.float64]:
    """The distances of cells from the nearest marked one, from middle to middle.

    Args:
        marked: which cells count, of shape (rows, columns).
        resolution: side of a cell, in metres.
        limit: the most that is told, and what is told where none is marked, in metres.

    Returns:
        Metres, of the same shape, 0 in marked cells.

    Raises:
        LinkwrightError: NAV101, SciPy is not installed.
    """
    if not marked.any():
        return np.full(marked.shape, limit)
    distances: NDArray[np.float64] = load_scipy("ndimage").distance_transform_edt(~marked)
    distances *= resolution
    return np.minimum(distances, limit, out=distances)
