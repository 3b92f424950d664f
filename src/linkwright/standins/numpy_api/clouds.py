"""Conversion of point clouds (API of ``ros2_numpy.point_cloud2``).

ros2_numpy has two forms of a cloud. Up to Foxy it is a structured array with the fields of the message. Since Humble it
is a dictionary of ``xyz``, shape (n, 3), ``rgb``, shape (n, 3), and ``intensity``, shape (n, 1). Programs exist for
both, so a cloud here is a structured array that also has the keys of the dictionary.
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.messages import get_message
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.standins.numpy_api.registry import converts_from_numpy, converts_to_numpy

_PointCloud2 = get_message("sensor_msgs/msg/PointCloud2")
_PointField = get_message("sensor_msgs/msg/PointField")

DUMMY_FIELD_PREFIX = "__"
"""The prefix of the names of the gaps between fields."""

type_mappings = [
    (datatype, np.dtype(name))
    for datatype, name in enumerate(("int8", "uint8", "int16", "uint16", "int32", "uint32", "float32", "float64"), 1)
]
pftype_to_nptype = dict(type_mappings)
nptype_to_pftype = {dtype: datatype for datatype, dtype in type_mappings}
pftype_sizes = {datatype: dtype.itemsize for datatype, dtype in type_mappings}

_XYZ, _RGB, _INTENSITY = "xyz", "rgb", "intensity"
_COLORS = ("r", "g", "b")


class CloudArray(np.ndarray[Any, Any]):
    """A structured array of points that also has the keys of ros2_numpy's dictionary.

    ``cloud["xyz"]`` has the shape (n, 3). ``cloud["rgb"]`` has red, green and blue of each point instead of the packed
    number. ``cloud["intensity"]`` is the field.
    """

    def __getitem__(self, key: Any) -> Any:
        """Return a field, points, or the value of one of the keys of the dictionary."""
        points = self.view(np.ndarray)
        names = self.dtype.names or ()
        if isinstance(key, str):
            if key == _XYZ and _XYZ not in names and set(_XYZ) <= set(names):
                return get_xyz_points(points.reshape(-1), remove_nans=False, dtype=np.float32)
            if key == _RGB and _RGB in names:
                packed = np.ascontiguousarray(points[_RGB]).reshape(-1).view(np.uint32)
                return np.stack([(packed >> shift & 255).astype(np.uint8) for shift in (16, 8, 0)], axis=-1)
            return points[key]
        return super().__getitem__(key)

    def keys(self) -> list[str]:
        """Return the keys of the dictionary that a program may ask for."""
        names = self.dtype.names or ()
        return [key for key in (_XYZ, _RGB, _INTENSITY) if (set(_XYZ) if key == _XYZ else {key}) <= set(names)]

    def items(self) -> Iterator[tuple[str, Any]]:
        """Yield each key with its value."""
        return ((key, self[key]) for key in self.keys())

    def values(self) -> Iterator[Any]:
        """Yield the value of each key."""
        return (self[key] for key in self.keys())

    def get(self, key: str, default: Any = None) -> Any:
        """Return the value of a key or field, or a default value."""
        try:
            return self[key]
        except (KeyError, ValueError):
            return default

    def __contains__(self, key: object) -> bool:
        """Return whether the cloud has a key or field."""
        if isinstance(key, str):
            return key in self.keys() or key in (self.dtype.names or ())
        return bool(super().__contains__(key))


@converts_to_numpy(_PointField, plural=True)
def fields_to_dtype(fields: Iterable[Any], point_step: int) -> list[Any]:
    """Return the description of a structured numpy type, with a field of one byte for each byte of a gap.

    Args:
        fields: the fields of a point (sensor_msgs/msg/PointField).
        point_step: the distance between two points, in bytes.
    """
    description: list[Any] = []
    offset = 0

    def fill_gap(end: int) -> None:
        description.extend((f"{DUMMY_FIELD_PREFIX}{position}", np.uint8) for position in range(offset, end))

    for field in sorted(fields, key=lambda field: int(field.offset)):
        fill_gap(field.offset)
        dtype: Any = pftype_to_nptype[field.datatype]
        description.append((field.name, dtype if field.count == 1 else np.dtype((dtype, field.count))))
        offset = field.offset + dtype.itemsize * field.count
    fill_gap(point_step)
    return description


@converts_from_numpy(_PointField, plural=True)
def dtype_to_fields(dtype: np.dtype[Any]) -> list[Any]:
    """Return the fields of a point (sensor_msgs/msg/PointField) of a structured numpy type."""
    fields = []
    for name, (field_type, offset, *_) in (dtype.fields or {}).items():
        count = int(np.prod(field_type.shape))
        datatype = nptype_to_pftype[field_type.base.newbyteorder("=")]
        fields.append(_PointField(name=name, offset=offset, datatype=datatype, count=count))
    return fields


@converts_to_numpy(_PointCloud2)
def pointcloud2_to_array(cloud_msg: Any, squeeze: bool = True) -> CloudArray:
    """Return the points of a cloud.

    Args:
        cloud_msg: the point cloud (sensor_msgs/msg/PointCloud2).
        squeeze: whether an unorganized cloud gives a one-dimensional array.

    Returns:
        array, shape (width,) or (height, width).
    """
    dtype = _make_dtype(cloud_msg)
    shape = (cloud_msg.height, cloud_msg.width)
    step = cloud_msg.row_step or dtype.itemsize * cloud_msg.width
    points: NDArray[Any] = np.ndarray(shape, dtype, cloud_msg.data, strides=(step, dtype.itemsize))
    if squeeze and cloud_msg.height == 1:
        points = points.reshape(cloud_msg.width)
    return points.view(CloudArray)


point_cloud2_to_array = pointcloud2_to_array


def array_to_pointcloud2(cloud_arr: NDArray[Any], stamp: Any = None, frame_id: str | None = None) -> Any:
    """Return the point cloud (sensor_msgs/msg/PointCloud2) of a structured array.

    Args:
        cloud_arr: structured array, shape (width,) or (height, width).
        stamp: the time of the cloud (builtin_interfaces/msg/Time).
        frame_id: the frame of the cloud.
    """
    points = np.atleast_2d(cloud_arr.view(np.ndarray))
    names = points.dtype.names or ()
    cloud = _PointCloud2(height=points.shape[0], width=points.shape[1], is_bigendian=False)
    if stamp is not None:
        cloud.header.stamp = stamp
    if frame_id is not None:
        cloud.header.frame_id = frame_id
    cloud.fields = dtype_to_fields(points.dtype)
    cloud.point_step = points.dtype.itemsize
    cloud.row_step = cloud.point_step * points.shape[1]
    cloud.is_dense = all(bool(np.isfinite(points[name]).all()) for name in names)
    cloud.data = points.astype(points.dtype.newbyteorder("<"), copy=False).tobytes()
    return cloud


@converts_from_numpy(_PointCloud2)
def array_to_point_cloud2(
    np_array: NDArray[Any] | Mapping[str, Any], frame_id: str | None = None, stamp: Any = None
) -> Any:
    """Return the point cloud (sensor_msgs/msg/PointCloud2) of a dictionary or a structured array.

    Args:
        np_array: a structured array as for `array_to_pointcloud2`, or a dictionary with ``xyz``, shape (n, 3), and
            optionally ``rgb``, shape (n, 3), 0 to 255, and ``intensity``, shape (n,) or (n, 1).
        frame_id: the frame of the cloud; of a dictionary, ``base_link`` if it is None.
        stamp: the time of the cloud (builtin_interfaces/msg/Time); of a dictionary, the time of the computer if it is
            None.
    """
    if isinstance(np_array, np.ndarray):
        return array_to_pointcloud2(np_array, stamp, frame_id)
    xyz = np.asarray(np_array[_XYZ], np.float32)
    colors, intensity = np_array.get(_RGB), np_array.get(_INTENSITY)
    dtype: list[Any] = [(name, np.float32) for name in _XYZ]
    if colors is not None:
        dtype.append((_RGB, np.uint32))
    if intensity is not None:
        intensity = np.asarray(intensity).reshape(-1)
        dtype.append((_INTENSITY, intensity.dtype if intensity.dtype in nptype_to_pftype else np.float32))
    points = np.zeros(len(xyz), dtype)
    for column, name in enumerate(_XYZ):
        points[name] = xyz[:, column]
    if colors is not None:
        points[_RGB] = _pack_colors(*np.asarray(colors).T[:3])
    if intensity is not None:
        points[_INTENSITY] = intensity
    if stamp is None:
        seconds, nanoseconds = divmod(time.time_ns(), NANOSECONDS_PER_SECOND)
        stamp = get_message("builtin_interfaces/msg/Time")(sec=seconds, nanosec=nanoseconds)
    return array_to_pointcloud2(points, stamp, "base_link" if frame_id is None else frame_id)


def merge_rgb_fields(cloud_arr: NDArray[Any]) -> NDArray[Any]:
    """Return the points with one field ``rgb`` (float32, as in PCL) in place of ``r``, ``g`` and ``b`` (uint8)."""
    points = cloud_arr.view(np.ndarray)
    packed = _pack_colors(*(points[name] for name in _COLORS))
    kept = [name for name in points.dtype.names or () if name not in _COLORS]
    merged = _copy_fields(points, kept, [(_RGB, np.float32)])
    merged[_RGB] = packed.view(np.float32)
    return merged


def split_rgb_field(cloud_arr: NDArray[Any]) -> NDArray[Any]:
    """Return the points with the fields ``r``, ``g`` and ``b`` (uint8) in place of ``rgb`` (float32, as in PCL)."""
    points = cloud_arr.view(np.ndarray)
    packed = np.ascontiguousarray(points[_RGB]).view(np.uint32)
    kept = [name for name in points.dtype.names or () if name != _RGB]
    split = _copy_fields(points, kept, [(name, np.uint8) for name in _COLORS])
    for name, shift in zip(_COLORS, (16, 8, 0), strict=True):
        split[name] = packed >> shift & 255
    return split


def get_xyz_points(cloud_array: NDArray[Any], remove_nans: bool = True, dtype: Any = float) -> NDArray[Any]:
    """Return the coordinates of points.

    Args:
        cloud_array: structured array with the fields ``x``, ``y`` and ``z``.
        remove_nans: whether to leave out points with coordinates that are not finite; the result is then (n, 3).
        dtype: the numpy type of the result.

    Returns:
        array, shape (..., 3).
    """
    points = cloud_array.view(np.ndarray)
    if remove_nans:
        points = points[np.logical_and.reduce([np.isfinite(points[name]) for name in _XYZ])]
    return np.stack([points[name] for name in _XYZ], axis=-1).astype(dtype)


def pointcloud2_to_xyz_array(cloud_msg: Any, remove_nans: bool = True) -> NDArray[Any]:
    """Return the coordinates of the points of a cloud. See `get_xyz_points`."""
    return get_xyz_points(pointcloud2_to_array(cloud_msg), remove_nans=remove_nans)


def _make_dtype(cloud: Any) -> np.dtype[Any]:
    """Return the structured numpy type of the points of a cloud, in whose gaps there are no fields."""
    layout: Any = {
        "names": [field.name for field in cloud.fields],
        "formats": [
            pftype_to_nptype[field.datatype] if field.count == 1 else (pftype_to_nptype[field.datatype], field.count)
            for field in cloud.fields
        ],
        "offsets": [field.offset for field in cloud.fields],
        "itemsize": cloud.point_step,
    }
    dtype: np.dtype[Any] = np.dtype(layout).newbyteorder(">" if cloud.is_bigendian else "<")
    return dtype


def _pack_colors(red: Any, green: Any, blue: Any) -> NDArray[np.uint32]:
    red, green, blue = (np.asarray(channel, np.uint32) for channel in (red, green, blue))
    return np.asarray(red << 16 | green << 8 | blue, np.uint32)


def _copy_fields(points: NDArray[Any], names: Sequence[str], added: list[Any]) -> NDArray[Any]:
    """Return an array with these fields of points, and with further fields that are zero."""
    copied = np.zeros(points.shape, [*((name, points.dtype[name]) for name in names), *added])
    for name in names:
        copied[name] = points[name]
    return copied
