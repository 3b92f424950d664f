"""Converting ``<inertial>`` to mass properties and back."""

from __future__ import annotations

import numpy as np

from linkwright.geometry.bounds import FARTHEST
from linkwright.geometry.mass import LEAST_MASS, MassProperties
from linkwright.urdf import Inertial, Pose

_GREATEST = 1e30
"""Masses in kg and moments in kg m2 beyond this are too; the sun has 2e30 kg."""


def is_computable(inertial: Inertial) -> bool:
    """Whether the numbers of an ``<inertial>`` are small enough to compute with; they need not be those of a body."""
    i = inertial
    numbers = (i.mass, i.ixx, i.ixy, i.ixz, i.iyy, i.iyz, i.izz)
    return max(map(abs, numbers)) <= _GREATEST and max(map(abs, i.origin.xyz)) <= FARTHEST


def has_mass(inertial: Inertial) -> bool:
    """Whether an ``<inertial>`` gives a mass that can be spread over a shape."""
    return is_computable(inertial) and inertial.mass > LEAST_MASS


def from_inertial(inertial: Inertial) -> MassProperties:
    """Convert an ``<inertial>`` to mass properties in the link frame."""
    i = inertial
    tensor = np.array(((i.ixx, i.ixy, i.ixz), (i.ixy, i.iyy, i.iyz), (i.ixz, i.iyz, i.izz)), dtype=np.float64)
    return MassProperties(i.mass, np.zeros(3), tensor).moved(i.origin)


def to_inertial(properties: MassProperties) -> Inertial:
    """Convert mass properties in the link's frame to an ``<inertial>``; its axes are those of the link."""
    tensor = properties.inertia
    x, y, z = (float(part) for part in properties.center)
    ixx, ixy, ixz, iyy, iyz, izz = (float(tensor[i, j]) for i, j in ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)))
    return Inertial(float(properties.mass), ixx, ixy, ixz, iyy, iyz, izz, Pose((x, y, z)))
