"""Points as messages."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from linkwright.messages import get_message

_FLOAT32 = 7
Points = np.ndarray[Any, np.dtype[Any]]


@cache
def _fields(*names_and_offsets: tuple[str, int]) -> tuple[Any, ...]:
    kind = get_message("sensor_msgs/msg/PointField")
    return tuple(kind(name=name, offset=offset, datatype=_FLOAT32, count=1) for name, offset in names_and_offsets)


def fill_lidar_cloud(message: Any, points: Points, intensities: Points, *, height: int = 1) -> None:
    """Put points, shape (n, 3), and their intensities, shape (n,), into a PointCloud2 of `height` rows."""
    rows = np.empty((len(points), 4), np.float32)
    rows[:, :3], rows[:, 3] = points, intensities
    message.fields = list(_fields(("x", 0), ("y", 4), ("z", 8), ("intensity", 12)))
    _fill(message, rows, height)
    message.is_dense = bool(np.isfinite(rows).all())


def fill_camera_cloud(message: Any, points: Points, colour: Points, *, swapped: bool = False) -> None:
    """Put the points of a picture, shape (height, width, 3), and their colours into a PointCloud2.

    With `swapped` red and blue change places, as Gazebo classic has them.

    Source of the layout: ``gazebo_ros_camera``, 32 bytes a point with the colour at 16.
    """
    height, width, _ = points.shape
    rows = np.zeros((height * width, 8), np.float32)
    rows[:, :3] = points.reshape(-1, 3)
    bytes_of = rows.view(np.uint8).reshape(height * width, 32)
    # As PCL packs them, blue is the lowest byte.
    bytes_of[:, 16:19] = colour.reshape(-1, 3)[:, :: 1 if swapped else -1]
    message.fields = list(_fields(("x", 0), ("y", 4), ("z", 8), ("rgb", 16)))
    _fill(message, rows, height)
    message.is_dense = False


def _fill(message: Any, rows: Points, height: int) -> None:
    message.height, message.width = height, len(rows) // max(height, 1)
    message.point_step = rows.shape[1] * 4
    message.row_step = message.point_step * message.width
    message.is_bigendian = False
    message.data = rows.view(np.uint8).reshape(-1)
