"""Single poses, rotations and vectors, as tuples of plain floats.

Quaternions are x, y, z, w; lengths are meters and angles radians. The functions have the same names as the functions
for arrays in `linkwright.geometry.arrays`. This module lets readers of descriptions work without numpy.
"""

from __future__ import annotations

from math import acos, asin, atan2, cos, pi, sin, sqrt

from linkwright.loading.lean_dataclasses import dataclass

Vector3 = tuple[float, float, float]


def add_vectors(first: Vector3, second: Vector3) -> Vector3:
    """Return the sum of two vectors."""
    return first[0] + second[0], first[1] + second[1], first[2] + second[2]


def subtract_vectors(first: Vector3, second: Vector3) -> Vector3:
    """Return the first vector minus the second."""
    return first[0] - second[0], first[1] - second[1], first[2] - second[2]


def scaled(vector: Vector3, factor: float) -> Vector3:
    """Return a vector multiplied by a factor."""
    return vector[0] * factor, vector[1] * factor, vector[2] * factor


def dot(first: Vector3, second: Vector3) -> float:
    """Return the dot product of two vectors."""
    return first[0] * second[0] + first[1] * second[1] + first[2] * second[2]


def cross(first: Vector3, second: Vector3) -> Vector3:
    """Return the cross product of two vectors."""
    (a, b, c), (x, y, z) = first, second
    return b * z - c * y, c * x - a * z, a * y - b * x


def length(vector: Vector3) -> float:
    """Return the Euclidean length of a vector."""
    return sqrt(dot(vector, vector))


Quaternion = tuple[float, float, float, float]
"""x, y, z, w, of unit length."""

Transform = tuple[float, float, float, float, float, float, float]
"""The pose of a child frame in its parent: x, y, z, qx, qy, qz, qw."""

IDENTITY: Transform = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)

_GIMBAL_LOCK_SINE = 0.99999
"""The sine of the pitch beyond which roll and yaw turn about the same axis."""


@dataclass(frozen=True, slots=True)
class Pose:
    """The pose of a child frame in its parent frame, as written in descriptions.

    Attributes:
        xyz: the translation in meters.
        rpy: roll, pitch, yaw in radians about the fixed axes x, y, z: R = Rz(yaw) Ry(pitch) Rx(roll) (REP 103).
        quaternion: the quaternion if the file has ``quat_xyzw`` (URDF 1.1), from which `rpy` is then derived; else
            None.
    """

    xyz: Vector3 = (0.0, 0.0, 0.0)
    rpy: Vector3 = (0.0, 0.0, 0.0)
    quaternion: Quaternion | None = None


IDENTITY_POSE = Pose()


def pose_quaternion(pose: Pose) -> Quaternion:
    """Return the rotation of a pose, from the child's axes to the parent's, as a quaternion."""
    return pose.quaternion or quaternion_from_rpy(pose.rpy)


def quaternion_from_rpy(rpy: Vector3) -> Quaternion:
    """Return the rotation Rz(yaw) Ry(pitch) Rx(roll) as a quaternion.

    The result is bitwise identical to urdfdom's.
    """
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
    """Return roll, pitch and yaw in radians, as urdfdom computes them.

    Roll is 0 within 0.26 degrees of a pitch of +-90 degrees.
    """
    x, y, z, w = quaternion
    sin_pitch = -2 * (x * z - w * y)
    if sin_pitch <= -_GIMBAL_LOCK_SINE:
        return 0.0, -pi / 2, 2 * atan2(x, -y)
    if sin_pitch >= _GIMBAL_LOCK_SINE:
        return 0.0, pi / 2, 2 * atan2(-x, y)
    xx, yy, zz, ww = x * x, y * y, z * z, w * w
    roll = atan2(2 * (y * z + w * x), ww - xx - yy + zz)
    yaw = atan2(2 * (x * y + w * z), ww + xx - yy - zz)
    return roll, asin(sin_pitch), yaw


def normalized(x: float, y: float, z: float, w: float, *, min_squared_norm: float = 0.0) -> Quaternion:
    """Scale a quaternion to length 1.

    The result is the identity if the squared length is 0, or less than `min_squared_norm`.
    """
    squared = x * x + y * y + z * z + w * w
    if squared == 0.0 or squared < min_squared_norm:
        return 0.0, 0.0, 0.0, 1.0
    norm = sqrt(squared)
    return x / norm, y / norm, z / norm, w / norm


def axis_and_angle(quaternion: Quaternion) -> tuple[Vector3, float]:
    """Return the unit axis of a rotation, and the angle in radians, from 0 to 2 pi.

    The axis of the identity is x.
    """
    x, y, z, w = quaternion
    norm = sqrt(x * x + y * y + z * z)  # 1 - w² would have few significant digits for a small angle.
    angle = 2.0 * atan2(norm, w)
    if norm < 1e-6:
        return (1.0, 0.0, 0.0), angle
    return (x / norm, y / norm, z / norm), angle


def rotation_from_z(axis: Vector3) -> Quaternion:
    """Return the smallest rotation from z to an axis of any length, as a quaternion.

    If the axis points along -z, the rotation is about x. For a zero axis, it is the identity.
    """
    x, y, z = axis
    norm = sqrt(x * x + y * y + z * z)
    if norm == 0.0:
        return 0.0, 0.0, 0.0, 1.0
    x, y, z = x / norm, y / norm, z / norm
    if z < -1.0 + 1e-9:
        return 1.0, 0.0, 0.0, 0.0
    w = sqrt((1.0 + z) / 2.0)
    return -y / (2.0 * w), x / (2.0 * w), 0.0, w


def rotate(quaternion: Quaternion, vector: Vector3) -> Vector3:
    """Rotate a vector from the child frame into the parent frame."""
    qx, qy, qz, qw = quaternion
    x, y, z = vector
    # v + 2 w (u x v) + 2 u x (u x v), where u is the vector part of the quaternion.
    tx, ty, tz = 2.0 * (qy * z - qz * y), 2.0 * (qz * x - qx * z), 2.0 * (qx * y - qy * x)
    return (
        x + qw * tx + qy * tz - qz * ty,
        y + qw * ty + qz * tx - qx * tz,
        z + qw * tz + qx * ty - qy * tx,
    )


def rotation_matrix(quaternion: Quaternion) -> tuple[Vector3, Vector3, Vector3]:
    """Convert a rotation to the rows of a matrix."""
    x, y, z, w = quaternion
    return (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )


def quaternion_multiply(first: Quaternion, second: Quaternion) -> Quaternion:
    """Return the rotation that applies `second`, then `first`: the product first * second."""
    ax, ay, az, aw = first
    bx, by, bz, bw = second
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def quaternion_inverse(quaternion: Quaternion) -> Quaternion:
    """Return the inverse rotation."""
    x, y, z, w = quaternion
    return -x, -y, -z, w


def compose(b_in_a: Transform, c_in_b: Transform) -> Transform:
    """Return the pose of frame C in frame A, given B in A and C in B."""
    x, y, z = rotate(b_in_a[3:], c_in_b[:3])
    return (b_in_a[0] + x, b_in_a[1] + y, b_in_a[2] + z, *quaternion_multiply(b_in_a[3:], c_in_b[3:]))


def invert(b_in_a: Transform) -> Transform:
    """Return the pose of frame A in frame B, given B in A."""
    x, y, z, qx, qy, qz, qw = b_in_a
    inverse = (-qx, -qy, -qz, qw)  # Inlined, because lookups of transforms must be fast.
    return (*rotate(inverse, (-x, -y, -z)), *inverse)


def interpolate(first: Transform, second: Transform, ratio: float) -> Transform:
    """Interpolate between two poses, as tf2 does.

    Positions are interpolated linearly, and rotations along the shorter arc; `ratio` is 0 at `first` and 1 at `second`.
    """
    first_weight = 1.0 - ratio
    x, y, z = (first_weight * a + ratio * b for a, b in zip(first[:3], second[:3], strict=True))
    return (x, y, z, *_slerp(first[3:], second[3:], ratio))


def _slerp(first: Quaternion, second: Quaternion, ratio: float) -> Quaternion:
    dot = sum(a * b for a, b in zip(first, second, strict=True))
    sign = -1.0 if dot < 0.0 else 1.0
    angle = acos(min(1.0, abs(dot)))
    sin_angle = sin(angle)
    if sin_angle == 0.0:
        return first
    a, b = sin((1.0 - ratio) * angle) / sin_angle, sign * sin(ratio * angle) / sin_angle
    x, y, z, w = (a * p + b * q for p, q in zip(first, second, strict=True))
    return x, y, z, w
