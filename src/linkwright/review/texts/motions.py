"""Distances and angles between two poses, for sentences about moved and rotated frames."""

from __future__ import annotations

import math
from collections.abc import Sequence

from linkwright.diagnostics import Phrase, phrase
from linkwright.geometry.single import Pose, pose_quaternion

_MIN_DISTANCE_M, _MIN_ANGLE_DEG = 1e-9, 1e-6


def compute_angle(old: Sequence[float], new: Sequence[float]) -> float:
    """Return the angle in degrees between two rotations, each in roll, pitch and yaw in rad."""
    first, second = (pose_quaternion(Pose((0.0, 0.0, 0.0), (rpy[0], rpy[1], rpy[2]))) for rpy in (old, new))
    cosine = abs(sum(a * b for a, b in zip(first, second, strict=True)))
    return math.degrees(2.0 * math.acos(min(1.0, cosine)))


def add_pose_motion(text: Phrase, old: Sequence[float], new: Sequence[float]) -> Phrase:
    """Return a sentence about a changed pose with the distance in m and the angle in degrees.

    Args:
        text: the sentence.
        old: the old position in m, then roll, pitch and yaw in rad.
        new: the new position and rotation.
    """
    return add_motion(text, math.dist(old[:3], new[:3]), compute_angle(old[3:], new[3:]))


def add_motion(text: Phrase, distance: float, angle: float) -> Phrase:
    """Return a sentence about a moved frame with the distance in m and the angle in degrees, without those near 0."""
    if distance > _MIN_DISTANCE_M and angle > _MIN_ANGLE_DEG:
        return phrase(
            "{change} (moved by {distance:.4g} m, rotated by {angle:.3g}°)", change=text, distance=distance, angle=angle
        )
    if distance > _MIN_DISTANCE_M:
        return phrase("{change} (moved by {distance:.4g} m)", change=text, distance=distance)
    if angle > _MIN_ANGLE_DEG:
        return phrase("{change} (rotated by {angle:.3g}°)", change=text, angle=angle)
    return phrase("{change} (the same pose)", change=text)
