"""Single poses as seven plain floats, for lookups along a chain of a few frames, where arrays would cost more.

A pose is ``(x, y, z, qx, qy, qz, qw)``: metres, and a unit quaternion. `linkwright.kinematics` does the same for many.
"""

from __future__ import annotations

from math import acos, sin

Pose = tuple[float, float, float, float, float, float, float]
Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]

IDENTITY: Pose = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)


def rotate(quaternion: Quaternion, vector: Vector) -> Vector:
    """A vector turned by a unit quaternion."""
    qx, qy, qz, qw = quaternion
    x, y, z = vector
    # v + 2 w (u x v) + 2 u x (u x v), with u the vector part
    tx, ty, tz = 2.0 * (qy * z - qz * y), 2.0 * (qz * x - qx * z), 2.0 * (qx * y - qy * x)
    return (
        x + qw * tx + qy * tz - qz * ty,
        y + qw * ty + qz * tx - qx * tz,
        z + qw * tz + qx * ty - qy * tx,
    )


def multiply(first: Quaternion, second: Quaternion) -> Quaternion:
    """The rotation that applies the second one, then the first."""
    ax, ay, az, aw = first
    bx, by, bz, bw = second
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def compose(parent: Pose, child: Pose) -> Pose:
    """The pose in the grandparent of what is at `child` in its parent, which is at `parent`."""
    x, y, z = rotate(parent[3:], child[:3])
    return (parent[0] + x, parent[1] + y, parent[2] + z, *multiply(parent[3:], child[3:]))


def invert(pose: Pose) -> Pose:
    """The pose of the parent in the child."""
    x, y, z, qx, qy, qz, qw = pose
    inverse = (-qx, -qy, -qz, qw)
    return (*rotate(inverse, (-x, -y, -z)), *inverse)


def interpolate(first: Pose, second: Pose, ratio: float) -> Pose:
    """The pose part of the way from one to another: positions on a line, rotations on the shorter arc (tf2)."""
    rest = 1.0 - ratio
    x, y, z = (rest * a + ratio * b for a, b in zip(first[:3], second[:3], strict=True))
    return (x, y, z, *_slerp(first[3:], second[3:], ratio))


def _slerp(first: Quaternion, second: Quaternion, ratio: float) -> Quaternion:
    dot = sum(a * b for a, b in zip(first, second, strict=True))
    sign = -1.0 if dot < 0.0 else 1.0
    angle = acos(min(1.0, abs(dot)))
    whole = sin(angle)
    if whole == 0.0:
        return first
    a, b = sin((1.0 - ratio) * angle) / whole, sign * sin(ratio * angle) / whole
    x, y, z, w = (a * p + b * q for p, q in zip(first, second, strict=True))
    return x, y, z, w
