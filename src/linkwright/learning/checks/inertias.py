"""The moments of inertia of solid shapes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.shapes import Box, Cylinder, Sphere
from linkwright.urdf.model import Inertial


def make_inertia_matrix(inertial: Inertial) -> NDArray[np.float64]:
    """Return the inertia of a link in the frame of its `<inertial>`, shape (3, 3), in kg m²."""
    return np.array(
        [
            [inertial.ixx, inertial.ixy, inertial.ixz],
            [inertial.ixy, inertial.iyy, inertial.iyz],
            [inertial.ixz, inertial.iyz, inertial.izz],
        ]
    )


def compute_moments_of_inertia(
    shape: Box | Cylinder | Sphere, mass: float, along: Sequence[float] | None = None
) -> tuple[float, float, float]:
    """Return the moments of a solid shape about x, y and z through its center, in kg m².

    Args:
        shape: the solid shape with its size in m.
        mass: its mass in kg.
        along: the direction of a cylinder's axis, one of x, y and z; None for z.
    """
    if isinstance(shape, Box):
        x, y, z = shape.size
        return mass * (y * y + z * z) / 12, mass * (x * x + z * z) / 12, mass * (x * x + y * y) / 12
    if isinstance(shape, Sphere):
        moment = 0.4 * mass * shape.radius**2
        return moment, moment, moment
    across = mass * (3 * shape.radius**2 + shape.length**2) / 12
    moments = [across, across, across]
    moments[2 if along is None else int(np.argmax(np.abs(along)))] = mass * shape.radius**2 / 2
    return moments[0], moments[1], moments[2]
