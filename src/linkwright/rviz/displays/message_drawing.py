"""Marker messages for displays that draw messages of other packages."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from linkwright.geometry.arrays import Array
from linkwright.messages import get_message

Marker = get_message("visualization_msgs/msg/Marker")
_Point = get_message("geometry_msgs/msg/Point")
_Color = get_message("std_msgs/msg/ColorRGBA")
_Pose = get_message("geometry_msgs/msg/Pose")

Rgba = tuple[float, float, float, float]


def read_color(text: str, alpha: float = 1.0) -> Rgba:
    """Return a color written as ``#rrggbb``, with an opacity."""
    red, green, blue = (int(text[start : start + 2], 16) / 255 for start in (1, 3, 5))
    return red, green, blue, alpha


def make_pose(position: Sequence[float], yaw: float = 0.0) -> Any:
    """Return a geometry_msgs/msg/Pose that is turned about z."""
    pose = _Pose()
    pose.position.x, pose.position.y, pose.position.z = map(float, position)
    pose.orientation.z, pose.orientation.w = math.sin(yaw / 2), math.cos(yaw / 2)
    return pose


def make_marker(
    namespace: str,
    number: int,
    kind: int,
    color: Rgba,
    *,
    scale: Sequence[float] = (0.0, 0.0, 0.0),
    pose: Any = None,
    points: ArrayLike = (),
    colors: ArrayLike = (),
    text: str = "",
) -> Any:
    """Return a visualization_msgs/msg/Marker.

    Args:
        namespace: the namespace, which has a check box in the display.
        number: the ID in the namespace.
        kind: a type of marker, such as `Marker.LINE_STRIP`.
        color: red, green, blue and opacity, from 0 to 1.
        scale: x, y and z, which mean different things for each type.
        pose: a geometry_msgs/msg/Pose in the frame of the message; None for its origin.
        points: shape (N, 3), relative to the pose.
        colors: one color for each point, shape (N, 4).
        text: the text of a marker of type TEXT_VIEW_FACING.
    """
    marker = Marker(ns=namespace, id=number, type=kind, text=text)
    marker.color = make_color(color)
    marker.scale.x, marker.scale.y, marker.scale.z = map(float, scale)
    if pose is not None:
        marker.pose = pose
    marker.points = [_Point(x=x, y=y, z=z) for x, y, z in np.asarray(points, dtype=np.float64).reshape(-1, 3).tolist()]
    marker.colors = [make_color(row) for row in np.asarray(colors, dtype=np.float64).reshape(-1, 4).tolist()]
    return marker


def make_text(namespace: str, number: int, text: str, position: Sequence[float], height: float, color: Rgba) -> Any:
    """Return a marker with a text that faces the camera; the height of a line is in meters."""
    pose, scale = make_pose(position), (height, height, height)
    return make_marker(namespace, number, Marker.TEXT_VIEW_FACING, color, scale=scale, pose=pose, text=text)


def make_color(color: Sequence[float]) -> Any:
    """Return a std_msgs/msg/ColorRGBA."""
    red, green, blue, alpha = color
    return _Color(r=red, g=green, b=blue, a=alpha)


def list_positions(points: Sequence[Any]) -> Array:
    """Return messages with x, y and z as an array, shape (N, 3)."""
    return np.array([(point.x, point.y, point.z) for point in points], dtype=np.float64).reshape(-1, 3)


def list_orientations(poses: Sequence[Any]) -> Array:
    """Return the quaternions of poses, x y z w, shape (N, 4)."""
    rows = [(pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w) for pose in poses]
    return np.array(rows, dtype=np.float64).reshape(-1, 4)


def compute_yaw(quaternion: Any) -> float:
    """Return the rotation about z of a geometry_msgs/msg/Quaternion, rad."""
    x, y, z, w = quaternion.x, quaternion.y, quaternion.z, quaternion.w
    return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
