"""Conversion between ``<inertial>`` elements and mass properties."""

from __future__ import annotations

import numpy as np

from linkwright.geometry.mass import MIN_MASS, MassProperties
from linkwright.urdf import Inertial, Pose


def has_mass(inertial: Inertial) -> bool:
    """Return whether an ``<inertial>`` has a usable mass, to be distributed over a shape."""
    return inertial.is_computable and inertial.mass > MIN_MASS


def from_inertial(inertial: Inertial) -> MassProperties:
    """Convert an ``<inertial>`` to mass properties in the link frame."""
    i = inertial
    tensor = np.array(((i.ixx, i.ixy, i.ixz), (i.ixy, i.iyy, i.iyz), (i.ixz, i.iyz, i.izz)), dtype=np.float64)
    return MassProperties(i.mass, np.zeros(3), tensor).moved(i.origin)


def to_inertial(properties: MassProperties) -> Inertial:
    """Convert mass properties in the link frame to an ``<inertial>`` with the link's axes."""
    tensor = properties.inertia
    x, y, z = (float(coordinate) for coordinate in properties.center)
    ixx, ixy, ixz, iyy, iyz, izz = (float(tensor[i, j]) for i, j in ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)))
    return Inertial(float(properties.mass), ixx, ixy, ixz, iyy, iyz, izz, Pose((x, y, z)))
