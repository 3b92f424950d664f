"""Conversion between grids and nav_msgs/OccupancyGrid messages."""

from __future__ import annotations

from array import array
from typing import Any

import numpy as np

from linkwright.geometry.single import quaternion_from_rpy, rpy_from_quaternion
from linkwright.messages import get_message
from linkwright.navigation.grids.grid import Grid


class BadGridError(ValueError):
    """Raised when a message is not a valid grid.

    The error's message gives the reason.
    """


def occupancy_message(grid: Grid, frame: str, stamp: Any) -> Any:
    """Convert a grid to a nav_msgs/OccupancyGrid.

    Args:
        grid: the grid; its cells are percent or `UNKNOWN`.
        frame: the frame of the grid.
        stamp: the builtin_interfaces/Time for the stamp and the load time of the map.
    """
    message = get_message("nav_msgs/msg/OccupancyGrid")()
    message.header.frame_id = frame
    message.header.stamp = stamp
    message.info.map_load_time = stamp
    message.info.resolution = grid.resolution
    message.info.width, message.info.height = grid.columns, grid.rows
    position, orientation = message.info.origin.position, message.info.origin.orientation
    position.x, position.y = float(grid.x), float(grid.y)
    orientation.x, orientation.y, orientation.z, orientation.w = quaternion_from_rpy((0.0, 0.0, float(grid.yaw)))
    message.data = array("b", np.ascontiguousarray(grid.cells, dtype=np.int8).tobytes())
    return message


def grid_from_message(message: Any) -> Grid:
    """Convert a nav_msgs/OccupancyGrid to a grid with a copy of its int8 cells.

    Raises:
        BadGridError: the message has no cells, no resolution, or a number of cells that does not match its size.
    """
    info = message.info
    cells = np.array(np.frombuffer(message.data, np.int8))
    if not info.width or not info.height or cells.size != info.width * info.height:
        raise BadGridError(f"width = {info.width}, height = {info.height}, data size = {cells.size}")
    if not 0.0 < info.resolution < float("inf"):
        raise BadGridError(f"resolution = {info.resolution:g}")
    orientation = info.origin.orientation
    return Grid(
        cells=cells.reshape(info.height, info.width),
        resolution=float(str(np.float32(info.resolution))),  # The float32 field stores 0.05 as 0.0500000007.
        x=info.origin.position.x,
        y=info.origin.position.y,
        yaw=rpy_from_quaternion((orientation.x, orientation.y, orientation.z, orientation.w))[2],
    )
