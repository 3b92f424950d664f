"""Whether an inertia tensor, a mass and a shape can belong to one body.

A rigid body's tensor is symmetric and positive definite, and its principal moments obey the triangle inequality: none
is larger than the sum of the other two, for ``I1 + I2 - I3 = 2 integral(z2 dm) >= 0``. Source: Traversaro, Brossette,
Escande, Nori: *Identification of fully physical consistent inertial parameters using optimization on manifolds*, 2016.
"""

from __future__ import annotations

from math import sqrt

import numpy as np

from linkwright.diagnostics import Phrase, phrase
from linkwright.geometry.arrays import Array
from linkwright.geometry.bounds import Bounds
from linkwright.geometry.mass import MassProperties
from linkwright.geometry.vectors import Vector3

HEAVIEST_DENSITY = 22_600.0
"""Osmium in kg/m3: no solid is denser."""

LIGHTEST_DENSITY = 1.2
"""Air at sea level in kg/m3: a body that weighs less would float."""

TOLERANCE = 1e-3
"""Part of the largest moment by which rounding in a file may break a rule."""


ROUNDING = 1e-9
"""Part of the largest moment by which numbers that were computed, not rounded for a file, may be off."""


def relative_moments(tensor: Array) -> Array:
    """The principal moments in units of the tensor's largest entry, smallest first; shape (3,). Nothing overflows."""
    largest = float(np.abs(tensor).max())
    if not largest > 0:
        return np.zeros(3)
    return np.asarray(np.linalg.eigvalsh(tensor / largest), dtype=np.float64)


def is_positive_definite(tensor: Array) -> bool:
    """Whether every principal moment is positive; `tensor` is symmetric, of shape (3, 3)."""
    return bool(relative_moments(tensor)[0] > 0)


def is_indefinite(tensor: Array, rounding: float = 0.0) -> bool:
    """Return whether a principal moment is negative by more than what rounding can have made of zero.

    Args:
        tensor: in kg m2; shape (3, 3).
        rounding: how far a principal moment may be off because the file has few digits, in kg m2; no more than
            `TOLERANCE` of the largest entry counts.
    """
    largest = float(np.abs(tensor).max())
    allowed = max(ROUNDING * largest, min(rounding, TOLERANCE * largest))
    return bool(relative_moments(tensor)[0] * largest < -allowed)


def triangle_excess(tensor: Array) -> float:
    """By how much the largest principal moment is more than the sum of the others, as a part of it.

    0 or less for a body that can be; 0 for a flat one. The tensor's axes do not matter.
    """
    small, middle, large = relative_moments(tensor)
    return float((large - small - middle) / large) if large > 0 else 0.0


def excessive_products(tensor: Array, tolerance: float = TOLERANCE) -> list[tuple[str, float]]:
    """Products of inertia that are larger than the moments on the diagonal allow, with the largest allowed.

    ``ab <= (a2 + b2) / 2`` under the integral gives ``|Ixy| <= Izz / 2`` and so on, and a positive definite tensor has
    ``Ixy2 < Ixx Iyy``.

    Returns:
        Pairs of name (``ixy``, ``ixz``, ``iyz``) and limit in kg m2.
    """
    found = []
    for name, i, j, k in (("ixy", 0, 1, 2), ("ixz", 0, 2, 1), ("iyz", 1, 2, 0)):
        first, second, third = (float(tensor[axis, axis]) for axis in (i, j, k))
        if min(first, second, third) <= 0:
            continue
        limit = min(third / 2, sqrt(first * second))
        if abs(float(tensor[i, j])) > limit * (1 + tolerance):
            found.append((name, limit))
    return found


def largest_moment_within(center: Vector3, box: Bounds, mass: float) -> float:
    """The largest moment about a centre of mass that a body inside a box can have, in kg m2.

    A body's points are nowhere farther than the farthest corner, and a moment about an axis through the centre of mass
    is at most that of the whole mass at the farthest distance.

    Args:
        center: the centre of mass in m.
        box: the box, in m.
        mass: in kg.
    """
    ends = zip(center, box.low, box.high, strict=True)
    return mass * sum(max(abs(low - middle), abs(high - middle)) ** 2 for middle, low, high in ends)


def problems(properties: MassProperties) -> list[Phrase]:
    """The reasons why mass properties cannot be those of a body, in words; empty for valid ones."""
    found = []
    if not properties.mass > 0:
        found.append(phrase("the mass is not positive"))
    if not is_positive_definite(properties.inertia):
        found.append(phrase("the inertia tensor is not positive definite"))
    elif triangle_excess(properties.inertia) > TOLERANCE:
        found.append(phrase("one principal moment of inertia is larger than the sum of the other two"))
    return found
