"""Boxes along the axes of a frame, in plain floats: there are many, each computed by itself."""

from __future__ import annotations

from collections.abc import Iterable
from math import hypot

from linkwright.geometry.placement import Placement
from linkwright.geometry.shapes import Box, Capsule, SimpleShape, Sphere
from linkwright.geometry.single import Vector3, added, scaled, subtracted
from linkwright.loading.lean_dataclasses import NamedTuple

FARTHEST = 1e9
"""Lengths in m beyond this are mistakes; nothing is computed from them, so that nothing overflows."""


class Bounds(NamedTuple):
    """A box along the axes of some frame: its lowest and highest corner in m."""

    low: Vector3
    high: Vector3

    @property
    def size(self) -> Vector3:
        """The edges in m."""
        return subtracted(self.high, self.low)

    @property
    def center(self) -> Vector3:
        """The middle in m."""
        return scaled(added(self.low, self.high), 0.5)

    @property
    def diagonal(self) -> float:
        """The distance of opposite corners in m."""
        return hypot(*self.size)

    def gap(self, other: Bounds) -> float:
        """Return the distance between two boxes, in m; 0 if they touch."""
        between = (subtracted(self.low, other.high), subtracted(other.low, self.high))
        return hypot(*(max(0.0, before, after) for before, after in zip(*between, strict=True)))

    def nearest(self, point: Vector3) -> Vector3:
        """The point of the box that is nearest to another."""
        x, y, z = (min(max(part, low), high) for part, low, high in zip(point, self.low, self.high, strict=True))
        return x, y, z

    def distance(self, point: Vector3) -> float:
        """Return the distance of a point from the box, in m; 0 inside."""
        return self.gap(Bounds(point, point))

    def moved(self, frame: Placement) -> Bounds:
        """The box around this one in a parent frame, in which `frame` is that of this box."""
        low, high = [], []
        for row, start in zip(frame.rotation, frame.position, strict=True):
            ends = [(a * factor, b * factor) for factor, a, b in zip(row, self.low, self.high, strict=True)]
            low.append(start + sum(map(min, ends)))
            high.append(start + sum(map(max, ends)))
        return Bounds((low[0], low[1], low[2]), (high[0], high[1], high[2]))


def bounds_of(shape: SimpleShape) -> Bounds:
    """The box around a shape along its own axes."""
    if isinstance(shape, Box):
        x, y, z = (abs(edge) / 2.0 for edge in shape.size)
    elif isinstance(shape, Sphere):
        x = y = z = abs(shape.radius)
    else:
        x = y = abs(shape.radius)
        z = abs(shape.length / 2.0 + (shape.radius if isinstance(shape, Capsule) else 0.0))
    return Bounds((-x, -y, -z), (x, y, z))


def union(boxes: Iterable[Bounds]) -> Bounds | None:
    """Return the box around several boxes, or None if there are none."""
    listed = list(boxes)
    if len(listed) < 2:
        return listed[0] if listed else None
    low = tuple(map(min, *(box.low for box in listed)))
    high = tuple(map(max, *(box.high for box in listed)))
    return Bounds((low[0], low[1], low[2]), (high[0], high[1], high[2]))
