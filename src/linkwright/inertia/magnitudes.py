"""The check whether numbers of an ``<inertial>`` can be computed with.

It runs for every link, so it must not load numpy.
"""

from __future__ import annotations

from linkwright.geometry.shapes import FARTHEST
from linkwright.urdf import Inertial

_GREATEST = 1e30
"""Masses in kg and moments in kg m2 beyond this are too; the sun has 2e30 kg."""


def is_computable(inertial: Inertial) -> bool:
    """Return whether the numbers of an ``<inertial>`` are small enough for computations.

    They need not be physically valid.
    """
    i = inertial
    numbers = (i.mass, i.ixx, i.ixy, i.ixz, i.iyy, i.iyz, i.izz)
    return max(map(abs, numbers)) <= _GREATEST and max(map(abs, i.origin.xyz)) <= FARTHEST
