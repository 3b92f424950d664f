"""Conversion between point clouds and arrays (API of ``sensor_msgs_py.point_cloud2``)."""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.lib.recfunctions import structured_to_unstructured, unstructured_to_structured
from numpy.typing import NDArray

from linkwright.messages import get_message

_NUMPY_TYPES = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 8: "f8"}
"""numpy's type names by the datatype constants of sensor_msgs/msg/PointField."""

_FLOAT32 = 7


def dtype_from_fields(
    fields: Iterable[Any], point_step: int | None = None, *, is_bigendian: bool = False
) -> np.dtype[Any]:
    """Return the structured numpy type for one point.

    Args:
        fields: the fields of a point (sensor_msgs/msg/PointField); a field with count n > 1 becomes n fields.
        point_step: the distance between two points, in bytes; None for the size of the fields.
        is_bigendian: whether numbers are big-endian.
    """
    order = ">" if is_bigendian else "<"
    names, formats, offsets = [], [], []
    for index, field in enumerate(fields):
        format_ = np.dtype(order + _NUMPY_TYPES[field.datatype])
        name = field.name or f"unnamed_field_{index}"
        for component in range(field.count):
            names.append(name if field.count == 1 else f"{name}_{component}")
            formats.append(format_)
            offsets.append(field.offset + component * format_.itemsize)
    layout: Any = {"names": names, "formats": formats, "offsets": offsets}
    if point_step is not None:
        layout["itemsize"] = point_step
    dtype: np.dtype[Any] = np.dtype(layout)
    return dtype


def read_points(
    cloud: Any,
    field_names: Sequence[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[Any] | None = None,
    reshape_organized_cloud: bool = False,
) -> NDArray[Any]:
    """Return the points of a cloud as a structured array.

    Args:
        cloud: the point cloud (sensor_msgs/msg/PointCloud2).
        field_names: the fields to read; None for all.
        skip_nans: whether to skip points with NaN in one of the fields.
        uvs: the points to read, as indices or as pairs of column and row; None for all.
        reshape_organized_cloud: whether to return an array of shape (width, height) for an organized cloud.

    Raises:
        AssertionError: the cloud lacks one of the fields.
    """
    dtype = dtype_from_fields(cloud.fields, cloud.point_step, is_bigendian=cloud.is_bigendian)
    points: NDArray[Any] = _to_flat_points(cloud, dtype)
    if field_names is not None:
        missing = [name for name in field_names if name not in _list_field_names(dtype)]
        if missing:
            raise AssertionError(f"the point cloud has no field {missing}; it has {list(_list_field_names(dtype))}")
        points = points[list(field_names)]
    if uvs is not None:
        points = points[_compute_point_indices(uvs, cloud.width)]
    if skip_nans:
        points = points[_is_not_nan(points)]
    if reshape_organized_cloud and cloud.height > 1 and points.size == cloud.width * cloud.height:
        points = points.reshape(cloud.width, cloud.height)
    return points


def read_points_numpy(
    cloud: Any,
    field_names: Sequence[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[Any] | None = None,
    reshape_organized_cloud: bool = False,
) -> NDArray[Any]:
    """Return the points of a cloud as an array with one column per field. See `read_points`.

    Raises:
        AssertionError: the fields have different types, or a field is missing.
    """
    points = read_points(cloud, field_names, skip_nans, uvs, reshape_organized_cloud)
    if len({points.dtype[name] for name in _list_field_names(points.dtype)}) > 1:
        raise AssertionError("the fields have different types: select fields of one type with field_names")
    return structured_to_unstructured(points)


def read_points_list(
    cloud: Any, field_names: Sequence[str] | None = None, skip_nans: bool = False, uvs: Iterable[Any] | None = None
) -> list[Any]:
    """Return the points of a cloud as named tuples. See `read_points`."""
    points = read_points(cloud, field_names, skip_nans, uvs)
    point = namedtuple("Point", _list_field_names(points.dtype))  # type: ignore[misc]  # noqa: PYI024 - the cloud's names
    return [point._make(values) for values in points.tolist()]


def create_cloud(
    header: Any, fields: Sequence[Any], points: Iterable[Any] | NDArray[Any], step: int | None = None
) -> Any:
    """Create a point cloud (sensor_msgs/msg/PointCloud2).

    Args:
        header: the stamp and frame of the cloud (std_msgs/msg/Header).
        fields: the fields of a point (sensor_msgs/msg/PointField).
        points: rows with a value for each field, or a structured array; an array of shape (width, height) becomes an
            organized cloud.
        step: the distance between two points, in bytes; None for the size of the fields.

    Raises:
        AssertionError: the points do not have these fields.
    """
    dtype = dtype_from_fields(fields, step)
    rows = _to_structured(points, dtype)
    if rows.ndim > 2:
        raise AssertionError("the array of points must have at most two dimensions: width and height")
    width, height = rows.shape[0], rows.shape[1] if rows.ndim == 2 else 1
    cloud = get_message("sensor_msgs/msg/PointCloud2")(
        header=header,
        height=height,
        width=width,
        is_dense=False,
        is_bigendian=False,
        fields=list(fields),
        point_step=dtype.itemsize,
        row_step=dtype.itemsize * width,
    )
    cloud.data = rows.tobytes()
    return cloud


def create_cloud_xyz32(header: Any, points: Iterable[Any] | NDArray[Any], step: int | None = None) -> Any:
    """Create a point cloud with x, y and z as float32. See `create_cloud`."""
    field = get_message("sensor_msgs/msg/PointField")
    fields = [field(name=name, offset=4 * index, datatype=_FLOAT32, count=1) for index, name in enumerate("xyz")]
    return create_cloud(header, fields, points, step)


def _list_field_names(dtype: np.dtype[Any]) -> tuple[str, ...]:
    return dtype.names or ()


def _to_flat_points(cloud: Any, dtype: np.dtype[Any]) -> NDArray[Any]:
    """Return the points of a cloud as a one-dimensional array, without the padding of rows."""
    data = np.frombuffer(cloud.data, np.uint8)
    width, height = cloud.width, cloud.height
    if height > 1 and cloud.row_step > width * dtype.itemsize:
        rows = data[: height * cloud.row_step].reshape(height, cloud.row_step)
        data = np.ascontiguousarray(rows[:, : width * dtype.itemsize]).reshape(-1)
    return np.frombuffer(data, dtype, count=width * height)


def _compute_point_indices(uvs: Iterable[Any], width: int) -> NDArray[np.intp]:
    indices = np.array(list(uvs), dtype=np.intp)
    return indices[:, 1] * width + indices[:, 0] if indices.ndim == 2 else indices


def _is_not_nan(points: NDArray[Any]) -> NDArray[np.bool_]:
    is_valid = np.ones(points.shape, np.bool_)
    for name in _list_field_names(points.dtype):
        if points.dtype[name].kind == "f":
            is_valid &= ~np.isnan(points[name])
    return is_valid


def _to_structured(points: Iterable[Any] | NDArray[Any], dtype: np.dtype[Any]) -> NDArray[Any]:
    if not isinstance(points, np.ndarray):
        return _fill_gaps([tuple(point) for point in points], dtype)
    if points.dtype.names is None:
        if points.shape[-1] != len(_list_field_names(dtype)):
            raise AssertionError(
                f"points have {points.shape[-1]} values, but there are {len(_list_field_names(dtype))} fields"
            )
        return _fill_gaps(unstructured_to_structured(points, dtype), dtype)
    if points.dtype.names != dtype.names or any(points.dtype[name] != dtype[name] for name in _list_field_names(dtype)):
        raise AssertionError(f"points have the type {points.dtype}, but the fields have the type {dtype}")
    return _fill_gaps(points, dtype)


def _fill_gaps(points: list[Any] | NDArray[Any], dtype: np.dtype[Any]) -> NDArray[Any]:
    """Convert points to a structured array with zeros in the gaps between fields.

    numpy does not initialize these gaps itself.
    """
    rows = np.zeros(np.shape(points)[:1] if isinstance(points, list) else points.shape, dtype)
    rows[...] = points
    return rows
