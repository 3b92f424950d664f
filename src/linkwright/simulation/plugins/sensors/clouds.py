"""Fills ``sensor_msgs/msg/PointCloud2`` messages with the points of lidars and depth cameras."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from linkwright.messages import get_message

_NUMBERS = {np.dtype(np.uint16): 4, np.dtype(np.float32): 7}
"""The types of sensor_msgs/msg/PointField by those of numpy."""
Points = np.ndarray[Any, np.dtype[Any]]


def _layout(size: int, **offsets: int) -> np.dtype[Any]:
    kinds = [np.uint16 if name == "ring" else np.float32 for name in offsets]
    return np.dtype({"names": [*offsets], "formats": kinds, "offsets": [*offsets.values()], "itemsize": size})


CLASSIC = _layout(16, x=0, y=4, z=8, intensity=12)
"""A point of ``gazebo_ros_ray_sensor``."""
VELODYNE = _layout(22, x=0, y=4, z=8, intensity=12, ring=16, time=18)
"""A point of velodyne_simulator, as velodyne_pointcloud has it; all points of a turn have time 0."""
GZ = _layout(32, x=0, y=4, z=8, intensity=16, ring=24)
"""A point of gz-sensors, each field at a multiple of 8 bytes."""
_COLOURED = _layout(32, x=0, y=4, z=8, rgb=16)


@cache
def _fields(layout: np.dtype[Any]) -> tuple[Any, ...]:
    kind = get_message("sensor_msgs/msg/PointField")
    places = {name: layout.fields[name] for name in layout.names or ()} if layout.fields else {}
    return tuple(
        kind(name=name, offset=offset, datatype=_NUMBERS[number], count=1)
        for name, (number, offset, *_) in places.items()
    )


def fill_lidar_cloud(
    message: Any,
    points: Points,
    intensities: Points,
    rings: Points | None = None,
    *,
    layout: np.dtype[Any] = CLASSIC,
    height: int = 1,
) -> None:
    """Fill a PointCloud2 with a lidar's measurement.

    Args:
        message: the PointCloud2.
        points: the points in m, shape (n, 3).
        intensities: the intensities, shape (n,).
        rings: for layouts with rings, the index of the laser that measured each point, 0 for the lowest, shape (n,).
        layout: the layout of a point.
        height: the number of rows.
    """
    rows = np.zeros(len(points), layout)
    rows["x"], rows["y"], rows["z"] = points.T
    rows["intensity"] = intensities
    if rings is not None:
        rows["ring"] = rings
    _fill(message, rows, height)
    message.is_dense = bool(np.isfinite(points).all() and np.isfinite(intensities).all())


def fill_camera_cloud(message: Any, points: Points, colour: Points, *, swapped: bool = False) -> None:
    """Fill a PointCloud2 with the points of an image, shape (height, width, 3), and their colours.

    With `swapped`, red and blue are exchanged as in Gazebo classic.

    Source of the layout: ``gazebo_ros_camera``, 32 bytes per point with the colour at byte 16.
    """
    height, width, _ = points.shape
    rows = np.zeros((height * width, 8), np.float32)
    rows[:, :3] = points.reshape(-1, 3)
    bytes_of = rows.view(np.uint8).reshape(height * width, 32)
    # PCL stores blue in the lowest byte.
    bytes_of[:, 16:19] = colour.reshape(-1, 3)[:, :: 1 if swapped else -1]
    _fill(message, rows.view(_COLOURED).reshape(-1), height)
    message.is_dense = False


def _fill(message: Any, rows: Points, height: int) -> None:
    """Fill a PointCloud2 with points of a structured type, shape (n,), arranged in `height` rows."""
    message.fields = list(_fields(rows.dtype))
    message.height, message.width = height, len(rows) // max(height, 1)
    message.point_step = rows.dtype.itemsize
    message.row_step = message.point_step * message.width
    message.is_bigendian = False
    message.data = rows.view(np.uint8).reshape(-1)
