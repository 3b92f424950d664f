"""Transform geometry_msgs messages between frames, as in ``tf2_geometry_msgs``.

Each function takes a message and a geometry_msgs/msg/TransformStamped from a lookup, and returns a new message. If the
new message has a header, it is the transform's header. The arguments are not changed.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import rotation_matrix
from linkwright.geometry.single import Transform, Vector3, compose, normalized, rotate

_NO_ROTATION = float(np.finfo(np.float64).eps)
"""A quaternion with a squared length below this counts as no rotation, as in tf2_geometry_msgs."""


def pose_from_transform(transform: Any) -> Transform:
    """Return the pose in a geometry_msgs/msg/TransformStamped."""
    return _to_transform(transform.transform.translation, transform.transform.rotation)


def do_transform_point(point: Any, transform: Any) -> Any:
    """Return a PointStamped in the target frame."""
    result = _new_message("PointStamped", transform)
    _set_vector(result.point, _transform_point(transform, (point.point.x, point.point.y, point.point.z)))
    return result


def do_transform_vector3(vector3: Any, transform: Any) -> Any:
    """Return a Vector3Stamped in the target frame.

    The vector is rotated but not translated.
    """
    result = _new_message("Vector3Stamped", transform)
    _set_vector(result.vector, _rotate_vector(transform, vector3.vector))
    return result


def do_transform_pose(pose: Any, transform: Any) -> Any:
    """Return a Pose in the target frame.

    For a PoseStamped the result is a PoseStamped, as in older releases.
    """
    if hasattr(pose, "header"):
        return do_transform_pose_stamped(pose, transform)
    from linkwright.messages import get_message

    result = get_message("geometry_msgs/msg/Pose")()
    local_pose = _to_transform(pose.position, pose.orientation)
    x, y, z, qx, qy, qz, qw = compose(pose_from_transform(transform), local_pose)
    _set_vector(result.position, (x, y, z))
    orientation = result.orientation
    orientation.x, orientation.y, orientation.z, orientation.w = qx, qy, qz, qw
    return result


def do_transform_pose_stamped(pose: Any, transform: Any) -> Any:
    """Return a PoseStamped in the target frame."""
    result = _new_message("PoseStamped", transform)
    result.pose = do_transform_pose(pose.pose, transform)
    return result


def do_transform_pose_with_covariance_stamped(pose: Any, transform: Any) -> Any:
    """Return a PoseWithCovarianceStamped in the target frame.

    The covariance is also rotated.
    """
    result = _new_message("PoseWithCovarianceStamped", transform)
    result.pose.pose = do_transform_pose(pose.pose.pose, transform)
    result.pose.covariance = transform_covariance(pose.pose.covariance, transform)
    return result


def do_transform_wrench(wrench: Any, transform: Any) -> Any:
    """Return a WrenchStamped in the target frame, with force and torque rotated."""
    result = _new_message("WrenchStamped", transform)
    _set_vector(result.wrench.force, _rotate_vector(transform, wrench.wrench.force))
    _set_vector(result.wrench.torque, _rotate_vector(transform, wrench.wrench.torque))
    return result


def do_transform_polygon_stamped(polygon: Any, transform: Any) -> Any:
    """Return a PolygonStamped in the target frame."""
    from linkwright.messages import get_message

    point_class = get_message("geometry_msgs/msg/Point32")
    result = _new_message("PolygonStamped", transform)
    points = []
    for corner in polygon.polygon.points:
        point = point_class()
        _set_vector(point, _transform_point(transform, (corner.x, corner.y, corner.z)))
        points.append(point)
    result.polygon.points = points
    return result


def transform_covariance(cov_in: Any, transform: Any) -> NDArray[np.float64]:
    """Return the covariance of a pose in the target frame.

    Args:
        cov_in: 36 numbers, the rows of the covariance matrix of x, y, z and the rotations about these axes.
        transform: the transform; only its rotation is used.

    Returns:
        Array, shape (36,).
    """
    rotation = rotation_matrix(pose_from_transform(transform)[3:])
    block_rotation = np.zeros((6, 6))
    block_rotation[:3, :3] = block_rotation[3:, 3:] = rotation
    covariance = np.asarray(cov_in, dtype=np.float64).reshape(6, 6)
    rotated: NDArray[np.float64] = (block_rotation @ covariance @ block_rotation.T).reshape(36)
    return rotated


def _new_message(name: str, transform: Any) -> Any:
    from linkwright.messages import get_message

    result = get_message(f"geometry_msgs/msg/{name}")()
    result.header = transform.header
    return result


def _transform_point(transform: Any, vector: Vector3) -> Vector3:
    pose = pose_from_transform(transform)
    x, y, z = rotate(pose[3:], vector)
    return pose[0] + x, pose[1] + y, pose[2] + z


def _rotate_vector(transform: Any, vector: Any) -> Vector3:
    return rotate(pose_from_transform(transform)[3:], (vector.x, vector.y, vector.z))


def _to_transform(position: Any, rotation: Any) -> Transform:
    unit_rotation = normalized(rotation.x, rotation.y, rotation.z, rotation.w, min_squared_norm=_NO_ROTATION)
    return (position.x, position.y, position.z, *unit_rotation)


def _set_vector(target: Any, vector: Vector3) -> None:
    target.x, target.y, target.z = vector
