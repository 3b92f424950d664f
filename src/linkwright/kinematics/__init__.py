"""Transforms, and forward kinematics for one or many configurations."""

from linkwright.kinematics.poses import IDENTITY, compose, invert, matrix_from_pose
from linkwright.kinematics.quaternions import (
    quaternion_from_matrix,
    quaternion_from_rpy,
    quaternion_inverse,
    quaternion_multiply,
    rotate,
    rotation_matrix,
)
from linkwright.kinematics.tree import KinematicTree, UnknownNameError

__all__ = [
    "IDENTITY",
    "KinematicTree",
    "UnknownNameError",
    "compose",
    "invert",
    "matrix_from_pose",
    "quaternion_from_matrix",
    "quaternion_from_rpy",
    "quaternion_inverse",
    "quaternion_multiply",
    "rotate",
    "rotation_matrix",
]
