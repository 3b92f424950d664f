"""The simple shapes that descriptions are made of, and their volumes; lengths in metres."""

from __future__ import annotations

from math import pi, prod

from linkwright.geometry.single import Vector3
from linkwright.loading.lean_dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Box:
    """Edge lengths along x, y, z in metres, centred at the origin."""

    size: Vector3


@dataclass(frozen=True, slots=True)
class Cylinder:
    """Along z, centred at the origin; metres."""

    radius: float
    length: float


@dataclass(frozen=True, slots=True)
class Capsule:
    """Along z, centred at the origin; `length` is that of the cylindrical part, in metres (URDF 1.1)."""

    radius: float
    length: float


@dataclass(frozen=True, slots=True)
class Sphere:
    """Centred at the origin; metres."""

    radius: float


SimpleShape = Box | Cylinder | Capsule | Sphere


def volume_of(shape: SimpleShape) -> float:
    """Return the volume of a shape in m3; 0 if a size is zero or less, infinite on overflow."""
    if isinstance(shape, Box):
        return prod(shape.size) if min(shape.size) > 0 else 0.0
    r = max(shape.radius, 0.0)
    ball = 4 / 3 * pi * (r * r * r)  # a power of a large number would raise
    if isinstance(shape, Sphere):
        return ball
    if isinstance(shape, Capsule):
        return pi * r * r * shape.length + ball if r > 0 and shape.length >= 0 else 0.0
    return pi * r * r * shape.length if min(r, shape.length) > 0 else 0.0
