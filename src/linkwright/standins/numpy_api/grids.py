"""Conversion of occupancy grids (API of ``ros2_numpy.occupancy_grid``)."""

from __future__ import annotations

from typing import Any

import numpy as np

from linkwright.messages import get_message
from linkwright.standins.numpy_api.registry import converts_from_numpy, converts_to_numpy

_OccupancyGrid = get_message("nav_msgs/msg/OccupancyGrid")
_UNKNOWN = -1


@converts_to_numpy(_OccupancyGrid)
def occupancygrid_to_numpy(msg: Any) -> Any:
    """Return the cells of a nav_msgs/msg/OccupancyGrid as a masked array, shape (height, width).

    Unknown cells (-1) are masked.
    """
    cells = np.asarray(msg.data, dtype=np.int8).reshape(msg.info.height, msg.info.width)
    masked_array: Any = np.ma.MaskedArray
    return masked_array(cells, mask=cells == _UNKNOWN, fill_value=_UNKNOWN)


@converts_from_numpy(_OccupancyGrid)
def numpy_to_occupancy_grid(arr: Any, info: Any = None) -> Any:
    """Return a nav_msgs/msg/OccupancyGrid.

    Args:
        arr: array of int8, shape (height, width). Of a masked array, the values below the mask must be -1.
        info: resolution and origin of the map (nav_msgs/msg/MapMetaData), whose width and height are set; None for
            zeros.

    Raises:
        TypeError: the array has another shape or type.
    """
    if arr.ndim != 2:
        raise TypeError("Array must be 2D")
    if arr.dtype != np.int8:
        raise TypeError("Array must be of int8s")
    grid = _OccupancyGrid()
    if info is not None:
        grid.info = info
    grid.info.height, grid.info.width = arr.shape
    grid.data = np.asarray(arr).ravel()
    return grid
