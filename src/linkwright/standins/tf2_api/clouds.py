"""Transforms point clouds into another frame (``tf2_sensor_msgs``)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from linkwright.geometry.arrays import rotation_matrix
from linkwright.messages import get_message
from linkwright.standins.point_clouds import create_cloud, read_points
from linkwright.standins.tf2_api.conversion import ConvertRegistration, TransformRegistration

_AXES = ("x", "y", "z")


def transform_points(point_cloud: ArrayLike, transform: Any) -> NDArray[np.float64]:
    """Transform points into the parent frame of a transform.

    Args:
        point_cloud: the points in the child frame of the transform, of shape (n, 3).
        transform: a geometry_msgs/msg/Transform or TransformStamped.

    Returns:
        The transformed points, of shape (n, 3).
    """
    pose = getattr(transform, "transform", transform)
    rotation, translation = pose.rotation, pose.translation
    matrix = rotation_matrix([rotation.x, rotation.y, rotation.z, rotation.w])
    moved: NDArray[np.float64] = np.asarray(point_cloud) @ matrix.T + [translation.x, translation.y, translation.z]
    return moved


def do_transform_cloud(cloud: Any, transform: Any) -> Any:
    """Transform a point cloud into the parent frame of a transform.

    Only the fields x, y and z change.

    Args:
        cloud: the point cloud (sensor_msgs/msg/PointCloud2).
        transform: the transform (geometry_msgs/msg/TransformStamped), whose header becomes the header of the new cloud.
    """
    points = read_points(cloud).copy()
    moved = transform_points(np.stack([points[axis] for axis in _AXES], axis=-1), transform)
    for column, axis in enumerate(_AXES):
        points[axis] = moved[:, column]
    return create_cloud(transform.header, cloud.fields, points, cloud.point_step)


def to_msg_msg(msg: Any) -> Any:
    """Return the message unchanged; the conversion to a message for types that are messages."""
    return msg


from_msg_msg = to_msg_msg


def register() -> None:
    """Register the transformation of point clouds in the registry that all buffers share."""
    kind = get_message("sensor_msgs/msg/PointCloud2")
    TransformRegistration().add(kind, do_transform_cloud)
    ConvertRegistration().add_to_msg(kind, to_msg_msg)
    ConvertRegistration().add_from_msg(kind, from_msg_msg)
