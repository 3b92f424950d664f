"""The simple shapes that descriptions are made of; lengths in metres."""

from __future__ import annotations

from dataclasses import dataclass

from linkwright.geometry.vectors import Vector3


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
