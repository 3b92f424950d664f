"""Whether the numbers of an ``<inertial>`` are of a size to compute with; asked of every link, so without numpy."""

from __future__ import annotations

from linkwright.geometry.shapes import FARTHEST
from linkwright.urdf import Inertial

_GREATEST = 1e30
"""Masses in kg and moments in kg m2 beyond this are too; the sun has 2e30 kg."""


def is_computable(inertial: Inertial) -> bool:
    """Whether the numbers of an ``<inertial>`` are small enough to compute with; they need not be those of a body."""
    i = inertial
    numbers = (i.mass, i.ixx, i.ixy, i.ixz, i.iyy, i.iyz, i.izz)
    return max(map(abs, numbers)) <= _GREATEST and max(map(abs, i.origin.xyz)) <= FARTHEST
