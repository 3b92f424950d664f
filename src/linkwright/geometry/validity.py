"""Checks that an inertia tensor, a mass and a shape can belong to one body.

A rigid body's tensor is symmetric and positive definite, and its principal moments obey the triangle inequality: none
is larger than the sum of the other two, because ``I1 + I2 - I3 = 2 integral(z2 dm) >= 0``. Source: Traversaro,
Brossette, Escande, Nori: *Identification of fully physical consistent inertial parameters using optimization on
manifolds*, 2016.
"""

from __future__ import annotations

from itertools import chain
from math import copysign, hypot, isfinite, sqrt

from linkwright.diagnostics import Phrase, phrase
from linkwright.geometry.shapes import Bounds, Matrix
from linkwright.geometry.single import Vector3
from linkwright.loading.lean_typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linkwright.geometry.arrays import Array
    from linkwright.geometry.mass import MassProperties

MAX_DENSITY = 22_600.0
"""The density of osmium, the densest solid, in kg/m3."""

MIN_DENSITY = 1.2
"""The density of air at sea level, in kg/m3. A body with a lower density would float."""

TOLERANCE = 1e-3
"""The error that rounding in a file may cause, as a fraction of the largest moment."""


ROUNDING = 1e-9
"""The error of numbers that were computed, not rounded for a file, as a fraction of the largest moment."""


_NEGLIGIBLE_PRODUCT = 1e-20
"""A product of inertia below this fraction of the tensor's largest entry changes no moment."""
_MAX_SWEEPS = 30
"""The maximum number of sweeps. Five are usual."""


def largest_entry(tensor: Array | Matrix) -> float:
    """Return the largest absolute value of a tensor's entries, or 0 if an entry is not finite."""
    entries = [abs(float(entry)) for entry in chain.from_iterable(tensor)]
    return max(entries) if all(map(isfinite, entries)) else 0.0


def relative_moments(tensor: Array | Matrix) -> Vector3:
    """Return the principal moments divided by the tensor's largest entry, smallest first.

    The moments are computed by Jacobi rotations, each of which makes one product of inertia zero; no step overflows.
    For a single tensor, this is faster than arrays, and it keeps checks of descriptions free of numpy.
    """
    largest = largest_entry(tensor)
    if not largest > 0:
        return 0.0, 0.0, 0.0
    rows = [[float(entry) / largest for entry in row] for row in tensor]
    for _ in range(_MAX_SWEEPS):
        if max(abs(rows[0][1]), abs(rows[0][2]), abs(rows[1][2])) < _NEGLIGIBLE_PRODUCT:
            break
        for p, q, other_axis in ((0, 1, 2), (0, 2, 1), (1, 2, 0)):
            _rotate(rows, p, q, other_axis)
    small, middle, large = sorted(rows[axis][axis] for axis in range(3))
    return small, middle, large


def _rotate(rows: list[list[float]], p: int, q: int, other_axis: int) -> None:
    """Rotate a symmetric matrix in place so that its entry (p, q) becomes zero."""
    product = rows[p][q]
    if abs(product) < _NEGLIGIBLE_PRODUCT:
        return
    ratio = (rows[q][q] - rows[p][p]) / (2.0 * product)
    tangent = copysign(1.0, ratio) / (abs(ratio) + hypot(1.0, ratio))
    cosine = 1.0 / hypot(1.0, tangent)
    sine = tangent * cosine
    first, second = rows[p][other_axis], rows[q][other_axis]
    rows[p][p] -= tangent * product
    rows[q][q] += tangent * product
    rows[p][q] = rows[q][p] = 0.0
    rows[p][other_axis] = rows[other_axis][p] = cosine * first - sine * second
    rows[q][other_axis] = rows[other_axis][q] = sine * first + cosine * second


def is_positive_definite(tensor: Array | Matrix) -> bool:
    """Return whether all principal moments of a symmetric tensor, of shape (3, 3), are positive."""
    return relative_moments(tensor)[0] > 0


def is_indefinite(tensor: Array | Matrix, rounding: float = 0.0) -> bool:
    """Return whether a principal moment is negative by more than rounding can explain.

    Args:
        tensor: the inertia tensor in kg m2; shape (3, 3).
        rounding: the error of a principal moment that the file's few digits can cause, in kg m2; at most `TOLERANCE` of
            the largest entry is used.
    """
    largest = largest_entry(tensor)
    max_error = max(ROUNDING * largest, min(rounding, TOLERANCE * largest))
    return relative_moments(tensor)[0] * largest < -max_error


def triangle_excess(tensor: Array | Matrix) -> float:
    """Return the excess of the largest principal moment over the sum of the others.

    The excess is a fraction of the largest moment: negative or 0 for a possible body, and 0 for a flat one. It does not
    depend on the axes of the tensor.
    """
    small, middle, large = relative_moments(tensor)
    return (large - small - middle) / large if large > 0 else 0.0


def find_excessive_products(tensor: Array | Matrix) -> list[tuple[str, float]]:
    """Return the products of inertia that are too large for the diagonal moments.

    The limits are ``|Ixy| <= Izz / 2`` and so on, from ``ab <= (a2 + b2) / 2`` under the integral, and
    ``Ixy2 < Ixx Iyy``, because the tensor is positive definite.

    Returns:
        Pairs of name (``ixy``, ``ixz``, ``iyz``) and limit in kg m2.
    """
    excessive = []
    for name, i, j, k in (("ixy", 0, 1, 2), ("ixz", 0, 2, 1), ("iyz", 1, 2, 0)):
        first, second, third = (float(tensor[axis][axis]) for axis in (i, j, k))
        if min(first, second, third) <= 0:
            continue
        limit = min(third / 2, sqrt(first * second))
        if abs(float(tensor[i][j])) > limit * (1 + TOLERANCE):
            excessive.append((name, limit))
    return excessive


def largest_moment_within(center: Vector3, box: Bounds, mass: float) -> float:
    """Return an upper bound of the moments about its center of mass of a body in a box.

    The result is in kg m2. No point of the body is farther away than the farthest corner, and a moment about an axis
    through the center of mass is at most the moment of the entire mass at that distance.

    Args:
        center: the center of mass in m.
        box: the box, in m.
        mass: the mass in kg.
    """
    coordinates = zip(center, box.low, box.high, strict=True)
    return mass * sum(max(abs(low - middle), abs(high - middle)) ** 2 for middle, low, high in coordinates)


def find_problems(properties: MassProperties) -> list[Phrase]:
    """Return the reasons why mass properties cannot belong to a body, if there are any."""
    reasons = []
    if not properties.mass > 0:
        reasons.append(phrase("the mass is not positive"))
    if not is_positive_definite(properties.inertia):
        reasons.append(phrase("the inertia tensor is not positive definite"))
    elif triangle_excess(properties.inertia) > TOLERANCE:
        reasons.append(phrase("one principal moment of inertia is larger than the sum of the other two"))
    return reasons
