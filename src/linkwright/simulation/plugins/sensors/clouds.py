"""``sensor_msgs/msg/PointCloud2`` messages with the points of lidars and depth cameras."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from linkwright.messages import get_message

_FIELD_TYPES = {np.dtype(np.uint16): 4, np.dtype(np.float32): 7}
"""The data types of sensor_msgs/msg/PointField, by NumPy type."""
_INTEGER_FIELDS = ("ring", "tag", "line")
AnyArray = np.ndarray[Any, np.dtype[Any]]


def _create_layout(size: int, **offsets: int) -> np.dtype[Any]:
    formats = [np.uint16 if name in _INTEGER_FIELDS else np.float32 for name in offsets]
    return np.dtype({"names": [*offsets], "formats": formats, "offsets": [*offsets.values()], "itemsize": size})


CLASSIC_LAYOUT = _create_layout(16, x=0, y=4, z=8, intensity=12)
"""The layout of a point of ``gazebo_ros_ray_sensor``."""
VELODYNE_LAYOUT = _create_layout(22, x=0, y=4, z=8, intensity=12, ring=16, time=18)
"""The layout of a point of velodyne_simulator, as in velodyne_pointcloud. All points of a revolution have time 0."""
GZ_LAYOUT = _create_layout(32, x=0, y=4, z=8, intensity=16, ring=24)
"""The layout of a point of gz-sensors. The fields after x, y and z start at multiples of 8 bytes."""
LIVOX_LAYOUT = _create_layout(20, x=0, y=4, z=8, intensity=12, tag=16, line=18)
"""The layout of a point of livox_laser_simulation for ROS 2. Tags and lines are 0."""
_COLORED_LAYOUT = _create_layout(32, x=0, y=4, z=8, rgb=16)


@cache
def _create_fields(layout: np.dtype[Any]) -> tuple[Any, ...]:
    field_class = get_message("sensor_msgs/msg/PointField")
    layout_fields = {name: layout.fields[name] for name in layout.names or ()} if layout.fields else {}
    return tuple(
        field_class(name=name, offset=offset, datatype=_FIELD_TYPES[dtype], count=1)
        for name, (dtype, offset, *_) in layout_fields.items()
    )


def fill_lidar_cloud(
    message: Any,
    points: AnyArray,
    intensities: AnyArray,
    rings: AnyArray | None = None,
    *,
    layout: np.dtype[Any] = CLASSIC_LAYOUT,
    height: int = 1,
) -> None:
    """Fill a PointCloud2 with a lidar's measurement.

    Args:
        message: the PointCloud2.
        points: the points in m, shape (n, 3).
        intensities: the intensities, shape (n,).
        rings: the index of the laser that measured each point, 0 for the lowest, shape (n,); None for a layout
            without rings.
        layout: the layout of a point.
        height: the number of rows of the cloud.
    """
    records = np.zeros(len(points), layout)
    records["x"], records["y"], records["z"] = points.T
    records["intensity"] = intensities
    if rings is not None:
        records["ring"] = rings
    _fill_cloud(message, records, height)
    message.is_dense = bool(np.isfinite(points).all() and np.isfinite(intensities).all())


def fill_camera_cloud(message: Any, points: AnyArray, color: AnyArray, *, swap_red_blue: bool = False) -> None:
    """Fill a PointCloud2 with the points of an image and their colors.

    `points` are in m, and `color` contains RGB bytes, both of shape (height, width, 3).

    With `swap_red_blue`, red and blue are exchanged as in Gazebo classic.

    Each point has 32 bytes with the color at byte 16, as in ``gazebo_ros_camera``.
    """
    height, width, _ = points.shape
    records = np.zeros((height * width, 8), np.float32)
    records[:, :3] = points.reshape(-1, 3)
    record_bytes = records.view(np.uint8).reshape(height * width, 32)
    # PCL stores blue in the lowest byte.
    record_bytes[:, 16:19] = color.reshape(-1, 3)[:, :: 1 if swap_red_blue else -1]
    _fill_cloud(message, records.view(_COLORED_LAYOUT).reshape(-1), height)
    message.is_dense = False


def _fill_cloud(message: Any, rows: AnyArray, height: int) -> None:
    """Fill a PointCloud2 with points of a structured NumPy type, in `height` rows.

    The points have shape (n,).
    """
    message.fields = list(_create_fields(rows.dtype))
    message.height, message.width = height, len(rows) // max(height, 1)
    message.point_step = rows.dtype.itemsize
    message.row_step = message.point_step * message.width
    message.is_bigendian = False
    message.data = rows.view(np.uint8).reshape(-1)
