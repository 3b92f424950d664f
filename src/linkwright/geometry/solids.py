"""Mass properties of the primitive shapes, in closed form.

The formulae are found in any table of moments of inertia of homogeneous bodies, for instance Beer, Johnston: *Vector
Mechanics for Engineers: Dynamics*, inside back cover. All refer to the center of mass and the shape's own axes.
"""

from __future__ import annotations

from math import pi

import numpy as np

from linkwright.geometry.mass import MassProperties
from linkwright.geometry.shapes import Box, Capsule, Cylinder, SimpleShape, Sphere, shape_volume


def shape_properties(shape: SimpleShape, density: float = 1.0) -> MassProperties:
    """Return the mass properties of a shape filled with uniform density, in the shape's frame.

    Args:
        shape: the shape, with lengths in m; a size of zero or less results in a body without mass.
        density: the density in kg/m3; with 1, the mass is the volume in m3.
    """
    if isinstance(shape, Box):
        return _box_properties(shape, density)
    if isinstance(shape, Sphere):
        return _sphere_properties(shape, density)
    if isinstance(shape, Capsule):
        return _capsule_properties(shape, density)
    return _cylinder_properties(shape, density)


def _box_properties(box: Box, density: float) -> MassProperties:
    """Return the mass properties of a box.

    The formulas are ``m = rho a b c``; ``Ixx = m (b2 + c2) / 12`` and so on.
    """
    if min(box.size) <= 0:
        return MassProperties(0.0)
    a, b, c = box.size
    mass = density * shape_volume(box)
    return _create_diagonal(mass, mass * (b * b + c * c) / 12, mass * (a * a + c * c) / 12, mass * (a * a + b * b) / 12)


def _cylinder_properties(cylinder: Cylinder, density: float) -> MassProperties:
    """Return the mass properties of a cylinder along z.

    The formulas are ``m = rho pi r2 l``; ``Ixx = Iyy = m (3 r2 + l2) / 12``; ``Izz = m r2 / 2``.
    """
    r, length = cylinder.radius, cylinder.length
    if min(r, length) <= 0:
        return MassProperties(0.0)
    mass = density * shape_volume(cylinder)
    transverse_moment = mass * (3 * r * r + length * length) / 12
    return _create_diagonal(mass, transverse_moment, transverse_moment, mass * r * r / 2)


def _sphere_properties(sphere: Sphere, density: float) -> MassProperties:
    """Return the mass properties of a sphere.

    The formulas are ``m = rho 4/3 pi r3``; ``I = 2/5 m r2`` about every axis.
    """
    r = sphere.radius
    if r <= 0:
        return MassProperties(0.0)
    mass = density * shape_volume(sphere)
    moment = 2 / 5 * mass * r * r
    return _create_diagonal(mass, moment, moment, moment)


def _capsule_properties(capsule: Capsule, density: float) -> MassProperties:
    """Return the mass properties of a capsule: a cylinder with a half sphere on each end.

    A half sphere has its center of mass 3/8 r above its flat side and the moment ``83/320 m r2`` about this center,
    across its axis. Moved to the center of the capsule, that becomes ``2/5 r2 + l2/4 + 3/8 l r`` per unit of mass.
    """
    r, length = capsule.radius, capsule.length
    if r <= 0 or length < 0:
        return MassProperties(0.0)
    cylinder_mass = density * pi * r * r * length
    ends_mass = density * 4 / 3 * pi * r * r * r
    transverse_moment = cylinder_mass * (3 * r * r + length * length) / 12
    transverse_moment += ends_mass * (2 / 5 * r * r + length * length / 4 + 3 / 8 * length * r)
    axial_moment = cylinder_mass * r * r / 2 + ends_mass * 2 / 5 * r * r
    return _create_diagonal(cylinder_mass + ends_mass, transverse_moment, transverse_moment, axial_moment)


def _create_diagonal(mass: float, ixx: float, iyy: float, izz: float) -> MassProperties:
    return MassProperties(mass, np.zeros(3), np.diag((ixx, iyy, izz)))
