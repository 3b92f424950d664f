"""Mass, center of mass and inertia tensor of a rigid body, and quantities derived from them."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike

from linkwright.geometry.arrays import Array
from linkwright.geometry.shapes import rotation as rotation_of
from linkwright.geometry.single import Pose
from linkwright.loading.lean_dataclasses import dataclass, field

MIN_MASS = 1e-30
"""A body with less mass than this, in kg, counts as a body without mass."""


@dataclass(frozen=True, slots=True, eq=False)
class PrincipalAxes:
    """The principal moments of a body, and the axes in which its inertia tensor is diagonal.

    Attributes:
        moments: the principal moments in kg m2, smallest first; shape (3,).
        axes: the axes as columns, a right-handed rotation matrix; shape (3, 3).
    """

    moments: Array
    axes: Array


@dataclass(frozen=True, slots=True, eq=False)
class MassProperties:
    """Mass properties of a rigid body in a frame.

    For links, this is the frame of the link.

    Attributes:
        mass: the mass in kg.
        center: the center of mass in m; shape (3,).
        inertia: the inertia tensor about the center of mass in kg m2, in the axes of the frame; shape (3, 3). Products
            of inertia have the sign of the tensor's entries, as in URDF and Gazebo: ``ixy = -integral(x y
            dm)``.
    """

    mass: float
    center: Array = field(default_factory=lambda: np.zeros(3))
    inertia: Array = field(default_factory=lambda: np.zeros((3, 3)))

    def with_scaled_density(self, factor: float) -> MassProperties:
        """Return the mass properties of the same body with its density multiplied by a factor."""
        return MassProperties(self.mass * factor, self.center, self.inertia * factor)

    def with_mass(self, mass: float) -> MassProperties:
        """Return the mass properties of the same body with another mass, in kg.

        Raises:
            ValueError: the body has no mass that could be scaled.
        """
        if not self.mass > MIN_MASS:
            raise ValueError("a body without mass cannot be scaled to another mass")
        return self.with_scaled_density(mass / self.mass)

    def moved(self, pose: Pose) -> MassProperties:
        """Return the mass properties in a parent frame, given the body's pose in it."""
        rotation = np.array(rotation_of(pose))
        center = rotation @ self.center + np.asarray(pose.xyz)
        return MassProperties(self.mass, center, rotation @ self.inertia @ rotation.T)

    def inertia_about(self, point: ArrayLike) -> Array:
        """Return the inertia tensor about another point of the frame, of shape (3, 3).

        The parallel axis theorem (Steiner) is used.
        """
        offset = self.center - np.asarray(point, dtype=np.float64)
        return self.inertia + self.mass * (offset @ offset * np.eye(3) - np.outer(offset, offset))

    def principal(self) -> PrincipalAxes:
        """Return the principal moments and axes."""
        moments, axes = np.linalg.eigh(self.inertia)
        if np.linalg.det(axes) < 0:
            axes[:, 0] = -axes[:, 0]
        return PrincipalAxes(moments, axes)

    def equivalent_box(self) -> Array | None:
        """Return the edge lengths of the uniform box with this mass and these principal moments.

        The lengths are in m, along the principal axes; shape (3,). A box with edges a, b, c has ``I1 = m (b2 + c2) /
        12`` and so on, which is solved for the edges. Returns None for a body that has no mass, or for a tensor that no
        body can have.
        """
        if not self.mass > MIN_MASS:
            return None
        moments = self.principal().moments
        squares = 6.0 / self.mass * (moments.sum() - 2.0 * moments)
        if np.any(squares < -1e-6 * np.abs(squares).max(initial=0.0)):
            return None
        edges: Array = np.sqrt(np.maximum(squares, 0.0))
        return edges


def combine(parts: Iterable[MassProperties]) -> MassProperties:
    """Return the mass properties of several bodies in one frame.

    Where bodies overlap, their masses add up.
    """
    bodies = list(parts)
    mass = sum(body.mass for body in bodies)
    if not mass > 0:
        return MassProperties(0.0)
    center = np.sum([body.mass * body.center for body in bodies], axis=0) / mass
    inertia = np.sum([body.inertia_about(center) for body in bodies], axis=0)
    return MassProperties(mass, center, inertia)
