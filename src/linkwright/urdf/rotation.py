"""Rotations of single poses in plain floats, to the last bit as urdfdom computes them.

The kinematics room has the same for arrays; this one keeps the reader free of numpy and gives the angles that
``urdf_to_graphviz`` prints.
"""

from __future__ import annotations

from math import asin, atan2, cos, pi, sin, sqrt

from linkwright.urdf.model import Pose, Quaternion, Vector3

_GIMBAL_LOCK = 0.99999


def quaternion_from_rpy(rpy: Vector3) -> Quaternion:
    """x, y, z, w of the rotation Rz(yaw) Ry(pitch) Rx(roll); angles in radians."""
    roll, pitch, yaw = (angle / 2.0 for angle in rpy)
    sin_roll, cos_roll = sin(roll), cos(roll)
    sin_pitch, cos_pitch = sin(pitch), cos(pitch)
    sin_yaw, cos_yaw = sin(yaw), cos(yaw)
    x = sin_roll * cos_pitch * cos_yaw - cos_roll * sin_pitch * sin_yaw
    y = cos_roll * sin_pitch * cos_yaw + sin_roll * cos_pitch * sin_yaw
    z = cos_roll * cos_pitch * sin_yaw - sin_roll * sin_pitch * cos_yaw
    w = cos_roll * cos_pitch * cos_yaw + sin_roll * sin_pitch * sin_yaw
    norm = sqrt(x * x + y * y + z * z + w * w)
    return x / norm, y / norm, z / norm, w / norm


def rpy_from_quaternion(quaternion: Quaternion) -> Vector3:
    """Roll, pitch, yaw in radians; within 0.26 degrees of pitch = +-90 degrees roll is 0, as in urdfdom."""
    x, y, z, w = quaternion
    sin_pitch = -2 * (x * z - w * y)
    if sin_pitch <= -_GIMBAL_LOCK:
        return 0.0, -pi / 2, 2 * atan2(x, -y)
    if sin_pitch >= _GIMBAL_LOCK:
        return 0.0, pi / 2, 2 * atan2(-x, y)
    xx, yy, zz, ww = x * x, y * y, z * z, w * w
    roll = atan2(2 * (y * z + w * x), ww - xx - yy + zz)
    yaw = atan2(2 * (x * y + w * z), ww + xx - yy - zz)
    return roll, asin(sin_pitch), yaw


def quaternion_of(pose: Pose) -> Quaternion:
    """The rotation of a pose as x, y, z, w."""
    return pose.quaternion or quaternion_from_rpy(pose.rpy)
