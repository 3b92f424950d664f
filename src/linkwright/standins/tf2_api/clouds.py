"""Transform point clouds into another frame (``tf2_sensor_msgs``)."""

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
    transformed_points: NDArray[np.float64] = np.asarray(point_cloud) @ matrix.T + [
        translation.x,
        translation.y,
        translation.z,
    ]
    return transformed_points


def do_transform_cloud(cloud: Any, transform: Any) -> Any:
    """Transform a point cloud into the parent frame of a transform.

    All fields except x, y and z are copied unchanged.

    Args:
        cloud: the point cloud (sensor_msgs/msg/PointCloud2).
        transform: the transform (geometry_msgs/msg/TransformStamped); its header becomes the header of the new cloud.
    """
    points = read_points(cloud).copy()
    transformed_points = transform_points(np.stack([points[axis] for axis in _AXES], axis=-1), transform)
    for column, axis in enumerate(_AXES):
        points[axis] = transformed_points[:, column]
    return create_cloud(transform.header, cloud.fields, points, cloud.point_step)


def to_msg_msg(msg: Any) -> Any:
    """Return a message unchanged, because it does not need to be converted to a message."""
    return msg


from_msg_msg = to_msg_msg


def register() -> None:
    """Register the transformation of point clouds for all buffers."""
    cloud_class = get_message("sensor_msgs/msg/PointCloud2")
    TransformRegistration().add(cloud_class, do_transform_cloud)
    ConvertRegistration().add_to_msg(cloud_class, to_msg_msg)
    ConvertRegistration().add_from_msg(cloud_class, from_msg_msg)
