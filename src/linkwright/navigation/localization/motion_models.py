"""Motion models that move particles by odometry, as in nav2_amcl.

Source: "Probabilistic Robotics" (Thrun, Burgard, Fox), section 5.4, with the noise of nav2_amcl.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import atan2, cos, hypot, pi, sin, sqrt

import numpy as np
from numpy.typing import NDArray

Poses = NDArray[np.float64]
"""x and y in meters and yaw in radians, of shape (n, 3)."""

_MIN_TRANSLATION = 0.01
"""The minimum distance in meters for a motion to have a direction."""


@dataclass(frozen=True, slots=True)
class Noise:
    """The parameters of the odometry noise: nav2's ``alpha1`` to ``alpha5``.

    Attributes:
        rotation_from_rotation: the rotation error caused by rotation.
        rotation_from_translation: the rotation error caused by translation.
        translation_from_translation: the translation error caused by translation.
        translation_from_rotation: the translation error caused by rotation.
        strafe: the sideways error of omnidirectional robots.
    """

    rotation_from_rotation: float = 0.2
    rotation_from_translation: float = 0.2
    translation_from_translation: float = 0.2
    translation_from_rotation: float = 0.2
    strafe: float = 0.2


Pose = tuple[float, float, float]
"""x and y in meters and yaw in radians."""

MotionModel = Callable[[Poses, Pose, Pose, Noise, np.random.Generator], None]
"""Moves particles in place. The arguments: particles, old and new odometry pose, noise, random generator."""


def wrap_angle(angle: float) -> float:
    """Return an angle in radians, wrapped to -pi to pi."""
    return atan2(sin(angle), cos(angle))


def move_differentially(
    particles: Poses,
    old_pose: Pose,
    new_pose: Pose,
    noise: Noise,
    random: np.random.Generator,
) -> None:
    """Move particles in place by the differential model: rotation, translation, rotation."""
    x, y, rotation_angle = new_pose[0] - old_pose[0], new_pose[1] - old_pose[1], wrap_angle(new_pose[2] - old_pose[2])
    distance = hypot(x, y)
    first_rotation = 0.0 if distance < _MIN_TRANSLATION else wrap_angle(atan2(y, x) - old_pose[2])
    second_rotation = wrap_angle(rotation_angle - first_rotation)
    # A rotation by about half a turn means that the robot drives backward, so it must not add rotation noise.
    first_size, second_size = (
        min(abs(rotation), abs(wrap_angle(rotation - pi))) for rotation in (first_rotation, second_rotation)
    )
    count = len(particles)
    distance_sigma = sqrt(
        noise.translation_from_translation * distance**2
        + noise.translation_from_rotation * first_size**2
        + noise.translation_from_rotation * second_size**2
    )
    first_sigma = sqrt(noise.rotation_from_rotation * first_size**2 + noise.rotation_from_translation * distance**2)
    second_sigma = sqrt(noise.rotation_from_rotation * second_size**2 + noise.rotation_from_translation * distance**2)
    heading = particles[:, 2] + first_rotation - random.normal(0.0, first_sigma, count)
    distances = distance - random.normal(0.0, distance_sigma, count)
    particles[:, 0] += distances * np.cos(heading)
    particles[:, 1] += distances * np.sin(heading)
    particles[:, 2] = heading + second_rotation - random.normal(0.0, second_sigma, count)


def move_omnidirectionally(
    particles: Poses,
    old_pose: Pose,
    new_pose: Pose,
    noise: Noise,
    random: np.random.Generator,
) -> None:
    """Move particles in place by the omnidirectional model.

    The model consists of a translation in any direction, and a rotation.
    """
    x, y, rotation_angle = new_pose[0] - old_pose[0], new_pose[1] - old_pose[1], wrap_angle(new_pose[2] - old_pose[2])
    distance = hypot(x, y)
    count = len(particles)
    distance_sigma = sqrt(
        noise.translation_from_translation * distance**2 + noise.rotation_from_rotation * rotation_angle**2
    )
    rotation_sigma = sqrt(
        noise.translation_from_rotation * rotation_angle**2 + noise.rotation_from_translation * distance**2
    )
    strafe_sigma = sqrt(noise.rotation_from_rotation * rotation_angle**2 + noise.strafe * distance**2)
    bearing = wrap_angle(atan2(y, x) - old_pose[2]) + particles[:, 2]
    distances = distance + random.normal(0.0, distance_sigma, count)
    sideways_distances = random.normal(0.0, strafe_sigma, count)
    particles[:, 0] += distances * np.cos(bearing) + sideways_distances * np.sin(bearing)
    particles[:, 1] += distances * np.sin(bearing) - sideways_distances * np.cos(bearing)
    particles[:, 2] += rotation_angle + random.normal(0.0, rotation_sigma, count)
