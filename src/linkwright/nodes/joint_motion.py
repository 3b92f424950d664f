"""How joints place their child links, for many joints in one go."""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt

import numpy as np
from numpy.typing import NDArray

from linkwright.kinematics import quaternion_from_rpy, quaternion_multiply, rotate
from linkwright.urdf import Joint

Array = NDArray[np.float64]


class JointMotion:
    """Poses of child links in their parent links as functions of joint positions.

    Turning by q about an axis composes the rotation r of the joint's origin with (axis sin q/2, cos q/2), which is
    r cos q/2 + (r * axis) sin q/2; shifting along it adds q times the turned axis. So each pose is
    ``fixed + cosine cos q/2 + sine sin q/2 + linear q`` with constant rows, and all joints take a few array operations
    whatever their types are.

    Args:
        joints: revolute, continuous and prismatic ones move, all others stay at their origin. Axes need not be of
            unit length (KDL normalises them); a joint with a zero axis does not move.
    """

    def __init__(self, joints: Sequence[Joint]) -> None:
        self._fixed, self._cosine, self._sine, self._linear = np.zeros((4, len(joints), 7))
        for row, joint in enumerate(joints):
            self._add(row, joint)

    def poses(self, positions: Array) -> Array:
        """Array, shape (n, 7), of x y z (metres) and qx qy qz qw, for positions (n,) in radians or metres."""
        half = (0.5 * positions)[:, np.newaxis]
        turned: Array = self._cosine * np.cos(half)
        turned += self._sine * np.sin(half)
        turned += self._linear * positions[:, np.newaxis]
        turned += self._fixed
        return turned

    def select(self, rows: Sequence[int]) -> JointMotion:
        """The same for some of the joints, in the order given."""
        selected = JointMotion(())
        selected._fixed, selected._cosine = self._fixed[rows], self._cosine[rows]
        selected._sine, selected._linear = self._sine[rows], self._linear[rows]
        return selected

    def _add(self, row: int, joint: Joint) -> None:
        rotation = joint.origin.quaternion or quaternion_from_rpy(joint.origin.rpy)
        length = sqrt(sum(component * component for component in joint.axis))
        axis = np.array(joint.axis) / length if length else np.zeros(3)
        self._fixed[row, :3] = joint.origin.xyz
        if joint.type in ("revolute", "continuous") and length:
            self._cosine[row, 3:] = rotation
            self._sine[row, 3:] = quaternion_multiply(rotation, [*axis, 0.0])
        else:
            self._fixed[row, 3:] = rotation
            if joint.type == "prismatic":
                self._linear[row, :3] = rotate(rotation, axis)
