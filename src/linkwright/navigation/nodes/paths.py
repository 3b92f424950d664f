"""Convert paths and poses to and from messages."""

from __future__ import annotations

from math import cos, sin
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.single import rpy_from_quaternion
from linkwright.messages import get_message


def path_message(poses: NDArray[np.float64], frame: str, stamp: Any) -> Any:
    """Convert poses, of shape (n, 3) with x, y (meters) and yaw (radians), to a nav_msgs/Path."""
    path, pose_stamped = get_message("nav_msgs/msg/Path")(), get_message("geometry_msgs/msg/PoseStamped")
    path.header.frame_id, path.header.stamp = frame, stamp
    for x, y, yaw in poses.tolist():
        message = pose_stamped()
        message.header.frame_id, message.header.stamp = frame, stamp
        message.pose.position.x, message.pose.position.y = x, y
        message.pose.orientation.z, message.pose.orientation.w = sin(yaw / 2.0), cos(yaw / 2.0)
        path.poses.append(message)
    return path


def poses_from_messages(stamped: Any) -> NDArray[np.float64]:
    """Convert a list of geometry_msgs/PoseStamped to planar poses, of shape (n, 3).

    Poses are x, y (meters) and yaw (radians).
    """
    return np.array([pose_from_message(pose) for pose in stamped], np.float64).reshape(-1, 3)


def pose_from_message(stamped: Any) -> tuple[float, float, float]:
    """Convert a geometry_msgs/PoseStamped to x, y (meters) and yaw (radians)."""
    position, orientation = stamped.pose.position, stamped.pose.orientation
    quaternion = (orientation.x, orientation.y, orientation.z, orientation.w)
    yaw = rpy_from_quaternion(quaternion)[2] if any(quaternion) else 0.0
    return position.x, position.y, yaw
