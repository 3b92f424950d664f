"""Conversion of vectors, points, quaternions, poses and transforms (API of ``ros2_numpy.geometry``)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.messages import get_message
from linkwright.standins.numpy_api.registry import converts_from_numpy, converts_to_numpy
from linkwright.standins.transformations import (
    quaternion_from_matrix,
    quaternion_matrix,
    translation_from_matrix,
    translation_matrix,
)

_Vector3 = get_message("geometry_msgs/msg/Vector3")
_Point = get_message("geometry_msgs/msg/Point")
_Quaternion = get_message("geometry_msgs/msg/Quaternion")
_Transform = get_message("geometry_msgs/msg/Transform")
_Pose = get_message("geometry_msgs/msg/Pose")


@converts_to_numpy(_Vector3)
def vector3_to_numpy(msg: Any, hom: bool = False) -> NDArray[np.float64]:
    """Return x, y and z, followed by 0 for homogeneous coordinates (``hom``)."""
    return np.array([msg.x, msg.y, msg.z, 0.0] if hom else [msg.x, msg.y, msg.z])


@converts_from_numpy(_Vector3)
def numpy_to_vector3(arr: NDArray[Any]) -> Any:
    """Return a geometry_msgs/msg/Vector3, or an array of them.

    Args:
        arr: array, shape (..., 3), or (..., 4) with 0 as the last number.

    Raises:
        AssertionError: the fourth number is not 0.
    """
    if arr.shape[-1] == 4:
        if np.any(arr[..., -1]):
            raise AssertionError("the fourth number of a homogeneous vector must be 0")
        arr = arr[..., :-1]
    return _map_last_axes(arr, 1, lambda v: _Vector3(x=float(v[0]), y=float(v[1]), z=float(v[2])))


@converts_to_numpy(_Point)
def point_to_numpy(msg: Any, hom: bool = False) -> NDArray[np.float64]:
    """Return x, y and z, followed by 1 for homogeneous coordinates (``hom``)."""
    return np.array([msg.x, msg.y, msg.z, 1.0] if hom else [msg.x, msg.y, msg.z])


@converts_from_numpy(_Point)
def numpy_to_point(arr: NDArray[Any]) -> Any:
    """Return a geometry_msgs/msg/Point, or an array of them.

    Args:
        arr: array, shape (..., 3), or (..., 4) for homogeneous coordinates.
    """
    if arr.shape[-1] == 4:
        arr = arr[..., :-1] / arr[..., -1:]
    return _map_last_axes(arr, 1, lambda p: _Point(x=float(p[0]), y=float(p[1]), z=float(p[2])))


@converts_to_numpy(_Quaternion)
def quat_to_numpy(msg: Any) -> NDArray[np.float64]:
    """Return x, y, z and w."""
    return np.array([msg.x, msg.y, msg.z, msg.w])


@converts_from_numpy(_Quaternion)
def numpy_to_quat(arr: NDArray[Any]) -> Any:
    """Return a geometry_msgs/msg/Quaternion, or an array of them.

    Args:
        arr: array, shape (..., 4): x, y, z, w.

    Raises:
        AssertionError: the last axis does not have four numbers.
    """
    if arr.shape[-1] != 4:
        raise AssertionError(f"a quaternion has 4 numbers, but the array has the shape {arr.shape}")
    return _map_last_axes(arr, 1, _make_quaternion)


@converts_to_numpy(_Transform)
def transform_to_numpy(msg: Any) -> NDArray[np.float64]:
    """Return the homogeneous matrix, shape (4, 4), of a transform."""
    return _to_matrix(msg.translation, msg.rotation)


@converts_from_numpy(_Transform)
def numpy_to_transform(arr: NDArray[Any]) -> Any:
    """Return a geometry_msgs/msg/Transform, or an array of them.

    Args:
        arr: array, shape (..., 4, 4).

    Raises:
        AssertionError: the array has another shape.
    """

    def make_transform(matrix: NDArray[Any]) -> Any:
        return _Transform(
            translation=numpy_to_vector3(translation_from_matrix(matrix)),
            rotation=_make_quaternion(quaternion_from_matrix(matrix)),
        )

    return _map_matrices(arr, make_transform)


@converts_to_numpy(_Pose)
def pose_to_numpy(msg: Any) -> NDArray[np.float64]:
    """Return the homogeneous matrix, shape (4, 4), of a pose."""
    return _to_matrix(msg.position, msg.orientation)


@converts_from_numpy(_Pose)
def numpy_to_pose(arr: NDArray[Any]) -> Any:
    """Return a geometry_msgs/msg/Pose, or an array of them.

    Args:
        arr: array, shape (..., 4, 4).

    Raises:
        AssertionError: the array has another shape.
    """

    def make_pose(matrix: NDArray[Any]) -> Any:
        return _Pose(
            position=numpy_to_point(translation_from_matrix(matrix)),
            orientation=_make_quaternion(quaternion_from_matrix(matrix)),
        )

    return _map_matrices(arr, make_pose)


def _to_matrix(position: Any, orientation: Any) -> NDArray[np.float64]:
    matrix: NDArray[np.float64] = translation_matrix(vector3_to_numpy(position)) @ quaternion_matrix(
        quat_to_numpy(orientation)
    )
    return matrix


def _make_quaternion(values: NDArray[Any]) -> Any:
    x, y, z, w = (float(value) for value in values)
    return _Quaternion(x=x, y=y, z=z, w=w)


def _map_matrices(arr: NDArray[Any], convert: Callable[[NDArray[Any]], Any]) -> Any:
    if arr.shape[-2:] != (4, 4):
        raise AssertionError(f"a transformation matrix has the shape (4, 4), but the array has the shape {arr.shape}")
    return _map_last_axes(arr, 2, convert)


def _map_last_axes(arr: NDArray[Any], axes: int, convert: Callable[[NDArray[Any]], Any]) -> Any:
    """Return the message of an array with this number of axes, or an array with a message for each such subarray."""
    shape = arr.shape[:-axes]
    if not shape:
        return convert(arr)
    messages = np.empty(shape, np.object_)
    for index in np.ndindex(shape):
        messages[index] = convert(arr[index])
    return messages
