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
"""x and y in metres and yaw in radians, of shape (n, 3)."""

_MIN_TRANSLATION = 0.01
"""Metres up to which a motion has no direction."""


@dataclass(frozen=True, slots=True)
class Noise:
    """The parameters of the odometry noise: nav2's ``alpha1`` to ``alpha5``.

    Attributes:
        turn_of_turn: the rotation error caused by rotation.
        turn_of_drive: the rotation error caused by translation.
        drive_of_drive: the translation error caused by translation.
        drive_of_turn: the translation error caused by rotation.
        strafe: the sideways error of omnidirectional robots.
    """

    turn_of_turn: float = 0.2
    turn_of_drive: float = 0.2
    drive_of_drive: float = 0.2
    drive_of_turn: float = 0.2
    strafe: float = 0.2


Pose = tuple[float, float, float]
"""x and y in metres and yaw in radians."""

MotionModel = Callable[[Poses, Pose, Pose, Noise, np.random.Generator], None]
"""Moves particles in place: particles, the odometry poses before and after, the noise, and the random generator."""


def wrap_angle(angle: float) -> float:
    """Return an angle wrapped to -pi to pi."""
    return atan2(sin(angle), cos(angle))


def differential(
    particles: Poses,
    before: Pose,
    after: Pose,
    noise: Noise,
    random: np.random.Generator,
) -> None:
    """Move particles in place by the differential model: rotation, translation, rotation."""
    x, y, turn = after[0] - before[0], after[1] - before[1], wrap_angle(after[2] - before[2])
    drive = hypot(x, y)
    first = 0.0 if drive < _MIN_TRANSLATION else wrap_angle(atan2(y, x) - before[2])
    second = wrap_angle(turn - first)
    # Driving backward must not count as a half turn.
    first_size, second_size = (min(abs(rotation), abs(wrap_angle(rotation - pi))) for rotation in (first, second))
    count = len(particles)
    drive_sigma = sqrt(
        noise.drive_of_drive * drive**2 + noise.drive_of_turn * first_size**2 + noise.drive_of_turn * second_size**2
    )
    first_sigma = sqrt(noise.turn_of_turn * first_size**2 + noise.turn_of_drive * drive**2)
    second_sigma = sqrt(noise.turn_of_turn * second_size**2 + noise.turn_of_drive * drive**2)
    heading = particles[:, 2] + first - random.normal(0.0, first_sigma, count)
    way = drive - random.normal(0.0, drive_sigma, count)
    particles[:, 0] += way * np.cos(heading)
    particles[:, 1] += way * np.sin(heading)
    particles[:, 2] = heading + second - random.normal(0.0, second_sigma, count)


def omnidirectional(
    particles: Poses,
    before: Pose,
    after: Pose,
    noise: Noise,
    random: np.random.Generator,
) -> None:
    """Move particles in place by the omnidirectional model.

    The model consists of a translation in any direction, and a rotation.
    """
    x, y, turn = after[0] - before[0], after[1] - before[1], wrap_angle(after[2] - before[2])
    drive = hypot(x, y)
    count = len(particles)
    drive_sigma = sqrt(noise.drive_of_drive * drive**2 + noise.turn_of_turn * turn**2)
    turn_sigma = sqrt(noise.drive_of_turn * turn**2 + noise.turn_of_drive * drive**2)
    strafe_sigma = sqrt(noise.turn_of_turn * turn**2 + noise.strafe * drive**2)
    bearing = wrap_angle(atan2(y, x) - before[2]) + particles[:, 2]
    way = drive + random.normal(0.0, drive_sigma, count)
    sideways = random.normal(0.0, strafe_sigma, count)
    particles[:, 0] += way * np.cos(bearing) + sideways * np.sin(bearing)
    particles[:, 1] += way * np.sin(bearing) - sideways * np.cos(bearing)
    particles[:, 2] += turn + random.normal(0.0, turn_sigma, count)
